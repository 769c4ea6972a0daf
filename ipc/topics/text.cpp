#include "ipc/topics/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <utility>

#include "ipc/base/device_notice.hpp"
#include "ipc/topics/bodies.hpp"

namespace tact {
namespace {

constexpr const char* kUnknown = "unknown";

// Converts a number of a record to an enumerator; a number out of range becomes a value that no enum has.
template <class E>
E code_of(double value) {
    return static_cast<E>(value >= 0.0 && value <= 254.0 ? static_cast<unsigned char>(value) : 255U);
}

std::string number(double value, int digits = 6) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

std::string late_text(double us) {
    return us < 1e3   ? number(us, 3) + " us"
           : us < 1e6 ? number(1e-3 * us, 3) + " ms"
                      : number(1e-6 * us, 3) + " s";
}

std::string path_text(double index, const LevelsTopic* levels) {
    if (index == static_cast<double>(kDisplayPathIndex)) return "display";
    if (index == static_cast<double>(kForcePathIndex)) return "force";
    if (levels != nullptr && index >= 0.0 && index < std::min<double>(levels->count, kPathsMax)) {
        const char* const path = levels->path[static_cast<std::size_t>(index)].path;
        const std::string name(path, std::find(path, path + kPathNameMax, '\0'));
        const std::size_t dot = name.find('.');  // "gui.molecules"
        return dot == std::string::npos ? name : name.substr(dot + 1);
    }
    return "path " + number(index);
}

}  // namespace

const char* run_state_text(RunState state) noexcept {
    switch (state) {
        case RunState::off:
            return "off";
        case RunState::ready:
            return "ready";
        case RunState::armed:
            return "armed";
        case RunState::active:
            return "active";
        case RunState::fault:
            return "fault";
    }
    return kUnknown;
}

const char* run_reason_text(RunReason reason) noexcept {
    switch (reason) {
        case RunReason::none:
            return "";
        case RunReason::by_command:
            return "by command";
        case RunReason::hand_present:
            return "hand on the device";
        case RunReason::hand_left:
            return "hand off the device";
        case RunReason::signal:
            return "stopped by a signal";
        case RunReason::force_not_finite:
            return "the force was not a finite number";
        case RunReason::sample_stale:
            return "the device position is outdated";
        case RunReason::device_lost:
            return "the device is lost";
        case RunReason::device_fault:
            return "the device reports a fault";
        case RunReason::overruns:
            return "several consecutive cycles overran";
        case RunReason::too_late:
            return "a cycle started far too late";
        case RunReason::gui_silent:
            return "the display process stopped responding";
        case RunReason::model_failed:
            return "the force model failed";
        case RunReason::emergency_stop:
            return "the emergency stop is pressed";
        case RunReason::stop_channels:
            return "the two contacts of the emergency stop disagree: press it again";
        case RunReason::dead_man:
            return "the dead-man switch is released";
        case RunReason::amplifier_readback:
            return "the amplifier's power does not follow its enable line";
        case RunReason::lines_lost:
            return "the safety inputs cannot be read";
        case RunReason::supervisor:
            return "the supervisor lowered the enable line: the servo stopped";
    }
    return kUnknown;
}

const char* run_reason_fix(RunReason reason) noexcept {
    switch (reason) {
        case RunReason::emergency_stop:
            return "Check that the arm is clear, then release the button.";
        case RunReason::stop_channels:
            return "Press the button once more and release it. If this persists, check its wiring.";
        case RunReason::dead_man:
            return "Hold the dead-man switch.";
        case RunReason::amplifier_readback:
            return "Check the amplifier's switch, fuse and cable.";
        case RunReason::lines_lost:
            return "Connect the adapter of the safety inputs; tact probe lists the adapters.";
        case RunReason::device_lost:
        case RunReason::sample_stale:
            return "Check the device's cable and power; tact probe lists the devices.";
        case RunReason::device_fault:
            return "Check the lights of the device; switch it off and on.";
        case RunReason::overruns:
        case RunReason::too_late:
        case RunReason::supervisor:
            return "Another program delays the servo; tact doctor names it.";
        case RunReason::force_not_finite:
        case RunReason::model_failed:
            return "The force model failed. If this happens again, record it: tact record.";
        case RunReason::gui_silent:
            return "The display froze. Reduce the rendering detail.";
        default:
            return "See the events for the cause.";
    }
}

const char* lines_text(LinesShown lines) noexcept {
    switch (lines) {
        case LinesShown::none:
            return "";
        case LinesShown::stopped:
            return "stop";
        case LinesShown::waiting:
            return "waiting for re-arming";
        case LinesShown::permitted:
            return "permit";
    }
    return kUnknown;
}

const char* event_code_text(EventCode code) noexcept {
    switch (code) {
        case EventCode::none:
            return "";
        case EventCode::loop_started:
            return "servo loop started";
        case EventCode::state_changed:
            return "state changed";
        case EventCode::fault_latched:
            return "fault";
        case EventCode::overrun:
            return "overrun";
        case EventCode::force_limited:
            return "force limited";
        case EventCode::torque_limited:
            return "torque limited";
        case EventCode::slew_limited:
            return "force slope limited";
        case EventCode::torque_slew_limited:
            return "torque slope limited";
        case EventCode::gui_attached:
            return "display process attached";
        case EventCode::gui_detached:
            return "display process detached";
        case EventCode::gui_silent:
            return "display process not responding";
        case EventCode::command_done:
            return "command handled";
        case EventCode::level_changed:
            return "level changed";
        case EventCode::input_refused:
            return "input refused";
        case EventCode::model_swapped:
            return "force model swapped";
        case EventCode::hand_present:
            return "hand on the device";
        case EventCode::hand_left:
            return "hand off the device";
        case EventCode::stopping:
            return "stopping";
        case EventCode::device_watchdog:
            return "the device's watchdog switched its amplifier off";
        case EventCode::body_selected:
            return "body held";
        case EventCode::bodies_changed:
            return "bodies changed";
        case EventCode::lines_changed:
            return "safety inputs";
        case EventCode::device_notice:
            return "device";
    }
    return kUnknown;
}

const char* level_reason_text(LevelReason reason) noexcept {
    switch (reason) {
        case LevelReason::start:
            return "start";
        case LevelReason::hold:
            return "held";
        case LevelReason::rate_low:
            return "force rate below goal";
        case LevelReason::rate_high:
            return "force rate above goal";
        case LevelReason::at_floor:
            return "at minimum";
        case LevelReason::at_top:
            return "full detail";
        case LevelReason::by_command:
            return "by command";
        case LevelReason::display_low:
            return "frame rate below goal";
        case LevelReason::display_high:
            return "frame rate above goal";
        case LevelReason::cost_high:
            return "limited by step cost";
        case LevelReason::cost_low:
            return "step cost fits";
        case LevelReason::deadline_missed:
            return "deadline missed";
    }
    return kUnknown;
}

const char* command_kind_text(CommandKind kind) noexcept {
    switch (kind) {
        case CommandKind::none:
            return "";
        case CommandKind::arm:
            return "arm";
        case CommandKind::disarm:
            return "disarm";
        case CommandKind::reset_fault:
            return "reset fault";
        case CommandKind::set_law:
            return "set law";
        case CommandKind::set_goal_hz:
            return "set goal";
        case CommandKind::set_level:
            return "set level";
        case CommandKind::set_fidelity_auto:
            return "set fidelity to automatic";
        case CommandKind::select_body:
            return "hold a body";
        case CommandKind::fix_body:
            return "fix or free a body";
        case CommandKind::place_body:
            return "place a body";
        case CommandKind::add_body:
            return "add a copy";
        case CommandKind::remove_body:
            return "remove a body";
        case CommandKind::set_clash:
            return "clash force";
        case CommandKind::set_subtraction:
            return "subtraction";
        case CommandKind::set_detail_filter:
            return "filter of the detail";
        case CommandKind::set_laplacian:
            return "Laplacian";
        case CommandKind::mark:
            return "mark";
        case CommandKind::add_found_place:
            return "add a place found";
        case CommandKind::clear_found_places:
            return "clear the places found";
        case CommandKind::set_pull:
            return "pull to places found";
        case CommandKind::set_flexible:
            return "bending";
        case CommandKind::set_together:
            return "copies together";
        case CommandKind::undo_stroke:
            return "undo a cut";
        case CommandKind::redo_stroke:
            return "redo a cut";
        case CommandKind::set_burr:
            return "change the burr";
        case CommandKind::set_burr_speed:
            return "burr speed";
        case CommandKind::set_irrigation:
            return "water";
        case CommandKind::set_suction:
            return "suction";
    }
    return kUnknown;
}

const char* command_result_text(CommandResult result) noexcept {
    switch (result) {
        case CommandResult::none:
            return "";
        case CommandResult::done:
            return "done";
        case CommandResult::refused_state:
            return "refused: not in this state";
        case CommandResult::refused_value:
            return "refused: value out of range or name unknown";
        case CommandResult::unknown:
            return "refused: unknown command";
    }
    return kUnknown;
}

const char* frame_part_text(FramePart part) noexcept {
    switch (part) {
        case FramePart::adapt:
            return "adapt";
        case FramePart::upload:
            return "upload";
        case FramePart::scene:
            return "scene";
        case FramePart::panels:
            return "panels";
        case FramePart::swap:
            return "swap";
        case FramePart::particles:
            return "particles";
        case FramePart::count:
            break;
    }
    return kUnknown;
}

const char* head_state_text(std::uint8_t state) noexcept {
    constexpr std::array kWords{"lost", "frozen", "fresh"};
    return state < kWords.size() ? kWords[state] : kUnknown;
}

const char* head_link_text(std::uint8_t link) noexcept {
    constexpr std::array kWords{"closed", "up", "down", "bus off", "gone"};
    return link < kWords.size() ? kWords[link] : kUnknown;
}

std::string event_text(const EventTopic& event, const LevelsTopic* levels) {
    const auto code = static_cast<EventCode>(event.code);
    const std::string what = event_code_text(code);
    const std::string a = number(event.a);
    const std::string b = number(event.b);
    switch (code) {
        case EventCode::state_changed:
            return what + ": " + run_state_text(code_of<RunState>(event.a)) + " to " +
                   run_state_text(code_of<RunState>(event.b));
        case EventCode::fault_latched:
            // The measured value, if the reason is a number that is too large.
            return what +
                   (event.detail == 1   ? " of the first hand: "
                    : event.detail == 2 ? " of the second hand: "
                                        : ": ") +
                   run_reason_text(code_of<RunReason>(event.a)) +
                   (event.b == 0.0 ? std::string() : " (" + b + ")");
        case EventCode::overrun:
            return what + ": " + late_text(event.a) + " late, " + b + " so far";
        case EventCode::force_limited:
            return what + ": " + number(event.a, 3) + " N requested, " + b + " N allowed";
        case EventCode::torque_limited:
            return what + ": " + number(event.a, 3) + " N m requested, " + b + " N m allowed";
        case EventCode::slew_limited:
            return what + ": " + number(event.a, 3) + " N per cycle requested, " + b + " N allowed";
        case EventCode::torque_slew_limited:
            return what + ": " + number(event.a, 3) + " N m per cycle requested, " + b + " N m allowed";
        case EventCode::gui_silent:
            return what + ": for " + late_text(1e3 * event.a);
        case EventCode::command_done:
            return std::string("command ") + command_kind_text(code_of<CommandKind>(event.a)) + ": " +
                   command_result_text(code_of<CommandResult>(event.b));
        case EventCode::level_changed:
            return what + ": " + path_text(event.a, levels) + " to " + number(event.b, 2) + ", " +
                   level_reason_text(code_of<LevelReason>(event.detail));
        case EventCode::input_refused:
            return what + ": " + a + " so far";
        case EventCode::stopping:
            if (event.a == SIGXCPU) return what + ": the servo did not sleep for 1 s; choose a lower rate";
            return event.a < 0.0 ? what + ": run time over" : what + ": signal " + a;
        case EventCode::device_watchdog:
            return what + ": " + late_text(1e3 * event.a) + " without a cycle";
        case EventCode::body_selected:
            if (event.a == static_cast<double>(kNoBody)) return "no body held";
            return what + ": body " + a + ", " + b + " points";
        case EventCode::bodies_changed:
            return what + ": " + a + " now";
        case EventCode::lines_changed: {
            const std::string why = run_reason_text(code_of<RunReason>(event.b));
            return what + ": " + lines_text(code_of<LinesShown>(event.a)) + (why.empty() ? "" : ": " + why);
        }
        case EventCode::device_notice: {
            const auto notice = code_of<DeviceNotice>(event.a);
            const std::string hand = event.b == 1.0 ? " of the second hand: " : ": ";
            return what + hand + (notice == DeviceNotice::none ? "no notice" : device_notice_text(notice));
        }
        default:
            return event.code == 0 || what != kUnknown ? what : what + " event " + std::to_string(event.code);
    }
}

std::string fault_fix(const EventTopic& event) {
    return std::string(run_reason_fix(code_of<RunReason>(event.a))) + " Then reset the fault, and arm.";
}

std::string bus_text(const BusCounts& counts) {
    const std::pair<const char*, std::uint32_t> kRows[] = {{"checksum", counts.checksum},
                                                           {"refused", counts.refused},
                                                           {"repeated", counts.repeated},
                                                           {"lost", counts.lost},
                                                           {"transfers failed", counts.transfers_failed},
                                                           {"stalls", counts.stalls},
                                                           {"connected again", counts.reconnects},
                                                           {"commands refused", counts.commands_refused},
                                                           {"bad seconds", counts.bad_seconds}};
    std::string text;
    for (const auto& [name, n] : kRows) {
        if (n > 0) text += (text.empty() ? "" : ", ") + std::string(name) + " " + std::to_string(n);
    }
    return text;
}

std::string schedule_text(std::uint32_t schedule_flags) {
    struct Row {
        ScheduleFlag flag;
        const char* text;
    };
    constexpr Row kRows[] = {{kScheduleFifo, "FIFO"},
                             {kSchedulePinned, "pinned"},
                             {kScheduleIsolated, "isolated core"},
                             {kScheduleLocked, "memory locked"},
                             {kScheduleDmaLatency, "no deep sleep states"}};
    std::string text = (schedule_flags & kScheduleFifo) != 0 ? "" : "ordinary scheduling";
    for (const Row& row : kRows) {
        if ((schedule_flags & row.flag) != 0) text += (text.empty() ? "" : ", ") + std::string(row.text);
    }
    return text;
}

}  // namespace tact
