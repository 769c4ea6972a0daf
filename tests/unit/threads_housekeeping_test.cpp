// Checks of the housekeeping thread on commands from the other process.
#include "rt/threads/housekeeping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace tact::threads_housekeeping_test {
namespace {

const std::vector<std::string> kPaths{"gui.mesh", "docking.force"};

CommandTopic command(CommandKind kind, double value = 0.0, const char* text = "") {
    CommandTopic c{};
    c.sequence = 7;
    c.kind = static_cast<std::uint16_t>(kind);
    c.value = value;
    std::strncpy(c.text, text, sizeof c.text - 1);
    return c;
}

TEST(Housekeeping, passes_valid_commands_with_path_indices) {
    const CheckedCommand level = check_command(command(CommandKind::set_level, 0.5, "docking.force"), kPaths);
    EXPECT_EQ(level.result, CommandResult::none);
    EXPECT_EQ(level.order.index, 1U);
    EXPECT_EQ(level.order.sequence, 7U);
    const CheckedCommand law = check_command(command(CommandKind::set_law, 0.0, "fixed"), kPaths);
    EXPECT_EQ(law.result, CommandResult::none);
    EXPECT_EQ(law.order.index, 1U);
    EXPECT_EQ(check_command(command(CommandKind::arm), kPaths).result, CommandResult::none);
    EXPECT_EQ(check_command(command(CommandKind::set_goal_hz, 800.0), kPaths).result, CommandResult::none);
}

TEST(Housekeeping, refuses_invalid_commands) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(check_command(command(CommandKind::arm, nan), kPaths).result, CommandResult::refused_value);
    EXPECT_EQ(check_command(command(CommandKind::set_level, 0.5, "nowhere"), kPaths).result,
              CommandResult::refused_value);
    EXPECT_EQ(check_command(command(CommandKind::set_level, 1.5, "gui.mesh"), kPaths).result,
              CommandResult::refused_value);
    EXPECT_EQ(check_command(command(CommandKind::set_law, 0.0, "mine"), kPaths).result,
              CommandResult::refused_value);
    EXPECT_EQ(check_command(command(CommandKind::set_goal_hz, 0.0), kPaths).result,
              CommandResult::refused_value);
    EXPECT_EQ(check_command(command(static_cast<CommandKind>(99)), kPaths).result, CommandResult::unknown);
    CommandTopic endless = command(CommandKind::set_law);
    std::memset(endless.text, 'x', sizeof endless.text);
    EXPECT_EQ(check_command(endless, kPaths).result, CommandResult::refused_value);
}

TEST(Housekeeping, passes_orders_to_bodies_with_valid_poses) {
    CommandTopic place = command(CommandKind::place_body);
    place.body = 3;
    place.pos_model_m[1] = 2e-9;
    place.quat_model_body_xyzw[3] = 1.003;
    const CheckedCommand checked = check_command(place, kPaths);
    ASSERT_EQ(checked.result, CommandResult::none);
    EXPECT_EQ(checked.order.body, 3U);
    EXPECT_EQ(checked.order.pos_model_m[1], 2e-9);
    EXPECT_DOUBLE_EQ(checked.order.quat_model_body_xyzw[3], 1.0);  // normalised to a unit quaternion
    CommandTopic select = command(CommandKind::select_body);
    select.body = kNoBody;
    EXPECT_EQ(check_command(select, kPaths).result, CommandResult::none);
    CommandTopic found = place;
    found.kind = static_cast<std::uint16_t>(CommandKind::add_found_place);
    EXPECT_EQ(check_command(found, kPaths).order.pos_model_m[1], 2e-9);
    CommandTopic add = place;
    add.kind = static_cast<std::uint16_t>(CommandKind::add_body);
    add.body = 0;
    EXPECT_EQ(check_command(add, kPaths).result, CommandResult::none);
    for (const CommandKind kind :
         {CommandKind::set_clash, CommandKind::set_subtraction, CommandKind::set_laplacian,
          CommandKind::set_pull, CommandKind::set_flexible, CommandKind::set_together})
        EXPECT_EQ(check_command(command(kind, 1.0), kPaths).result, CommandResult::none);
    CommandTopic filter = command(CommandKind::set_detail_filter, 2.0);
    filter.body = 1;
    filter.pos_model_m[0] = 0.25;
    const CheckedCommand formed = check_command(filter, kPaths);
    EXPECT_EQ(formed.result, CommandResult::none);
    EXPECT_EQ(formed.order.body, 1U);
    EXPECT_EQ(formed.order.pos_model_m[0], 0.25);
    filter.pos_model_m[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(check_command(filter, kPaths).result, CommandResult::refused_value);
    filter.pos_model_m[0] = 0.25;
    filter.body = 256;
    EXPECT_EQ(check_command(filter, kPaths).result, CommandResult::refused_value);
}

TEST(Housekeeping, refuses_orders_to_impossible_bodies) {
    const auto judged = [](CommandKind kind, std::uint32_t body, double value = 0.0) {
        CommandTopic c = command(kind, value);
        c.body = body;
        c.quat_model_body_xyzw[3] = 1.0;
        return check_command(c, kPaths).result;
    };
    EXPECT_EQ(judged(CommandKind::select_body, 0), CommandResult::refused_value);
    for (const CommandKind kind : {CommandKind::fix_body, CommandKind::place_body, CommandKind::remove_body,
                                   CommandKind::add_found_place})
        for (const std::uint32_t id : {0U, kNoBody})
            EXPECT_EQ(judged(kind, id), CommandResult::refused_value);
    EXPECT_EQ(judged(CommandKind::fix_body, 1, 0.5), CommandResult::refused_value);
    EXPECT_EQ(judged(CommandKind::add_body, 65536), CommandResult::refused_value);
    EXPECT_EQ(judged(CommandKind::set_laplacian, 0, -1.0), CommandResult::refused_value);
    for (const double worth : {-0.1, 1.1})
        EXPECT_EQ(judged(CommandKind::add_found_place, 1, worth), CommandResult::refused_value);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CommandTopic place = command(CommandKind::place_body);
    place.body = 1;
    for (const double w : {0.0, nan, 1.2, 0.9, 1e300}) {
        place.quat_model_body_xyzw[3] = w;
        EXPECT_EQ(check_command(place, kPaths).result, CommandResult::refused_value) << w;
    }
    place.quat_model_body_xyzw[3] = 1.0;
    for (const double x : {nan, HUGE_VAL, -1e4}) {
        place.pos_model_m[0] = x;
        EXPECT_EQ(check_command(place, kPaths).result, CommandResult::refused_value) << x;
    }
}

TEST(Housekeeping, random_bytes_are_refused_or_pass_with_values_in_range) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20000; ++i) {
        CommandTopic c{};
        auto* const bytes = reinterpret_cast<unsigned char*>(&c);
        for (std::size_t k = 0; k < sizeof c; ++k) bytes[k] = static_cast<unsigned char>(random());
        c.kind = static_cast<std::uint16_t>(c.kind % (static_cast<unsigned>(kLastCommand) + 2));
        const CheckedCommand checked = check_command(c, kPaths);
        if (checked.result == CommandResult::none) {
            ASSERT_LT(checked.order.index, 2U);
            ASSERT_TRUE(std::isfinite(checked.order.value));
            ASSERT_TRUE(Vec3(checked.order.pos_model_m).allFinite());
            ASSERT_NEAR(Quat(checked.order.quat_model_body_xyzw).norm(), 1.0, 1e-9);
        }
        LoadTopic load{};
        auto* const load_bytes = reinterpret_cast<unsigned char*>(&load);
        for (std::size_t k = 0; k < sizeof load; ++k) load_bytes[k] = static_cast<unsigned char>(random());
        if (plausible(load)) {
            ASSERT_LE(load.vertices_drawn, load.vertices_max);
        }
    }
}

TEST(Housekeeping, a_load_must_be_possible) {
    LoadTopic load{};
    load.frame_s = 0.016;
    load.fps = 60.0;
    load.vertices_drawn = 100;
    load.vertices_max = 200;
    EXPECT_TRUE(plausible(load));
    load.vertices_drawn = 201;
    EXPECT_FALSE(plausible(load));
    load.vertices_drawn = 100;
    load.busy_s = -1.0;
    EXPECT_FALSE(plausible(load));
    load.busy_s = 0.0;
    load.fps = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(plausible(load));
    load.fps = 60.0;
    load.particles = load.particle_moves = load.particles_max = 50000;
    EXPECT_TRUE(plausible(load));
    load.particles = 50001;
    EXPECT_FALSE(plausible(load));
    load.particles = 50000;
    load.particle_moves = 50001;
    EXPECT_FALSE(plausible(load));
    load.particle_moves = 0;
    load.molecule_triangles = load.molecule_triangles_max = 30000;
    load.pixels = load.pixels_max = 2000000;
    load.refined = 2;
    EXPECT_TRUE(plausible(load));
    LoadTopic wrong = load;
    wrong.molecule_triangles = 30001;
    EXPECT_FALSE(plausible(wrong));
    wrong = load;
    wrong.pixels = 2000001;
    EXPECT_FALSE(plausible(wrong));
    wrong = load;
    wrong.refined = 3;
    EXPECT_FALSE(plausible(wrong));
    wrong = load;
    wrong.path_s[3] = -1.0;
    EXPECT_FALSE(plausible(wrong));
}

}  // namespace
}  // namespace tact::threads_housekeeping_test
