// Drilling card: tools, bone removed, force, and the distance of the burr from each critical structure.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/widgets.hpp"
#include "gui/drilling/burr_menu.hpp"
#include "gui/drilling/drilling_panel.hpp"

namespace tact {
namespace {

constexpr double kFlashHz = 2.0;
constexpr float kNamesPx = 158.0F;  // width of the names of structures
constexpr std::int64_t kMinuteNs = 60'000'000'000;

std::string mm_text(double m) { return fixed(1e3 * m, 1) + " mm"; }

std::string mm3_text(double m3) { return fixed(1e9 * m3, 1e9 * m3 < 9.95 ? 1 : 0); }

void tools(const Theme& theme, const DrillingState& d) {
    static constexpr const char* kShapes[] = {"", " cylinder", " cone"};
    const char* const grit = d.burr.grit == DrillGrit::diamond ? " diamond" : " cutting";
    const std::string size = mm_text(d.burr.diameter_m) + grit + kShapes[std::clamp(d.burr.shape, 0, 2)];
    std::string does =
        d.burr.rpm > 0.0 ? grouped(static_cast<std::uint64_t>(std::llround(d.burr.rpm))) + " rpm" : "stopped";
    if (d.burr.water) does += ", wet";
    row(theme, "Burr", size, d.changing_burr ? std::string("changing") : does);
    if (d.suction_tube.valid)
        row(theme, "Suction tube", mm_text(d.suction_tube.diameter_m),
            d.suction_tube.suction ? "suction on" : "suction off");
}

void metrics(const Theme& theme, const DrillingState& d) {
    row(theme, "Bone removed", fixed(1e9 * d.removed_m3, 1) + " mm³",
        format("in %.0f s of drilling", d.drilling_s));
    std::string gone = mm3_text(d.dust.sucked_m3) + " sucked, " + mm3_text(d.dust.flown_m3) + " out";
    if (d.dust.buried_m3 > 0.0) gone += ", " + mm3_text(d.dust.buried_m3) + " undone";
    row(theme, "Dust", fixed(1e9 * d.dust.here_m3, 1) + " mm³", gone);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "mm³ of the removed bone: in dust and paste at the site, sucked away, flown or washed out of the "
            "site,\n"
            "and where bone came back. Together they are all that was removed while the window was open.");
    StatusText force = force_status(d.force_n, d.excess_s);
    if (d.held_in && force.grade == Grade::good) force.text = "reduced: bone on all sides";
    row(theme, "Force", fixed(d.force_n, 2) + " N", force);
    row(theme, "Strokes", grouped(d.strokes),
        d.strokes > 0 ? format("of %.1f mm at %.0f mm/s", 1e3 * d.stroke_m, 1e3 * d.stroke_m_s)
                      : std::string());
}

// Of the bone that was taken.
void undo(const Theme& theme, const DrillingState& d, DashboardState& state) {
    const auto button = [&](const char* name, std::uint32_t count, CommandKind kind, const char* help) {
        ImGui::BeginDisabled(count == 0 || d.exchanging || !state.commands());
        if (ImGui::Button(name)) state.requests.push_back({kind, 0.0, {}});
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", help);
    };
    button("Undo", d.undoable, CommandKind::undo_stroke,
           "bring back the bone of the last cut; meanwhile there is no force\n"
           "a cut: all bone taken without a pause of 0.3 s, for at most 10 s");
    ImGui::SameLine();
    button("Redo", d.redoable, CommandKind::redo_stroke, "take the bone of the last undone cut again");
    ImGui::SameLine();
    ImGui::BeginDisabled(!state.commands());
    if (ImGui::Button("Burr ...")) ImGui::OpenPopup(kBurrMenu);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip(
            "another burr, its speed, water and suction\n[ and ]: a smaller or larger one, G: the other "
            "grit");
    burr_menu(theme, d, state);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    if (d.exchanging || d.changing_burr)
        text_coloured(colour::kWatch, "no force");
    else
        text_small(theme, colour::kDim, d.undoable > 0 ? format("%u cuts", d.undoable) : "");
}

void structure(const Theme& theme, const DrillingState& d, const DrillingState::Structure& s) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float edge = theme.px(8.0F), h = ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, at.y + 0.5F * (h - edge)}, {at.x + edge, at.y + 0.5F * (h + edge)}, s.colour, theme.px(2.0F));
    ImGui::SetCursorScreenPos({at.x + edge + theme.px(5.0F), at.y});
    const StatusText v = distance_status(s.burr_m, s.closing_m_s, d.burr.rpm > 0.0);
    const bool calm = v.grade == Grade::good;
    const float names_px = theme.px(kNamesPx - 16.0F) - (ImGui::GetCursorScreenPos().x - at.x);
    text_coloured(calm ? colour::kDim : colour::kText, cut_text(ImGui::GetFont(), s.name, names_px));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", noted(s.name));
    ImGui::SameLine(theme.px(kNamesPx));
    text_coloured(calm ? colour::kText : grade_colour(v.grade), mm_text(s.burr_m));
    if (!s.side.empty()) {
        ImGui::SameLine(0.0F, theme.px(5.0F));
        text_small(theme, colour::kDim, s.side, false);
    }
    if (calm) return;
    ImGui::SameLine(0.0F, theme.px(5.0F));
    text_coloured(grade_colour(v.grade), v.text);
}

void tip(const DrillingState& d) {
    if (!ImGui::IsItemHovered()) return;
    std::string text =
        "Distance from the burr surface to each critical structure; negative inside it.\n"
        "Letters: where it lies from the burr in the patient, L R left and right, A P front and back, H F "
        "head and feet.";
    if (d.suction_tube.valid)
        for (const auto& s : d.structures)
            if (s.suction_tube_m < 2e-3)
                text += "\nsuction tube: " + mm_text(s.suction_tube_m) + " from the " + s.name;
    ImGui::SetTooltip("%s", noted(text));
}

}  // namespace

void DrillingPanels::draw_card(const Theme& theme, const PixelRect& card, DashboardState& state) const {
    const DrillingState& d = drilling;
    begin_card(theme, "Drilling", card, true);
    if (!d.known) {
        text_small(theme, colour::kDim, "no tool: waiting for the controller");
    } else {
        if (d.injuries > 0) {
            ImGui::SameLine();
            badge(theme, format("%llu injured", static_cast<unsigned long long>(d.injuries)), colour::kBad);
        }
        tools(theme, d);
        metrics(theme, d);
        undo(theme, d, state);
        if (d.structures.empty()) {
            text_small(theme, colour::kDim,
                       d.labelled ? "No labelled structure is critical (tact drill --critical)."
                                  : "No labels, so no warnings (tact drill --labels).");
        } else {
            text_small(theme, colour::kDim, "Distance from the burr to");
            tip(d);
            for (const DrillingState::Structure& s : d.structures) structure(theme, d, s);
        }
    }
    end_card();
}

void DrillingPanels::draw_in_scene_card(const Theme& theme, DashboardState& state) {
    row(theme, "Voxels", format("%u × %u × %u", voxels[0], voxels[1], voxels[2]),
        format("of %.3g mm", 1e3 * voxel_m));
    row(theme, "File", state.scene.file, "");
    ImGui::Checkbox("Frame times", &state.toggles.frame_times);
    ImGui::SameLine(theme.px(130.0F));
    ImGui::Checkbox("Force arrow", &state.toggles.force);
    ImGui::BeginDisabled(!sound.empty());
    ImGui::Checkbox("Sound", &state.toggles.sound);
    ImGui::EndDisabled();
    if (!sound.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("no sound: %s", sound.c_str());
    ImGui::SameLine(theme.px(130.0F));
    ImGui::Checkbox("Microscope", &state.toggles.microscope);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "as through an operating microscope: round field, light along the line of sight,\n"
            "and blur away from the depth where the burr cuts");
}

void DrillingPanels::draw_over_view(const OverlayPen& pen, const DashboardState& state,
                                    const PixelRect& v) const {
    draw_training(pen, training, v);
    if (drilling.nearness == Grade::good || !state.attached) return;
    const bool red = drilling.nearness == Grade::bad;
    // Slower than three times a second, for those whom flashing harms.
    const double phase =
        2.0 * std::numbers::pi * kFlashHz * 1e-9 * static_cast<double>(state.now_ns % kMinuteNs);
    const float bright = red ? 0.65F + 0.35F * static_cast<float>(std::cos(phase)) : 0.8F;
    const float width = pen.theme.px(red ? 8.0F : 4.0F);
    const ImU32 edge = (red ? colour::kBad : colour::kWatch) & ~IM_COL32_A_MASK;
    pen.draw->AddRect({v.x + 0.5F * width, v.y + 0.5F * width},
                      {v.x + v.width - 0.5F * width, v.y + v.height - 0.5F * width},
                      edge | (static_cast<ImU32>(255.0F * bright) << IM_COL32_A_SHIFT), 0.0F, 0, width);
}

std::string DrillingPanels::drawn_text(const DashboardState& state) const {
    std::string text;
    if (bone_shown < 1.0F) text = format("loading bone, %.0f %%   ", 100.0 * static_cast<double>(bone_shown));
    // Only changes are redrawn.
    text += state.load.vertices_drawn <= 1 ? std::string("sharp")
                                           : format("%s rays", grouped(state.load.vertices_drawn).c_str());
    return text + format("   %s particles", grouped(state.load.particles).c_str());
}

}  // namespace tact
