// The tray of burrs: keys reach each of a kind, every one is an order that the controller accepts.
#include <gtest/gtest.h>

#include "gui/drilling/burr_tray.hpp"
#include "rt/threads/command_feed.hpp"

namespace tact::gui_burr_tray_test {
namespace {

bool same(const TrayBurr& a, const TrayBurr& b) {
    return a.grit == b.grit && a.shape == b.shape && a.diameter_m == b.diameter_m && a.length_m == b.length_m;
}

TEST(BurrTray, keys_step_through_all_of_a_kind_and_stay_at_its_ends) {
    for (const DrillGrit grit : {DrillGrit::cutting, DrillGrit::diamond}) {
        std::size_t count = 0;
        for (const TrayBurr& b : kBurrTray) count += b.grit == grit && b.shape == DrillShape::sphere ? 1 : 0;
        TrayBurr now{grit, DrillShape::sphere, 0.5e-3, 0.0};  // not on the tray: the smallest is next
        EXPECT_TRUE(same(next_burr(now, -1), now));
        std::size_t seen = 0;
        for (TrayBurr next = next_burr(now, 1); !same(next, now); next = next_burr(now, 1)) {
            EXPECT_GT(next.diameter_m, now.diameter_m);
            now = next;
            ++seen;
        }
        EXPECT_EQ(seen, count);
        for (TrayBurr next = next_burr(now, -1); !same(next, now); next = next_burr(now, -1)) {
            EXPECT_LT(next.diameter_m, now.diameter_m);
            now = next;
            --seen;
        }
        EXPECT_EQ(seen, 1U);
    }
}

TEST(BurrTray, the_other_grit_is_the_ball_nearest_in_size) {
    const TrayBurr cutting{DrillGrit::cutting, DrillShape::sphere, 4e-3, 0.0};
    const TrayBurr diamond = other_grit(cutting);
    EXPECT_TRUE(same(diamond, {DrillGrit::diamond, DrillShape::sphere, 4e-3, 0.0}));
    EXPECT_TRUE(same(other_grit(diamond), cutting));
    EXPECT_TRUE(same(other_grit({DrillGrit::diamond, DrillShape::sphere, 2.3e-3, 0.0}),
                     {DrillGrit::cutting, DrillShape::sphere, 2e-3, 0.0}));
    EXPECT_TRUE(same(other_grit({DrillGrit::cutting, DrillShape::cone, 3e-3, 8e-3}),
                     {DrillGrit::diamond, DrillShape::sphere, 3e-3, 0.0}));
}

TEST(BurrTray, each_burr_is_an_order_that_the_controller_accepts) {
    for (const TrayBurr& b : kBurrTray) {
        const Request r = burr_request(b);
        CommandTopic c{};
        c.sequence = 1;
        c.kind = static_cast<std::uint16_t>(r.kind);
        c.value = r.value;
        c.body = r.body;
        c.pos_model_m[0] = r.second;
        const CheckedCommand checked = check_command(c, {});
        EXPECT_EQ(checked.result, CommandResult::none) << b.diameter_m;
        EXPECT_EQ(checked.order.value, b.diameter_m);
        EXPECT_EQ(checked.order.pos_model_m[0], b.length_m);
        EXPECT_EQ(checked.order.body & 0xFFU, static_cast<std::uint32_t>(b.shape));
        EXPECT_EQ(checked.order.body >> 8U, static_cast<std::uint32_t>(b.grit));
    }
}

TEST(BurrTray, orders_out_of_range_are_refused_before_they_reach_the_servo) {
    const auto result = [](CommandKind kind, double value, std::uint32_t body, double second) {
        CommandTopic c{};
        c.sequence = 1;
        c.kind = static_cast<std::uint16_t>(kind);
        c.value = value;
        c.body = body;
        c.pos_model_m[0] = second;
        return check_command(c, {}).result;
    };
    const double nan = std::nan("");
    using enum CommandKind;
    EXPECT_EQ(result(set_burr, 4e-3, 0x102U, 8e-3), CommandResult::none);
    for (const double diameter_m : {nan, 0.0, -4e-3, 0.1e-3, 41e-3, 1e9})
        EXPECT_EQ(result(set_burr, diameter_m, 0, 0.0), CommandResult::refused_value) << diameter_m;
    for (const double length_m : {nan, -1e-3, 41e-3})
        EXPECT_EQ(result(set_burr, 4e-3, 1, length_m), CommandResult::refused_value) << length_m;
    for (const std::uint32_t body : {3U, 0x200U, 0x1000000U, 0xFFFFFFFFU})
        EXPECT_EQ(result(set_burr, 4e-3, body, 8e-3), CommandResult::refused_value) << body;
    for (const CommandKind kind : {set_burr_speed, set_irrigation, set_suction}) {
        EXPECT_EQ(result(kind, 0.0, 0, 0.0), CommandResult::none);
        for (const double value : {nan, -1e-12, 1e5})
            EXPECT_EQ(result(kind, value, 0, 0.0), CommandResult::refused_value) << value;
    }
    EXPECT_EQ(result(set_burr_speed, 6283.0, 0, 0.0), CommandResult::none);
}

}  // namespace
}  // namespace tact::gui_burr_tray_test
