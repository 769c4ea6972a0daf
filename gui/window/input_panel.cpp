#include "gui/window/input_panel.hpp"

#include <algorithm>

#include "gui/dashboard/widgets.hpp"
#include "gui/window/view_button.hpp"

namespace tact {
namespace {

constexpr float kInputLabelWide = 100.0F;

void explain_input(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

void input_slider(const Theme& theme, const char* what, double& value, double least, double most,
                  const char* pattern, const char* help) {
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kDim, what);
    ImGui::SameLine(theme.px(kInputLabelWide));
    ImGui::SetNextItemWidth(theme.px(kViewPanelWide - kInputLabelWide - 16.0F));
    auto shown = static_cast<float>(value);
    if (ImGui::SliderFloat((std::string("##") + what).c_str(), &shown, static_cast<float>(least),
                           static_cast<float>(most), pattern))
        value = std::clamp(static_cast<double>(shown), least, most);
    explain_input(help);
}

void input_rows(const Theme& theme, const InputState& input, std::size_t i, InputChoice& choice) {
    const InputState::Device& device = input.device[i];
    ImGui::PushID(static_cast<int>(i));
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kText, kInputNames[i]);
    ImGui::SameLine(theme.px(kInputLabelWide));
    choose(theme, kInputRoleNames, choice.role);
    explain_input(
        "camera: moves the view; hand: leads an emulated hand, as the mouse does; its deflection is a speed");
    if (!choice.is(InputRole::off)) {
        text_small(theme, device.present || !choice.is(InputRole::hand) ? colour::kDim : colour::kWatch,
                   device.text);
        if (choice.is(InputRole::hand) && !input.may_lead)
            text_small(theme, colour::kWatch, "No emulated hand to lead: --hand mouse makes one.");
        input_slider(theme, "Speed", choice.speed, InputChoice::kSpeedLeast, InputChoice::kSpeedMost,
                     "x %.2f", "of the tool or the view at full deflection");
        input_slider(theme, "Dead zone", choice.dead_zone, InputChoice::kDeadZoneLeast,
                     InputChoice::kDeadZoneMost, "%.2f", "part of the full deflection that moves nothing");
        input_slider(theme, "Curve", choice.curve, InputChoice::kCurveLeast, InputChoice::kCurveMost, "%.1f",
                     "1: speed in proportion to the deflection; more: finer near rest");
    }
    ImGui::PopID();
}

}  // namespace

void draw_input_panel(const Theme& theme, InputState& input, const PixelRect& view) {
    begin_view_panel(theme, "Devices", "SpaceMouse and gamepad", kInputButtonTop, view);
    for (std::size_t i = 0; i < kInputDevices; ++i) {
        if (i > 0) ImGui::Separator();
        input_rows(theme, input, i, input.choice[i]);
    }
    end_view_panel();
}

}  // namespace tact
