#include "rt/replay/recorded_marks.hpp"

#include <algorithm>
#include <array>

#include "ipc/topics/command.hpp"

namespace tact {

std::uint8_t mark_grade(const EventTopic& e) noexcept {
    switch (static_cast<EventCode>(e.code)) {
        case EventCode::fault_latched:
        case EventCode::device_watchdog:
            return 2;
        case EventCode::overrun:
        case EventCode::gui_silent:
        case EventCode::input_refused:
        case EventCode::device_notice:
            return 1;
        case EventCode::command_done:
            return e.a == static_cast<double>(CommandKind::mark) ? 1 : 0;
        default:
            return 0;
    }
}

ReplayMarks marks_of(const std::vector<EventTopic>& events, std::int64_t begin_ns) {
    std::vector<ReplayMark> found;
    std::array<double, 256> last_s{};
    last_s.fill(-1e300);
    for (const EventTopic& e : events) {
        const auto code = static_cast<EventCode>(e.code);
        // What a governor and limits do all the time marks nothing.
        if (code == EventCode::none || code == EventCode::level_changed || code == EventCode::force_limited ||
            code == EventCode::torque_limited || code == EventCode::slew_limited ||
            code == EventCode::torque_slew_limited)
            continue;
        ReplayMark mark{};
        mark.at_s = seconds_since(begin_ns, e.taken_at_ns);
        mark.code = e.code;
        mark.detail = e.detail;
        mark.grade = mark_grade(e);
        double& before_s = last_s[(2U * e.code + (mark.grade > 0 ? 1U : 0U)) % last_s.size()];
        if (mark.at_s - before_s < kTogetherS) continue;
        before_s = mark.at_s;
        found.push_back(mark);
    }
    ReplayMarks marks{};
    std::stable_sort(found.begin(), found.end(),
                     [](const ReplayMark& a, const ReplayMark& b) { return a.grade > b.grade; });
    if (found.size() > ReplayMarks::kMost) {
        marks.omitted = static_cast<std::uint32_t>(found.size() - ReplayMarks::kMost);
        found.resize(ReplayMarks::kMost);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const ReplayMark& a, const ReplayMark& b) { return a.at_s < b.at_s; });
    marks.count = static_cast<std::uint32_t>(found.size());
    std::copy(found.begin(), found.end(), marks.mark);
    return marks;
}

}  // namespace tact
