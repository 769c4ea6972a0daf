#include "gui/dashboard/status_text.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "ipc/topics/text.hpp"

namespace tact {
namespace {

std::string count_text(std::uint64_t n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

}  // namespace

std::string ago_text(double s) {
    char text[48];
    if (s < 99.5) {
        std::snprintf(text, sizeof text, "%.0f s ago", s);
    } else if (s < 5970.0) {
        std::snprintf(text, sizeof text, "%.0f min ago", s / 60.0);
    } else {
        std::snprintf(text, sizeof text, "%.1f h ago", s / 3600.0);
    }
    return text;
}

const char* grade_text(Grade grade) noexcept {
    switch (grade) {
        case Grade::good:
            return "good";
        case Grade::watch:
            return "watch";
        case Grade::bad:
            return "bad";
        case Grade::unknown:
            break;
    }
    return "unknown";
}

// Less is how exactly the rate is counted.
constexpr double kOnTarget = 0.0025;

StatusText rate_status(double rate_hz, double goal_hz) {
    if (!(goal_hz > 0.0) || !std::isfinite(rate_hz)) return {Grade::unknown, "no goal set"};
    const double missing = 1.0 - rate_hz / goal_hz;
    char text[48];
    if (missing <= kOnTarget) return {Grade::good, "on target"};
    std::snprintf(text, sizeof text, missing < 0.01 ? "%.1f %% below target" : "%.0f %% below target",
                  100.0 * missing);
    return {missing <= 0.15 ? Grade::watch : Grade::bad, text};
}

StatusText lateness_status(std::int64_t p99_ns, std::int64_t period_ns) {
    const double period = period_ns > 0 ? static_cast<double>(period_ns) : 1e6;
    const double part = static_cast<double>(p99_ns) / period;
    if (part < 0.1) return {Grade::good, "on time"};
    if (part < 0.5) return {Grade::watch, "sometimes late"};
    return {Grade::bad, "often late"};
}

StatusText recomputed_status(float mean) {
    if (mean >= 0.95F) return {Grade::good, "of each step recomputed"};
    return {mean >= 0.5F ? Grade::watch : Grade::bad, "the rest reuses older sums"};
}

StatusText bus_status(const BusCounts& counts) {
    if (counts.clean()) return {Grade::good, "no errors"};
    const std::uint64_t bad = std::uint64_t{counts.checksum} + counts.refused + counts.repeated;
    return {Grade::watch, std::to_string(bad) + " bad, " + std::to_string(counts.lost) + " lost"};
}

StatusText overrun_status(const HealthTopic& h, std::int64_t now_ns) {
    if (h.overruns == 0) return {Grade::good, "none"};
    const double part = static_cast<double>(h.overruns) / static_cast<double>(h.cycle > 0 ? h.cycle : 1);
    char text[64];
    std::snprintf(text, sizeof text, "%.2g %% of the cycles", 100.0 * part);
    std::string words = text;
    const double ago_s = 1e-9 * static_cast<double>(now_ns - h.overrun_at_ns);
    if (h.overrun_at_ns > 0 && ago_s >= 0.0) words = "last: " + ago_text(ago_s);
    return {part < 1e-3 ? Grade::watch : Grade::bad, words};
}

StatusText deadline_status(const HealthTopic& h, std::int64_t now_ns) {
    if (h.deadline_misses == 0) return {Grade::good, "all met"};
    if (h.deadline_miss_share > 0.0F) {
        char text[64];
        std::snprintf(text, sizeof text, "%.2g %% last second",
                      100.0 * static_cast<double>(h.deadline_miss_share));
        return {h.deadline_miss_share < 1e-3F ? Grade::watch : Grade::bad, text};
    }
    const double ago_s = 1e-9 * static_cast<double>(now_ns - h.deadline_missed_at_ns);
    return {Grade::watch,
            h.deadline_missed_at_ns > 0 && ago_s >= 0.0 ? "last: " + ago_text(ago_s) : "not lately"};
}

StatusText state_status(RunState state, RunReason reason) {
    std::string words, then;  // what is, and what a person can do
    Grade grade = Grade::watch;
    switch (state) {
        case RunState::off:
            words = "device not open";
            break;
        case RunState::ready:
            words = "Disarmed";
            then = " Press Arm.";
            break;
        case RunState::armed:
            words = "Armed";
            then = " No force until hand on the device.";
            break;
        case RunState::active:
            grade = Grade::good;
            words = "Force on";
            break;
        case RunState::fault:
            grade = Grade::bad;
            words = "No force until Reset";
            break;
        default:
            return {Grade::unknown, "unknown state"};
    }
    const std::string why = run_reason_text(reason);
    if (!why.empty()) words += ": " + why;
    if (!then.empty()) words += "." + then;
    return {grade, words};
}

StopNotice stop_notice(const HealthTopic& h) {
    const auto state = static_cast<RunState>(h.state);
    const auto lines = static_cast<LinesShown>(h.lines);
    const bool stopped = lines == LinesShown::stopped;
    if (!stopped && state != RunState::fault) return {};
    const auto reason = static_cast<RunReason>(stopped ? h.lines_reason : h.reason);
    StopNotice notice{Grade::bad, run_reason_text(reason), run_reason_fix(reason)};
    if (notice.why.empty()) notice.why = "force stopped";
    notice.fix += state == RunState::fault ? " Then press Reset, and Arm." : " Then press Arm.";
    return notice;
}

StatusText memory_status(const HealthTopic& health) {
    if (health.allocations + health.locks + health.page_faults == 0)
        return {Grade::good, "no allocations, locks or page faults"};
    std::string words;
    const auto add = [&words](const std::string& part) { words += (words.empty() ? "" : ", ") + part; };
    if (health.allocations > 0) add(count_text(health.allocations, "allocation", "allocations"));
    if (health.locks > 0) add(count_text(health.locks, "lock", "locks"));
    if (health.page_faults > 0) add(count_text(health.page_faults, "page fault", "page faults"));
    return {health.allocations + health.locks > 0 ? Grade::bad : Grade::watch, words};
}

StatusText distance_status(double distance_m, double closing_m_s, bool turns) {
    constexpr double kRedM = 1e-3, kAmberM = 2e-3, kAheadS = 1.0;
    if (!std::isfinite(distance_m)) return {Grade::unknown, "unknown"};
    if (distance_m < 0.0) return {Grade::bad, "inside"};
    if (distance_m < kRedM) return {Grade::bad, "too close"};
    if (turns && closing_m_s > 0.0) {
        const double ahead_s = (distance_m - kRedM) / closing_m_s;
        if (ahead_s < kAheadS) {
            char text[48];
            std::snprintf(text, sizeof text, "1 mm in %.1f s", ahead_s);
            return {Grade::watch, text};
        }
    }
    if (distance_m < kAmberM) return {Grade::watch, "near"};
    return {Grade::good, "clear"};
}

StatusText force_status(double force_n, double excess_s) {
    constexpr double kExcessN = 2.0;
    char text[48];
    std::snprintf(text, sizeof text, "above 2 N for %.1f s", excess_s);
    if (force_n > kExcessN) return {Grade::watch, text};
    return {Grade::good, excess_s >= 0.05 ? text : "always below 2 N"};
}

// Numbers of DeviceState in the device interface, which this process does not include.
const char* device_state_text(std::uint8_t device_state) noexcept {
    static constexpr const char* kTexts[] = {"closed", "ready", "powered", "watchdog tripped", "fault"};
    return device_state < 5 ? kTexts[device_state] : "unknown";
}

Grade notice_grade(DeviceNotice notice) noexcept {
    if (notice == DeviceNotice::none) return Grade::good;
    return asks(notice) || notice == DeviceNotice::states_refused ? Grade::watch : Grade::bad;
}

Grade device_grade(std::uint8_t device_state) noexcept {
    static constexpr Grade kGrades[] = {Grade::watch, Grade::good, Grade::good, Grade::bad, Grade::bad};
    return device_state < 5 ? kGrades[device_state] : Grade::unknown;
}

StatusText device_status(const DeviceHand& device, const BusCounts& bus, DeviceNotice notice) {
    if (device.valid == 0) return {Grade::unknown, "none"};
    static constexpr const char* kReads[] = {"", "position outdated", "lost", "fault"};
    if (device.read > 3) return {Grade::unknown, "unknown"};
    if (device.read >= 2) return {Grade::bad, kReads[device.read]};
    const Grade state = device_grade(device.state);
    if (state == Grade::bad) return {Grade::bad, device_state_text(device.state)};
    if (notice_grade(notice) == Grade::bad) return {Grade::bad, "see the notice above"};
    if (device.read == 1) return {Grade::watch, kReads[1]};
    if (notice != DeviceNotice::none) return {Grade::watch, asks(notice) ? "needs attention" : "see above"};
    if (!bus.clean()) return bus_status(bus);
    return {state, device_state_text(device.state)};
}

StatusText motor_status(const DeviceHand& device) {
    constexpr double kRestC = 25.0;
    const auto grade = [](double share) {
        return share < 0.8 ? Grade::good : share < 1.0 ? Grade::watch : Grade::bad;
    };
    char text[64];
    if (device.winding_c_max > 0.0F) {
        const double share = (static_cast<double>(device.winding_c) - kRestC) /
                             (static_cast<double>(device.winding_c_max) - kRestC);
        const Grade g = grade(share);
        std::snprintf(text, sizeof text, "%s, motor %d of %.0f °C",
                      g == Grade::good    ? "cool"
                      : g == Grade::watch ? "warm, force reduced"
                                          : "hot",
                      device.motor + 1, static_cast<double>(device.winding_c_max));
        return {g, text};
    }
    if (!(device.force_n_continuous > 0.0F)) return {Grade::unknown, "heat not modelled"};
    const Grade g = grade(static_cast<double>(device.heat));
    if (g == Grade::good) return {g, "cool"};
    if (g == Grade::watch) return {g, "warm, force reduced"};
    std::snprintf(text, sizeof text, "hot, limit %.1f N", static_cast<double>(device.force_n_continuous));
    return {g, text};
}

// Numbers of TrackerState and TrackerLink, which this process does not include.
StatusText tracker_status(const TrackerTopic& t) {
    constexpr std::uint8_t kLinkUp = 1, kFrozen = 1, kFresh = 2;
    if (t.link != kLinkUp) return {Grade::bad, head_link_text(t.link)};
    if (t.state == kFrozen) return {Grade::watch, "frozen, view held"};
    if (t.state != kFresh) return {Grade::bad, "lost, view held"};
    return {Grade::good, "fresh"};
}

std::string tracker_counts_text(const TrackerTopic& t) {
    const std::pair<const char*, std::uint64_t> kRows[] = {
        {"missed", t.missed},    {"refused", t.refused},       {"dropped", t.dropped},
        {"floods", t.floods},    {"bus errors", t.bus_errors}, {"link losses", t.link_losses},
        {"reopened", t.reopened}};
    std::string text;
    for (const auto& [name, n] : kRows) {
        if (n > 0) text += (text.empty() ? "" : ", ") + std::string(name) + " " + std::to_string(n);
    }
    return text;
}

StatusText display_status(double fps, double goal_hz) {
    if (!(fps > 0.0)) return {Grade::unknown, "no frame yet"};
    const bool goal = goal_hz > 0.0;
    const double share = fps / (goal ? goal_hz : 20.0);
    if (share >= (goal ? 0.9 : 1.0)) return {Grade::good, goal ? "on target" : "smooth"};
    char text[48];
    std::snprintf(text, sizeof text, "below %s%.0f", goal ? "goal of " : "", goal ? goal_hz : 20.0);
    return {share >= 0.6 ? Grade::watch : Grade::bad, text};
}

}  // namespace tact
