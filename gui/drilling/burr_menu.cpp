#include "gui/drilling/burr_menu.hpp"

#include <cmath>
#include <numbers>

#include "gui/dashboard/widgets.hpp"
#include "gui/drilling/burr_tray.hpp"

namespace tact {
namespace {

constexpr double kRadSPerRpm = 2.0 * std::numbers::pi / 60.0;
constexpr double kM3SPerMlMin = 1e-6 / 60.0, kM3SPerLMin = 1e-3 / 60.0;
constexpr float kRpmMost = 100000.0F, kWaterMlMinMost = 100.0F, kSuctionLMinMost = 60.0F;

bool in_hand(const TrayBurr& b, const ToolDescription& t) {
    return static_cast<int>(b.shape) == t.shape && b.grit == t.grit &&
           std::abs(b.diameter_m - t.diameter_m) < 1e-5;
}

std::string size_text(const TrayBurr& b) {
    const double mm = 1e3 * b.diameter_m;
    const std::string size = fixed(mm, std::abs(mm - std::round(mm)) < 1e-6 ? 0 : 1);
    if (b.shape == DrillShape::sphere) return size;
    return (b.shape == DrillShape::cylinder ? "cylinder " : "cone ") + size + " × " +
           fixed(1e3 * b.length_m, 0);
}

void tray_row(const Theme& theme, const char* name, const DrillingState& d, DashboardState& state,
              DrillGrit grit, bool balls) {
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kDim, name);
    for (const TrayBurr& b : kBurrTray) {
        if (b.grit != grit || (b.shape == DrillShape::sphere) != balls) continue;
        const bool held = in_hand(b, d.burr);
        ImGui::SameLine(0.0F, theme.px(6.0F));
        if (ImGui::GetCursorPosX() < theme.px(110.0F)) ImGui::SetCursorPosX(theme.px(110.0F));
        ImGui::PushID(&b);
        if (held) ImGui::PushStyleColor(ImGuiCol_Button, colour::kAccent);
        if (held) ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(12, 16, 22, 255));
        if (ImGui::Button(size_text(b).c_str()) && !held) state.requests.push_back(burr_request(b));
        if (held) ImGui::PopStyleColor(2);
        ImGui::PopID();
    }
}

void drive(const Theme& theme, const char* name, const char* unit, double value, float most, double si,
           CommandKind kind, DashboardState& state) {
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kDim, name);
    ImGui::SameLine(theme.px(110.0F));
    ImGui::SetNextItemWidth(theme.px(230.0F));
    auto shown = static_cast<float>(value / si);
    ImGui::PushID(name);
    if (ImGui::SliderFloat("", &shown, 0.0F, most, unit, ImGuiSliderFlags_AlwaysClamp)) {
        // Two digits are enough for a person, and keep the orders few.
        const double step = most > 1000.0F ? 1000.0 : 1.0;
        const double rounded = step * std::round(static_cast<double>(shown) / step);
        if (std::abs(rounded - value / si) > 0.5 * step) state.requests.push_back({kind, rounded * si, {}});
    }
    ImGui::PopID();
}

}  // namespace

void burr_menu(const Theme& theme, const DrillingState& d, DashboardState& state) {
    if (!ImGui::BeginPopup(kBurrMenu)) return;
    if (!state.commands() || !d.known) ImGui::CloseCurrentPopup();
    text_small(theme, colour::kDim,
               d.changing_burr ? "changing the burr: no force meanwhile" : "Burr, diameter in mm", false);
    ImGui::BeginDisabled(d.changing_burr);
    tray_row(theme, "cutting", d, state, DrillGrit::cutting, true);
    tray_row(theme, "diamond", d, state, DrillGrit::diamond, true);
    tray_row(theme, "other heads", d, state, DrillGrit::cutting, false);
    ImGui::EndDisabled();
    ImGui::Separator();
    drive(theme, "burr speed", "%.0f rpm", d.burr_rad_s_most, kRpmMost, kRadSPerRpm,
          CommandKind::set_burr_speed, state);
    drive(theme, "water", "%.0f ml/min", d.irrigation_m3_s, kWaterMlMinMost, kM3SPerMlMin,
          CommandKind::set_irrigation, state);
    if (d.suction_tube.valid)
        drive(theme, "suction", "%.0f l/min", d.suction_m3_s, kSuctionLMinMost, kM3SPerLMin,
              CommandKind::set_suction, state);
    ImGui::EndPopup();
}

}  // namespace tact
