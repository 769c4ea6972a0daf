// The visual process's side of the link: levels, predicted poses, commands, bodies.
#include <gtest/gtest.h>

#include <cmath>

#include "gui/docking/body_list.hpp"
#include "gui/link/command_sender.hpp"
#include "gui/link/controller.hpp"
#include "gui/link/pose_predictor.hpp"
#include "gui/render/mesh_level.hpp"

namespace tact::gui_link_test {
namespace {

TEST(MeshLevel, uses_the_governors_item_count_for_this_mesh) {
    PathLevel p{};
    p.level = 0.5F;
    p.items = 1234;
    p.items_max = 10'000;
    EXPECT_EQ(vertices_for(p, 10, 10'000), 1234U);
}

TEST(MeshLevel, uses_the_level_as_a_fraction_otherwise_and_stays_within_the_mesh) {
    PathLevel p{};
    p.level = 0.25F;
    EXPECT_EQ(vertices_for(p, 10, 10'000), 2500U);
    p.items = 50;
    p.items_max = 100;  // the items of another mesh
    EXPECT_EQ(vertices_for(p, 10, 10'000), 2500U);
    p.level = 0.0F;
    EXPECT_EQ(vertices_for(p, 10, 10'000), 10U);
    p.level = 1.0F;
    EXPECT_EQ(vertices_for(p, 10, 10'000), 10'000U);
    p.items = 20'000;
    p.items_max = 10'000;  // more than the mesh has
    EXPECT_EQ(vertices_for(p, 10, 10'000), 10'000U);
}

TEST(MeshLevel, a_surface_keeps_enough_vertices_to_be_recognizable) {
    EXPECT_EQ(fewest_shown(66, 60'000), 1000U);
    EXPECT_EQ(fewest_shown(66, 6000), 500U);
    EXPECT_EQ(fewest_shown(3000, 9000), 3000U);  // a base mesh cannot have fewer
    EXPECT_EQ(fewest_shown(0, 0), 0U);
}

TEST(MeshLevel, the_adapting_time_is_a_quarter_of_a_frame_within_limits) {
    EXPECT_EQ(adapt_budget_s(0.0), 0.002);  // the first frame
    EXPECT_EQ(adapt_budget_s(0.016), 0.004);
    EXPECT_EQ(adapt_budget_s(3.0), 0.05);
    EXPECT_EQ(adapt_budget_s(std::nan("")), 0.002);
}

TEST(PosePredictor, extrapolates_a_steady_motion_to_the_time_of_display) {
    PosePredictor predictor;
    const Vec3 speed(1e-8, -2e-8, 0.5e-8);
    const double spin = 1.5;
    const auto pose_at = [&](double t) {
        return Pose{speed * t, Quat(Eigen::AngleAxisd(spin * t, Vec3::UnitZ()))};
    };
    for (int i = 0; i <= 400; ++i) predictor.add(1 + i * 1'000'000LL, pose_at(1e-3 * i));
    const Pose seen = predictor.at(1 + 412'000'000LL);
    const Pose wanted = pose_at(0.412);
    EXPECT_LT((seen.p_m - wanted.p_m).norm(), 1e-13);
    EXPECT_LT(seen.q.angularDistance(wanted.q), 1e-4);
}

TEST(PosePredictor, stops_extrapolating_when_the_controller_is_silent) {
    PosePredictor predictor;
    for (int i = 0; i <= 100; ++i)
        predictor.add(1 + i * 1'000'000LL, {Vec3(1e-8 * i, 0, 0), Quat::Identity()});
    const double most = 1e-8 * 100 + 1e-5 * 1e-9 * static_cast<double>(PosePredictor::kHorizon_ns);
    EXPECT_LE(predictor.at(1 + 280'000'000LL).p_m.x(), most * (1 + 1e-9));
    EXPECT_EQ(predictor.at(1 + 5'000'000'000LL).p_m.x(), 1e-8 * 100);
    // After a gap the speed is unknown.
    predictor.add(9'000'000'000LL, {Vec3::Zero(), Quat::Identity()});
    EXPECT_EQ(predictor.at(9'010'000'000LL).p_m, Vec3::Zero());
}

TEST(CommandSender, numbers_commands_and_reports_their_results) {
    OwnedRegion<GuiRegion> region;
    CommandSender sender(region->commands);
    using Stage = CommandSender::Stage;
    ASSERT_TRUE(sender.send({.kind = CommandKind::arm}, 100));
    ASSERT_TRUE(sender.send({.kind = CommandKind::set_law, .text = "fixed"}, 200));
    CommandQueue::Cursor cursor;
    CommandTopic command{};
    ASSERT_TRUE(region->commands.next(cursor, command));
    EXPECT_EQ(command.sequence, 1U);
    EXPECT_EQ(command.kind, static_cast<std::uint16_t>(CommandKind::arm));
    ASSERT_TRUE(region->commands.next(cursor, command));
    EXPECT_EQ(command.sequence, 2U);
    EXPECT_STREQ(command.text, "fixed");

    HealthTopic health{};
    health.command_sequence = 1;
    health.command_result = static_cast<std::uint32_t>(CommandResult::done);
    sender.update(health, 300);
    EXPECT_EQ(sender.stage(), Stage::sent);  // the answer is to the first command
    sender.update(health, 200 + CommandSender::kPatience_ns + 1);
    EXPECT_EQ(sender.stage(), Stage::unanswered);
    health.command_sequence = 2;
    health.command_result = static_cast<std::uint32_t>(CommandResult::refused_value);
    sender.update(health, 400);
    EXPECT_EQ(sender.stage(), Stage::refused);
    // A disarm overtakes what was sent before it; the answers to that come later.
    ASSERT_TRUE(sender.send({.kind = CommandKind::disarm}, 500));
    health.state_sequence = 3;
    health.state_result = static_cast<std::uint16_t>(CommandResult::done);
    sender.update(health, 600);
    EXPECT_EQ(sender.stage(), Stage::done);
    ASSERT_TRUE(sender.send({.kind = CommandKind::mark}, 700));
    health.state_sequence = 4;  // of the window before this one
    sender.update(health, 800);
    EXPECT_EQ(sender.stage(), Stage::sent);
    EXPECT_FALSE(sender.send({.kind = CommandKind::set_law, .text = std::string(32, 'x')}, 500));
    EXPECT_EQ(sender.sequence(), 4U);
}

TEST(CommandSender, forgets_what_an_earlier_controller_answered) {
    OwnedRegion<GuiRegion> region;
    CommandSender sender(region->commands);
    ASSERT_TRUE(sender.send({.kind = CommandKind::arm}, 100));
    HealthTopic health{};
    health.command_sequence = 1;
    health.command_result = static_cast<std::uint32_t>(CommandResult::done);
    sender.update(health, 200);
    EXPECT_EQ(sender.text(), "arm: done");
    sender.forget();
    EXPECT_EQ(sender.text(), "");
    EXPECT_EQ(sender.stage(), CommandSender::Stage::none);
    ASSERT_TRUE(sender.send({.kind = CommandKind::arm}, 300));
    sender.forget();
    EXPECT_NE(sender.text().find("ended before it answered"), std::string::npos) << sender.text();
    sender.forget();
    EXPECT_NE(sender.text().find("ended before it answered"), std::string::npos)
        << "until something else is asked";
}

TEST(CommandSender, carries_the_body_and_its_pose) {
    CommandQueue queue{};
    CommandSender sender(queue);
    Command place{.kind = CommandKind::place_body, .body = 7};
    place.T_model_body = {Vec3(1e-9, 2e-9, -3e-9), Quat(0.5, 0.5, -0.5, 0.5)};
    ASSERT_TRUE(sender.send(place, 100));
    CommandQueue::Cursor cursor;
    CommandTopic command{};
    ASSERT_TRUE(queue.next(cursor, command));
    EXPECT_EQ(command.body, 7U);
    EXPECT_EQ(command.pos_model_m[2], -3e-9);
    EXPECT_EQ(command.quat_model_body_xyzw[1], -0.5);
    EXPECT_EQ(command.quat_model_body_xyzw[3], 0.5);
}

BodiesTopic topic_of(std::initializer_list<std::pair<std::uint32_t, std::uint16_t>> bodies) {
    BodiesTopic t{};
    for (const auto& [id, structure] : bodies) {
        BodyPlace& place = t.body[t.count++];
        place.id = id;
        place.structure = structure;
        place.quat_model_body_xyzw[3] = 1.0;
        place.pos_model_m[0] = 1e-10 * id;
    }
    return t;
}

TEST(BodyList, shows_the_structures_at_home_until_a_controller_publishes) {
    BodyList list;
    const std::vector<Pose> homes(3, {Vec3(0, 0, 4e-9), Quat::Identity()});
    list.start(homes);
    ASSERT_EQ(list.bodies().size(), 3U);
    EXPECT_EQ(list.bodies()[2].structure, 2U);
    EXPECT_EQ(list.active(), 0U);
    list.predict(0);
    EXPECT_EQ(list.bodies()[1].T_model_body.p_m.z(), 4e-9);
}

TEST(BodyList, follows_bodies_by_id_while_others_come_and_go) {
    BodyList list;
    list.start(std::vector<Pose>(2));
    BodiesTopic t = topic_of({{1, 0}, {2, 0}, {5, 1}});
    t.active = 2;
    list.follow(t);
    list.set_hidden(5, true);
    BodiesTopic fewer = topic_of({{2, 0}, {5, 1}});
    fewer.active = kNoBody;
    list.follow(fewer);
    ASSERT_EQ(list.bodies().size(), 2U);
    EXPECT_TRUE(list.bodies()[1].hidden);
    EXPECT_FALSE(list.bodies()[0].hidden);
    EXPECT_FALSE(list.active().has_value());
    EXPECT_EQ(list.find(1), nullptr);
    ASSERT_NE(list.find(5), nullptr);
    EXPECT_EQ(list.find(5)->newest.p_m.x(), 5e-10);
}

TEST(BodyList, omits_bodies_of_structures_missing_from_the_scene) {
    BodyList list;
    list.start(std::vector<Pose>(1));
    BodiesTopic t = topic_of({{1, 9}, {2, 0}});
    t.active = 1;
    list.follow(t);
    ASSERT_EQ(list.bodies().size(), 1U);
    EXPECT_EQ(list.bodies()[0].id, 2U);
    EXPECT_EQ(list.active(), 0U);  // the index among the bodies that are shown
}

}  // namespace
}  // namespace tact::gui_link_test
