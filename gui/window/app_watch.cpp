// What the window itself has to tell: an instructor's marks, the recording that it started, and the past that a person looks back to.
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "gui/dashboard/widgets.hpp"
#include "gui/window/app_parts.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/file/scene_switch.hpp"

namespace tact {
namespace {
constexpr std::uint16_t kOwnEvent = 0xFFFF;  // not an EventCode of the controller
constexpr std::size_t kLinesKept = 100;
}  // namespace

void GuiApp::tell(const StatusText& what) {
    state_.events.push_front({state_.now_ns, kOwnEvent, 1, what.text, what.grade});
    if (state_.events.size() > kLinesKept) state_.events.pop_back();
}

void GuiApp::report_mark() { tell({Grade::watch, "the instructor marks a place"}); }

void GuiApp::follow_recorder() {
    if (std::exchange(state_.record_wanted, false)) tell(recorder_.toggle());
    if (const auto ended = recorder_.poll()) tell(*ended);
    state_.own_recording = recorder_.running();
}

// The launcher shows the past; without it, or without a flight recorder, there is none to show.
void GuiApp::follow_past() {
    PastState& past = state_.past;
    past.shown = !options_.scene_switch.empty() && state_.flights > 0 && controller_.attached() &&
                 !controller_.watches();
    past.marks.clear();
    for (const EventLine& e : state_.events) {
        const double ago_s = 1e-9 * static_cast<double>(state_.now_ns - e.taken_at_ns);
        if (ago_s > PastState::kLengthS) break;
        past.marks.push_back({std::max(ago_s, 0.0), e.grade, e.text});
    }
    const double wanted_s = std::exchange(past.wanted_ago_s, -1.0);
    if (wanted_s < 0.0) return;
    try {
        ask_for_past(options_.scene_switch, wanted_s);
        tell({Grade::unknown, format("looking back %.1f s: a window opens", wanted_s)});
    } catch (const StartupError& e) {
        tell({Grade::bad, e.what()});
    }
}

Sight GuiApp::sight_under_pointer() const {
    const ImGuiIO& io = ImGui::GetIO();
    const PixelRect& v = layout_.view;
    // From -1 to 1 across the view, y up.
    const float x = 2.0F * (io.MousePos.x - v.x) / v.width - 1.0F,
                y = 1.0F - 2.0F * (io.MousePos.y - v.y) / v.height;
    const Eigen::Matrix4f p = camera_.projection(v.width / v.height);
    const Eigen::Vector3f of_eye((x + p(0, 2)) / p(0, 0), (y + p(1, 2)) / p(1, 1), -1.0F);
    const Eigen::Vector3f way = camera_.orientation().conjugate() * of_eye;
    const SceneToggles& t = state_.toggles;
    const float near_a = t.cut ? std::max(camera_.distance_a() - t.cut_at * view_->radius_a(), 0.0F) : 0.0F;
    return {content_->centre_model_m + kAngstromM * camera_.eye_a().cast<double>(), way.cast<double>(),
            kAngstromM * static_cast<double>(near_a), 2.0 / static_cast<double>(p(1, 1) * v.height)};
}

// A press and a release at one place within a moment; anything else turns the view.
void GuiApp::click_view() {
    constexpr float kClick_s = 0.3F, kClickPx = 4.0F;
    const ImGuiIO& io = ImGui::GetIO();
    if (!content_ || !view_ || stage_ || !ImGui::IsMouseReleased(ImGuiMouseButton_Left)) return;
    if (io.MouseDownDurationPrev[0] < kClick_s && io.MouseDragMaxDistanceSqr[0] < kClickPx * kClickPx)
        system().click(sight_under_pointer(), context());
}

void GuiApp::mark_under_pointer() {
    if (!content_ || !view_ || stage_) return;
    const Sight sight = sight_under_pointer();
    const auto place = system().place_along(sight.from_m, sight.way);
    state_.command_grade = Grade::watch;
    state_.command_text = !place                           ? "mark: no bone under the pointer"
                          : controller_.mark_place(*place) ? "mark: sent"
                                                           : "mark: not sent";
}

}  // namespace tact
