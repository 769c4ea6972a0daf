// State of the controller in two lines, for a window without room for cards, and the buttons needed first.
#include <algorithm>
#include <cctype>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"
#include "ipc/topics/text.hpp"

namespace tact {

void draw_run_buttons(DashboardState& state) {
    const auto run_state = static_cast<RunState>(state.health.state);
    const bool known = state.attached && state.have_health && !state.replay.shown;
    const float width = (ImGui::GetContentRegionAvail().x - 2.0F * ImGui::GetStyle().ItemSpacing.x) / 3.0F;
    const auto button = [&](const char* name, bool enabled, CommandKind kind, ImU32 c) {
        ImGui::BeginDisabled(!enabled);
        if (enabled) {
            ImGui::PushStyleColor(ImGuiCol_Button, (c & 0x00FFFFFFU) | (0x48U << 24U));
            ImGui::PushStyleColor(ImGuiCol_ButtonHovered, (c & 0x00FFFFFFU) | (0x80U << 24U));
        }
        if (ImGui::Button(name, {width, 0.0F})) state.requests.push_back({kind, 0.0, {}});
        if (enabled) ImGui::PopStyleColor(2);
        ImGui::EndDisabled();
    };
    button("Arm", known && !state.watching && run_state == RunState::ready, CommandKind::arm, colour::kGood);
    ImGui::SameLine();
    button("Disarm", known && (run_state == RunState::armed || run_state == RunState::active),
           CommandKind::disarm, colour::kWatch);
    ImGui::SameLine();
    button("Reset", known && !state.watching && run_state == RunState::fault, CommandKind::reset_fault,
           colour::kBad);
}

std::string run_badge_text(RunState state) {
    std::string word = run_state_text(state);
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return word;
}

void draw_health_strip(const Theme& theme, DashboardState& state, const PixelRect& card) {
    ImGui::SetNextWindowPos({card.x, card.y});
    ImGui::SetNextWindowSize({card.width, card.height});
    ImGui::Begin("Controller", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoScrollWithMouse);
    const HealthTopic& h = state.health;
    if (state.attached && state.have_health) {
        const auto run_state = static_cast<RunState>(h.state);
        const StatusText v = state_status(run_state, static_cast<RunReason>(h.reason));
        badge(theme, run_badge_text(run_state), grade_colour(v.grade));
        ImGui::SameLine();
        text_coloured(grade_colour(rate_status(h.force_rate_hz, h.goal_hz).grade),
                      rate_text(h.force_rate_hz));
        ImGui::SameLine();
        const std::string more =
            state.replay.shown ? "replay"
                               : "late p99 " + duration_text(1e-9 * static_cast<double>(h.lateness_p99_ns));
        text_coloured(colour::kDim, cut_text(theme.text, more, ImGui::GetContentRegionAvail().x));
    } else {
        text_coloured(colour::kWatch,
                      cut_text(theme.text, "No controller", ImGui::GetContentRegionAvail().x));
    }
    draw_run_buttons(state);
    ImGui::End();
}

}  // namespace tact
