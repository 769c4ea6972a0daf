// The visual process's side of the link: checks of the controller's records, levels, predicted poses, commands.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "gui/dashboard/status_text.hpp"
#include "gui/docking/body_list.hpp"
#include "gui/link/command_sender.hpp"
#include "gui/link/controller.hpp"
#include "gui/link/pose_predictor.hpp"
#include "gui/link/region_checks.hpp"
#include "gui/render/mesh_level.hpp"

namespace tact::gui_link_test {
namespace {

BodiesTopic good_bodies() {
    BodiesTopic b{};
    b.count = 2;
    b.active = 1;
    for (BodyPlace& p : b.body) p.quat_model_body_xyzw[3] = 1.0;
    return b;
}

TEST(RegionChecks, accept_the_records_of_a_controller) {
    EXPECT_TRUE(sensible(good_bodies()));
    EXPECT_TRUE(sensible(BodiesTopic{}));
    EXPECT_TRUE(sensible(HealthTopic{}));
    EXPECT_TRUE(sensible(LevelsTopic{}));
    ToolTopic tool{};
    tool.quat_world_tool_xyzw[3] = 1.0;
    EXPECT_TRUE(sensible(tool));
}

TEST(RegionChecks, refuse_an_impossible_touch) {
    TouchTopic good{};
    good.planes = 1;
    good.normal_model[0][1] = 1.0F;
    good.push_n[0] = 0.5F;
    EXPECT_TRUE(sensible(good));
    EXPECT_TRUE(sensible(TouchTopic{}));
    const auto refused = [&](auto spoil) {
        TouchTopic t = good;
        spoil(t);
        return !sensible(t);
    };
    EXPECT_TRUE(refused([](TouchTopic& t) { t.planes = 4; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.proxy_model_m[2] = std::nan(""); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.probe_model_m[0] = 1e9; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.normal_model[0][0] = 1.0F; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.push_n[0] = std::nanf(""); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.radius_model_m = -1.0; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.detail = 3; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.detail_shape = static_cast<DetailShape>(2); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.detail_width = -1.0F; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.deviation_model_m = std::nanf(""); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.state = static_cast<TouchState>(3); }));
}

TEST(RegionChecks, refuse_an_impossible_drill) {
    DrillTopic good{};
    good.level_m3 = 1e-13;
    DrillHand& burr = good.hand[0];
    burr.kind = DrillKind::burr;
    burr.radius_m = burr.tip_radius_m = 3e-3F;
    burr.quat_model_tool_xyzw[3] = 1.0;
    EXPECT_TRUE(sensible(good));
    EXPECT_TRUE(sensible(DrillTopic{}));
    const auto refused = [&](auto spoil) {
        DrillTopic t = good;
        spoil(t);
        return !sensible(t);
    };
    EXPECT_TRUE(refused([](DrillTopic& t) { t.level_m3 = std::nan(""); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.burr_rad_s_most = -1.0F; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.suction_m3_s_most = std::nanf(""); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].kind = static_cast<DrillKind>(3); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].shape = static_cast<DrillShape>(3); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].radius_m = 0.0F; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].pos_model_m[1] = 1e9; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].quat_model_tool_xyzw[3] = 0.0; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].suction = 1.5F; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].depth = std::nanf(""); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[1].kind = DrillKind::suction_tube; }));  // without a size
}

TEST(RegionChecks, refuse_an_impossible_head) {
    HeadTopic good{};
    good.quat_screen_head_xyzw[3] = 1.0;
    good.state = 2;
    good.quality = 0.5;
    EXPECT_TRUE(sensible(good));
    const auto refused = [&](const auto& spoil) {
        HeadTopic bad = good;
        spoil(bad);
        EXPECT_FALSE(sensible(bad));
    };
    refused([](HeadTopic& h) { h.pos_screen_m[1] = NAN; });
    refused([](HeadTopic& h) { h.quat_screen_head_xyzw[3] = 0.4; });
    refused([](HeadTopic& h) { h.velocity_screen_m_s[2] = 1e5; });
    refused([](HeadTopic& h) { h.angular_screen_rad_s[0] = INFINITY; });
    refused([](HeadTopic& h) { h.state = 3; });
    refused([](HeadTopic& h) { h.quality = 1.5; });
}

TEST(RegionChecks, refuse_impossible_devices_trackers_and_lateness) {
    EXPECT_TRUE(sensible(DevicesTopic{}));
    EXPECT_TRUE(sensible(TrackerTopic{}));
    EXPECT_TRUE(sensible(LatenessTopic{}));
    const auto device = [](const auto& spoil) {
        DevicesTopic t{};
        t.hand[1].valid = 1;
        spoil(t.hand[1]);
        return sensible(t);
    };
    EXPECT_TRUE(device([](DeviceHand& d) { d.heat = 3.0F; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.heat = NAN; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.winding_c = INFINITY; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.force_n_continuous = -1.0F; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.age_ns = -2; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.read = 4; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.valid = 2; }));
    TrackerTopic tracker{};
    tracker.link = 5;
    EXPECT_FALSE(sensible(tracker));
    tracker = {};
    tracker.rate_hz = NAN;
    EXPECT_FALSE(sensible(tracker));
    LatenessTopic late{};
    late.counts[7] = 3;
    EXPECT_FALSE(sensible(late));  // counts without any cycle
    late.total = 3;
    EXPECT_TRUE(sensible(late));
    late.counts[8] = ~std::uint64_t{0};
    late.total = 2;  // the sum of the counts overflows
    EXPECT_FALSE(sensible(late));
}

TEST(RegionChecks, refuse_impossible_bodies) {
    const double kNan = std::nan("");
    BodiesTopic b = good_bodies();
    b.count = 17;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.count = 0xFFFFFFFFU;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.active = 2;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[1].pos_model_m[2] = kNan;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[0].pos_model_m[0] = 1e9;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[0].quat_model_body_xyzw[3] = 0.0;  // not a rotation
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[5].pos_model_m[0] = kNan;  // beyond count: not checked
    EXPECT_TRUE(sensible(b));
    for (const float pull_n : {-1.0F, 1e6F, std::nanf("")}) {
        b = good_bodies();
        b.pull_n = pull_n;
        EXPECT_FALSE(sensible(b)) << pull_n;
    }
}

TEST(RegionChecks, refuse_impossible_numbers_and_unterminated_texts) {
    HealthTopic h{};
    h.force_rate_hz = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(sensible(h));
    h = {};
    h.recomputed_fraction_mean = 1.5F;
    EXPECT_FALSE(sensible(h));
    h = {};
    h.recomputed_fraction_least = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(sensible(h));
    h = {};
    h.lateness_max_ns = std::numeric_limits<std::int64_t>::min();
    EXPECT_FALSE(sensible(h));
    h = {};
    h.state = 99;
    EXPECT_FALSE(sensible(h));
    ToolTopic t{};
    t.quat_world_tool_xyzw[3] = 1.0;
    t.force_model_n[1] = std::nan("");
    EXPECT_FALSE(sensible(t));
    LevelsTopic l{};
    l.count = 9;
    EXPECT_FALSE(sensible(l));
    l = {};
    std::memset(l.law, 'x', sizeof l.law);  // no terminating zero
    EXPECT_FALSE(sensible(l));
    l = {};
    l.count = 1;
    l.path[0].level = 1.5F;
    EXPECT_FALSE(sensible(l));
    l.path[0].level = std::nanf("");
    EXPECT_FALSE(sensible(l));
    l.path[0].level = 0.5F;
    EXPECT_TRUE(sensible(l));
    std::memset(l.path[0].path, 'x', sizeof l.path[0].path);
    EXPECT_FALSE(sensible(l));
}

TEST(RegionChecks, find_a_path_by_its_full_name) {
    LevelsTopic l{};
    l.count = 2;
    std::strcpy(l.path[0].path, "gui.mesh2");
    std::strcpy(l.path[1].path, "gui.mesh");
    EXPECT_EQ(find_path(l, kMeshPath), &l.path[1]);
    EXPECT_EQ(find_path(l, "gui.mes"), nullptr);
    l.count = 1;
    EXPECT_EQ(find_path(l, kMeshPath), nullptr);
}

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

TEST(StatusText, grades_the_rate_against_its_goal) {
    EXPECT_EQ(rate_status(1000.0, 1000.0).grade, Grade::good);
    EXPECT_EQ(rate_status(998.0, 1000.0).grade, Grade::good);
    EXPECT_EQ(rate_status(1200.0, 1000.0).grade, Grade::good);
    EXPECT_EQ(rate_status(997.0, 1000.0).grade, Grade::watch);
    EXPECT_EQ(rate_status(996.0, 1000.0).text, "0.4 % below target");
    EXPECT_EQ(rate_status(940.0, 1000.0).grade, Grade::watch);
    EXPECT_EQ(rate_status(700.0, 1000.0).grade, Grade::bad);
    EXPECT_NE(rate_status(700.0, 1000.0).text.find("30 %"), std::string::npos);
    EXPECT_EQ(rate_status(5.0, 0.0).grade, Grade::unknown);
}

TEST(StatusTexts, of_devices_motors_and_trackers_show_the_worst_known_state) {
    DeviceHand d{};
    EXPECT_EQ(device_status(d, {}, DeviceNotice::none).grade, Grade::unknown);
    d.valid = 1;
    d.state = 2;
    EXPECT_EQ(device_status(d, {}, DeviceNotice::none).grade, Grade::good);
    EXPECT_EQ(device_status(d, {}, DeviceNotice::none).text, "powered");
    BusCounts lossy;
    lossy.lost = 3;
    EXPECT_EQ(device_status(d, lossy, DeviceNotice::none).grade, Grade::watch);
    EXPECT_EQ(device_status(d, {}, DeviceNotice::keep_still).grade, Grade::watch);
    EXPECT_EQ(device_status(d, {}, DeviceNotice::gone).grade, Grade::bad);
    d.read = 1;
    EXPECT_EQ(device_status(d, {}, DeviceNotice::none).grade, Grade::watch);
    d.read = 2;
    EXPECT_EQ(device_status(d, {}, DeviceNotice::none).text, "lost");
    d.read = 0;
    d.state = 4;
    EXPECT_EQ(device_status(d, {}, DeviceNotice::none).grade, Grade::bad);

    DeviceHand m{};
    EXPECT_EQ(motor_status(m).grade, Grade::unknown);
    m.force_n_continuous = 1.4F;
    m.heat = 0.79F;
    EXPECT_EQ(motor_status(m).grade, Grade::good);
    m.heat = 0.81F;
    EXPECT_EQ(motor_status(m).grade, Grade::watch);
    m.heat = 1.01F;
    EXPECT_EQ(motor_status(m).grade, Grade::bad);
    EXPECT_NE(motor_status(m).text.find("1.4 N"), std::string::npos);
    m.winding_c_max = 100.0F;  // the driver's winding temperature takes precedence
    m.winding_c = 60.0F;
    EXPECT_EQ(motor_status(m).grade, Grade::good);
    m.winding_c = 90.0F;
    EXPECT_EQ(motor_status(m).grade, Grade::watch);
    m.winding_c = 101.0F;
    EXPECT_EQ(motor_status(m).grade, Grade::bad);

    TrackerTopic t{};
    t.link = 1;
    t.state = 2;
    EXPECT_EQ(tracker_status(t).grade, Grade::good);
    t.state = 1;
    EXPECT_EQ(tracker_status(t).grade, Grade::watch);
    t.state = 0;
    EXPECT_EQ(tracker_status(t).grade, Grade::bad);
    t.link = 4;
    EXPECT_EQ(tracker_status(t).text, "gone");
    EXPECT_EQ(tracker_counts_text(t), "");
    t.missed = 2;
    t.bus_errors = 1;
    EXPECT_EQ(tracker_counts_text(t), "missed 2, bus errors 1");

    EXPECT_EQ(display_status(0.0, 30.0).grade, Grade::unknown);
    EXPECT_EQ(display_status(29.0, 30.0).grade, Grade::good);
    EXPECT_EQ(display_status(20.0, 30.0).grade, Grade::watch);
    EXPECT_EQ(display_status(10.0, 30.0).grade, Grade::bad);
    EXPECT_EQ(display_status(25.0, 0.0).grade, Grade::good);
    EXPECT_EQ(display_status(15.0, 0.0).grade, Grade::watch);
}

TEST(StatusText, every_grade_has_a_text) {
    for (int state = 0; state < 7; ++state)
        for (int reason = 0; reason < 15; ++reason)
            EXPECT_FALSE(
                state_status(static_cast<RunState>(state), static_cast<RunReason>(reason)).text.empty());
    EXPECT_EQ(state_status(RunState::fault, RunReason::device_lost).grade, Grade::bad);
    const auto overran = [](std::uint64_t overruns, std::uint64_t cycles) {
        HealthTopic h{};
        h.overruns = overruns;
        h.cycle = cycles;
        h.overrun_at_ns = overruns > 0 ? 1'000'000'000 : 0;
        return overrun_status(h, 13'000'000'000);
    };
    EXPECT_EQ(overran(0, 1000).grade, Grade::good);
    EXPECT_EQ(overran(1, 1'000'000).grade, Grade::watch);
    EXPECT_EQ(overran(1, 1'000'000).text, "last: 12 s ago");
    EXPECT_EQ(overran(100, 1000).grade, Grade::bad);
    const auto missed = [](std::uint64_t misses, float share) {
        HealthTopic h{};
        h.deadline_misses = misses;
        h.deadline_miss_share = share;
        h.deadline_missed_at_ns = 1'000'000'000;
        return deadline_status(h, 13'000'000'000);
    };
    EXPECT_EQ(missed(0, 0.0F).grade, Grade::good);
    EXPECT_EQ(missed(3, 0.0F).text, "last: 12 s ago");
    EXPECT_EQ(missed(3, 5e-4F).grade, Grade::watch);
    EXPECT_EQ(missed(300, 0.3F).grade, Grade::bad);
    EXPECT_EQ(missed(300, 0.3F).text, "30 % last second");
    EXPECT_EQ(lateness_status(50'000, 1'000'000).grade, Grade::good);
    EXPECT_EQ(lateness_status(900'000, 1'000'000).grade, Grade::bad);
    EXPECT_EQ(bus_status({.packets = 1000}).grade, Grade::good);
    EXPECT_EQ(bus_status({.packets = 1000, .stalls = 1}).grade, Grade::watch);
    EXPECT_EQ(bus_status({.packets = 1000, .checksum = 1, .refused = 2, .repeated = 3, .lost = 4}).text,
              "6 bad, 4 lost");
    HealthTopic health{};
    EXPECT_EQ(memory_status(health).grade, Grade::good);
    health.page_faults = 2;
    EXPECT_EQ(memory_status(health).grade, Grade::watch);
    health.allocations = 1;
    EXPECT_EQ(memory_status(health).grade, Grade::bad);
    EXPECT_NE(memory_status(health).text.find("1 allocation,"), std::string::npos);
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

TEST(StatusTexts, of_a_stop_give_the_reason_and_the_fix) {
    HealthTopic h{};
    for (const auto state : {RunState::off, RunState::ready, RunState::armed, RunState::active}) {
        h.state = static_cast<std::uint8_t>(state);
        EXPECT_TRUE(stop_notice(h).why.empty());
    }
    h.state = static_cast<std::uint8_t>(RunState::fault);
    std::set<std::string> fixes;
    for (int reason = 0; reason < 256; ++reason) {
        h.reason = static_cast<std::uint8_t>(reason);
        const StopNotice notice = stop_notice(h);
        EXPECT_FALSE(notice.why.empty());
        EXPECT_NE(notice.fix.find("Reset"), std::string::npos) << notice.fix;
        EXPECT_EQ(notice.grade, Grade::bad);
        fixes.insert(notice.fix);
    }
    EXPECT_GE(fixes.size(), 10U);
    // The lines' own reason takes precedence: the operator can clear it.
    h.lines = static_cast<std::uint8_t>(LinesShown::stopped);
    h.lines_reason = static_cast<std::uint8_t>(RunReason::emergency_stop);
    EXPECT_NE(stop_notice(h).why.find("emergency stop"), std::string::npos);
    h.state = static_cast<std::uint8_t>(RunState::ready);
    EXPECT_NE(stop_notice(h).fix.find("release the button"), std::string::npos);
    EXPECT_EQ(stop_notice(h).fix.find("Reset"), std::string::npos);
    h.lines = static_cast<std::uint8_t>(LinesShown::permitted);
    EXPECT_TRUE(stop_notice(h).why.empty());
}

TEST(StatusTexts, of_a_distance_are_red_below_1_mm_amber_below_2_mm_and_predict_the_approach) {
    EXPECT_EQ(distance_status(-1e-4, 0.0, false).text, "inside");
    EXPECT_EQ(distance_status(-1e-4, 0.0, false).grade, Grade::bad);
    EXPECT_EQ(distance_status(0.99e-3, 0.0, false).grade, Grade::bad);
    EXPECT_EQ(distance_status(1.01e-3, 0.0, false).grade, Grade::watch);
    EXPECT_EQ(distance_status(1.99e-3, 0.0, false).grade, Grade::watch);
    EXPECT_EQ(distance_status(2.01e-3, 0.0, false).grade, Grade::good);
    // 4 mm away, approaching at 10 mm/s: 1 mm in 0.3 s, if the burr turns.
    EXPECT_EQ(distance_status(4e-3, 1e-2, true).text, "1 mm in 0.3 s");
    EXPECT_EQ(distance_status(4e-3, 1e-2, true).grade, Grade::watch);
    EXPECT_EQ(distance_status(4e-3, 1e-2, false).grade, Grade::good);
    EXPECT_EQ(distance_status(4e-3, 2e-3, true).grade, Grade::good);
    EXPECT_EQ(distance_status(4e-3, -1e-2, true).grade, Grade::good);
    EXPECT_EQ(distance_status(std::nan(""), 0.0, true).grade, Grade::unknown);
}

TEST(StatusTexts, of_the_force_on_a_burr_give_the_time_above_the_limit) {
    EXPECT_EQ(force_status(1.0, 0.0).text, "always below 2 N");
    EXPECT_EQ(force_status(1.0, 3.21).text, "above 2 N for 3.2 s");
    EXPECT_EQ(force_status(1.0, 3.21).grade, Grade::good);
    EXPECT_EQ(force_status(2.1, 3.21).grade, Grade::watch);
}

}  // namespace
}  // namespace tact::gui_link_test
