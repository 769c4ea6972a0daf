#include "gui/panels/verdict.hpp"

#include <cmath>
#include <cstdio>

#include "ipc/topics/text.hpp"

namespace tact {
namespace {

std::string count_words(std::uint64_t n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

}  // namespace

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

Verdict rate_verdict(double rate_hz, double goal_hz) {
    if (!(goal_hz > 0.0) || !std::isfinite(rate_hz)) return {Grade::unknown, "no goal set"};
    const double missing = 1.0 - rate_hz / goal_hz;
    char text[48];
    if (missing <= 0.05) return {Grade::good, "holds its goal"};
    std::snprintf(text, sizeof text, "%.0f %% below its goal", 100.0 * missing);
    return {missing <= 0.15 ? Grade::watch : Grade::bad, text};
}

Verdict lateness_verdict(std::int64_t p99_ns, std::int64_t period_ns) {
    const double period = period_ns > 0 ? static_cast<double>(period_ns) : 1e6;
    const double part = static_cast<double>(p99_ns) / period;
    if (part < 0.1) return {Grade::good, "on time"};
    if (part < 0.5) return {Grade::watch, "late at times"};
    return {Grade::bad, "late often"};
}

Verdict fresh_verdict(float mean) {
    if (mean >= 0.95F) return {Grade::good, "of each step"};
    return {mean >= 0.5F ? Grade::watch : Grade::bad, "the rest is older sums"};
}

Verdict bus_verdict(const BusCounts& counts) {
    if (counts.clean()) return {Grade::good, "no errors"};
    const std::uint64_t bad = std::uint64_t{counts.checksum} + counts.refused + counts.repeated;
    return {Grade::watch, std::to_string(bad) + " bad, " + std::to_string(counts.lost) + " lost"};
}

Verdict overrun_verdict(std::uint64_t overruns, std::uint64_t cycles) {
    if (overruns == 0) return {Grade::good, "none"};
    const double part = static_cast<double>(overruns) / static_cast<double>(cycles > 0 ? cycles : 1);
    char text[64];
    std::snprintf(text, sizeof text, "%.2g %% of the cycles", 100.0 * part);
    return {part < 1e-3 ? Grade::watch : Grade::bad, text};
}

Verdict state_verdict(RunState state, RunReason reason) {
    std::string words;
    Grade grade = Grade::watch;
    switch (state) {
        case RunState::off:
            words = "the device is not open";
            break;
        case RunState::ready:
            words = "waits to be armed, no force";
            break;
        case RunState::armed:
            words = "waits for a hand, no force";
            break;
        case RunState::active:
            grade = Grade::good;
            words = "force is on";
            break;
        case RunState::fault:
            grade = Grade::bad;
            words = "no force until reset";
            break;
        default:
            return {Grade::unknown, "a state this program does not know"};
    }
    const std::string why = run_reason_text(reason);
    if (!why.empty()) words += ": " + why;
    return {grade, words};
}

namespace {

// What a person does before Reset; it reads on with "Then press Reset."
const char* mend_of(RunReason reason) {
    switch (reason) {
        case RunReason::emergency_stop:
            return "See that the arm is clear, then turn the button free.";
        case RunReason::stop_channels:
            return "Press the button once more and turn it free. Where it stays so, its wiring has to be "
                   "looked at.";
        case RunReason::dead_man:
            return "Hold the switch.";
        case RunReason::amplifier_readback:
            return "Look at the amplifier's switch, fuse and cable.";
        case RunReason::lines_lost:
            return "Plug the adapter of the safety lines in; tact probe tells what is seen.";
        case RunReason::device_lost:
        case RunReason::sample_stale:
            return "Look at the device's cable and power; tact probe tells what is seen.";
        case RunReason::device_fault:
            return "Look at the device's own lights; switch it off and on.";
        case RunReason::overruns:
        case RunReason::too_late:
        case RunReason::supervisor:
            return "Something takes the processor from the servo; tact doctor names it.";
        case RunReason::force_not_finite:
        case RunReason::model_failed:
            return "The scene's model broke down. Where it does so again, keep a recording: tact record.";
        case RunReason::gui_silent:
            return "The picture stood still for too long. Leave it less to draw.";
        default:
            return "See the events for what happened.";
    }
}

}  // namespace

StopNotice stop_notice(const HealthTopic& h) {
    const auto state = static_cast<RunState>(h.state);
    const auto lines = static_cast<LinesShown>(h.lines);
    const bool stopped = lines == LinesShown::stopped;
    if (!stopped && state != RunState::fault) return {};
    const auto reason = static_cast<RunReason>(stopped ? h.lines_reason : h.reason);
    StopNotice notice{Grade::bad, run_reason_text(reason), mend_of(reason)};
    if (notice.why.empty()) notice.why = "the force is stopped";
    notice.mend += state == RunState::fault ? " Then press Reset, and Arm." : " Then press Arm.";
    return notice;
}

Verdict memory_verdict(const HealthTopic& health) {
    if (health.allocations + health.locks + health.page_faults == 0)
        return {Grade::good, "no allocation, lock, fault"};
    std::string words;
    const auto add = [&words](const std::string& part) { words += (words.empty() ? "" : ", ") + part; };
    if (health.allocations > 0) add(count_words(health.allocations, "allocation", "allocations"));
    if (health.locks > 0) add(count_words(health.locks, "lock", "locks"));
    if (health.page_faults > 0) add(count_words(health.page_faults, "page fault", "page faults"));
    return {health.allocations + health.locks > 0 ? Grade::bad : Grade::watch, words};
}

Verdict distance_verdict(double distance_m, double closing_m_s, bool turns) {
    constexpr double kRedM = 1e-3, kAmberM = 2e-3, kAheadS = 1.0;
    if (!std::isfinite(distance_m)) return {Grade::unknown, "unknown"};
    if (distance_m < 0.0) return {Grade::bad, "in it"};
    if (distance_m < kRedM) return {Grade::bad, "too near"};
    if (turns && closing_m_s > 0.0) {
        const double ahead_s = (distance_m - kRedM) / closing_m_s;
        if (ahead_s < kAheadS) {
            char text[48];
            std::snprintf(text, sizeof text, "at 1 mm in %.1f s", ahead_s);
            return {Grade::watch, text};
        }
    }
    if (distance_m < kAmberM) return {Grade::watch, "near"};
    return {Grade::good, "clear"};
}

Verdict force_verdict(double force_n, double excess_s) {
    constexpr double kExcessN = 2.0;
    char text[48];
    std::snprintf(text, sizeof text, "above 2 N for %.1f s", excess_s);
    if (force_n > kExcessN) return {Grade::watch, text};
    return {Grade::good, excess_s >= 0.05 ? text : "never above 2 N"};
}

// The numbers are those of DeviceState in the device interface, which this process does not see.
const char* device_state_text(std::uint8_t device_state) noexcept {
    static constexpr const char* kTexts[] = {"closed", "ready", "powered", "its watchdog tripped", "fault"};
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

}  // namespace tact
