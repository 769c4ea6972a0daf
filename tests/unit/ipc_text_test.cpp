#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "ipc/base/device_notice.hpp"
#include "ipc/topics/level_text.hpp"
#include "ipc/topics/text.hpp"

namespace tact::ipc_text_test {
namespace {

// Each value of an enum up to `last` has its own text; values beyond give "unknown".
template <class E, class Text>
void expect_own_words(Text text, E last, bool zero_is_empty) {
    std::set<std::string> seen;
    for (unsigned v = 0; v <= static_cast<unsigned>(last); ++v) {
        const std::string words = text(static_cast<E>(v));
        EXPECT_NE(words, "unknown") << v;
        EXPECT_EQ(words.empty(), zero_is_empty && v == 0) << v;
        EXPECT_TRUE(seen.insert(words).second) << v << " has the same text as another value: " << words;
    }
    EXPECT_STREQ(text(static_cast<E>(static_cast<unsigned>(last) + 1)), "unknown");
    EXPECT_STREQ(text(static_cast<E>(255)), "unknown");
}

TEST(LevelText, gives_limit_duration_and_error) {
    PathLevel p{};
    p.haptic = 1;
    p.level = 0.5F;
    p.error = 0.0131;
    p.changed_at_ns = 1'000'000'000;
    p.reason = static_cast<std::uint8_t>(LevelReason::cost_low);
    EXPECT_EQ(level_status_text(p, 13'000'000'000), "step cost limit, 12 s, ±0.013 N");
    p.reason = static_cast<std::uint8_t>(LevelReason::deadline_missed);
    EXPECT_EQ(level_status_text(p, 3'500'000'000), "deadline missed, 2.5 s, ±0.013 N");
    p.level = 1.0F;
    p.error = 0.0;
    EXPECT_EQ(level_status_text(p, 13'000'000'000), "full detail");
    p.haptic = 0;
    p.level = 0.3F;
    p.reason = static_cast<std::uint8_t>(LevelReason::display_low);
    EXPECT_EQ(level_status_text(p, 1'801'000'000'000), "frame rate limit, 30 min");
    // A time from another clock and a non-finite error are omitted.
    p.haptic = 1;
    p.error = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(level_status_text(p, 0), "frame rate limit");
}

TEST(Text, every_code_has_its_own_text) {
    expect_own_words(run_state_text, RunState::fault, false);
    expect_own_words(run_reason_text, RunReason::supervisor, true);
    expect_own_words(event_code_text, EventCode::device_notice, true);
    expect_own_words(lines_text, LinesShown::permitted, true);
    expect_own_words(device_notice_text, static_cast<DeviceNotice>(kDeviceNotices - 1), true);
    expect_own_words(level_reason_text, LevelReason::deadline_missed, false);
    expect_own_words(command_kind_text, kLastCommand, true);
    expect_own_words(command_result_text, CommandResult::unknown, true);
    expect_own_words(frame_part_text, FramePart::particles, false);
}

TEST(Text, head_codes_are_spelled_out) {
    EXPECT_STREQ(head_state_text(2), "fresh");
    EXPECT_STREQ(head_state_text(3), "unknown");
    EXPECT_STREQ(head_link_text(3), "bus off");
    EXPECT_STREQ(head_link_text(255), "unknown");
}

TEST(Text, events_carry_their_numbers_and_units) {
    const auto text = [](EventCode code, double a, double b, std::uint16_t detail = 0) {
        EventTopic e{};
        e.detail = detail;
        e.code = static_cast<std::uint16_t>(code);
        e.a = a;
        e.b = b;
        return event_text(e);
    };
    EXPECT_EQ(text(EventCode::overrun, 120, 3), "overrun: 120 us late, 3 so far");
    EXPECT_EQ(text(EventCode::overrun, 8987.07, 4), "overrun: 8.99 ms late, 4 so far");
    EXPECT_EQ(text(EventCode::overrun, 2.5e6, 1), "overrun: 2.5 s late, 1 so far");
    EXPECT_EQ(text(EventCode::gui_silent, 500.52, 0), "display process not responding: for 501 ms");
    EXPECT_EQ(text(EventCode::fault_latched, static_cast<double>(RunReason::emergency_stop), 0),
              "fault: the emergency stop is pressed");
    const auto lost = static_cast<double>(RunReason::device_lost);
    EXPECT_EQ(text(EventCode::fault_latched, lost, 0, 1), "fault of the first hand: the device is lost");
    EXPECT_EQ(text(EventCode::fault_latched, lost, 0, 2), "fault of the second hand: the device is lost");
    EventTopic fault{};
    fault.a = lost;
    EXPECT_EQ(
        fault_fix(fault),
        "Check the device's cable and power; tact probe lists the devices. Then reset the fault, and arm.");
    EXPECT_EQ(text(EventCode::stopping, SIGTERM, 0), "stopping: signal 15");
    EXPECT_EQ(text(EventCode::stopping, SIGXCPU, 0),
              "stopping: the servo did not sleep for 1 s; choose a lower rate");
    EXPECT_EQ(text(EventCode::state_changed, 1, 4), "state changed: ready to fault");
    EXPECT_EQ(text(EventCode::force_limited, 5.50321, 3.3), "force limited: 5.5 N requested, 3.3 N allowed");
    EXPECT_EQ(text(EventCode::command_done, 1, 2), "command arm: refused: not in this state");
    EXPECT_EQ(text(EventCode::lines_changed, 1, 15), "safety inputs: stop: the dead-man switch is released");
    EXPECT_EQ(text(EventCode::lines_changed, 3, 0), "safety inputs: permit");
    EXPECT_EQ(text(EventCode::level_changed, kDisplayPathIndex, 0.5), "level changed: display to 0.5, start");
    EXPECT_EQ(text(EventCode::level_changed, kForcePathIndex, 0.25,
                   static_cast<std::uint16_t>(LevelReason::rate_low)),
              "level changed: force to 0.25, force rate below goal");
    EXPECT_EQ(text(EventCode::level_changed, kForcePathIndex, 0.25, 999),
              "level changed: force to 0.25, unknown");
    EventTopic of_path{};
    of_path.code = static_cast<std::uint16_t>(EventCode::level_changed);
    of_path.a = 2;
    of_path.b = 0.25;
    EXPECT_EQ(event_text(of_path), "level changed: path 2 to 0.25, start");
    LevelsTopic levels{};
    levels.count = 3;
    std::strcpy(levels.path[2].path, kMoleculesPath);
    EXPECT_EQ(event_text(of_path, &levels), "level changed: molecules to 0.25, start");
    levels.count = 2;
    EXPECT_EQ(event_text(of_path, &levels), "level changed: path 2 to 0.25, start");
    EXPECT_EQ(text(EventCode::level_changed, 7, 1), "level changed: path 7 to 1, start");
    EXPECT_EQ(text(EventCode::body_selected, 3, 825), "body held: body 3, 825 points");
    EXPECT_EQ(text(EventCode::body_selected, 4294967295.0, 0), "no body held");
    EXPECT_EQ(text(EventCode::device_notice, static_cast<double>(DeviceNotice::keep_still), 0),
              "device: keep the arm still");
    EXPECT_EQ(text(EventCode::device_notice, 0, 1), "device of the second hand: no notice");
    EXPECT_EQ(text(EventCode::device_notice, 1e9, 0), "device: unknown");
    EXPECT_EQ(text(static_cast<EventCode>(999), 0, 0), "unknown event 999");
}

TEST(Text, hostile_events_give_short_text) {
    for (const double bad :
         {std::nan(""), std::numeric_limits<double>::infinity(), -1e300, 1e300, -1.0, 256.0}) {
        for (unsigned code = 0; code < 300; ++code) {
            EventTopic e{};
            e.code = static_cast<std::uint16_t>(code);
            e.a = bad;
            e.b = bad;
            EXPECT_LT(event_text(e).size(), 120U);
        }
    }
}

TEST(Text, only_bus_errors_are_listed) {
    EXPECT_EQ(bus_text({.packets = 5}), "");
    EXPECT_EQ(bus_text({.packets = 5, .checksum = 3, .lost = 12, .reconnects = 1}),
              "checksum 3, lost 12, connected again 1");
    BusCounts all{};
    all.refused = all.repeated = all.transfers_failed = all.stalls = all.commands_refused = all.bad_seconds =
        saturated(1ULL << 40U);
    EXPECT_EQ(
        bus_text(all),
        "refused 4294967295, repeated 4294967295, transfers failed 4294967295, stalls 4294967295, commands "
        "refused 4294967295, bad seconds 4294967295");
}

TEST(Text, schedule_is_spelled_out) {
    EXPECT_EQ(schedule_text(0), "ordinary scheduling");
    EXPECT_EQ(schedule_text(kScheduleFifo | kSchedulePinned | kScheduleLocked),
              "FIFO, pinned, memory locked");
    EXPECT_EQ(schedule_text(kScheduleLocked), "ordinary scheduling, memory locked");
}

}  // namespace
}  // namespace tact::ipc_text_test
