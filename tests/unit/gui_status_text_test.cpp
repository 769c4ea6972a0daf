// What the window says of the controller's numbers, and how it grades them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "gui/dashboard/status_text.hpp"

namespace tact::gui_status_text_test {
namespace {

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
}  // namespace tact::gui_status_text_test
