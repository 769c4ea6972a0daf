#include "gui/window/picture_panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gui/dashboard/widgets.hpp"
#include "gui/window/view_button.hpp"

namespace tact {
namespace {

constexpr float kSecond = 150.0F;

void explain(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

void cut_row(const Theme& theme, SceneToggles& t) {
    ImGui::Checkbox("Cut", &t.cut);
    explain("cuts off what is nearer than a plane; Shift+wheel moves it");
    ImGui::SameLine(theme.px(70.0F));
    ImGui::SetNextItemWidth(theme.px(240.0F));
    ImGui::BeginDisabled(!t.cut);
    float deeper = 0.0F - t.cut_at;  // never -0
    if (ImGui::SliderFloat("##cut", &deeper, -1.0F, 1.0F, "depth %.2f")) t.cut_at = -deeper;
    explain("0: through the centre of the view; 1: a radius of the scene behind it");
    ImGui::EndDisabled();
}

void size_row(const Theme& theme, PictureState& p, const PixelRect& view) {
    if (p.width_px <= 0 || p.height_px <= 0) {
        p.width_px = static_cast<int>(std::lround(2.0F * view.width));
        p.height_px = static_cast<int>(std::lround(2.0F * view.height));
    }
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kDim, "Size");
    ImGui::SameLine(theme.px(50.0F));
    ImGui::SetNextItemWidth(theme.px(64.0F));
    ImGui::InputInt("##width", &p.width_px, 0);
    ImGui::SameLine();
    text_coloured(colour::kDim, "x");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(theme.px(64.0F));
    ImGui::InputInt("##height", &p.height_px, 0);
    p.width_px = std::clamp(p.width_px, 0, PictureState::kSideMax);
    p.height_px = std::clamp(p.height_px, 0, PictureState::kSideMax);
    for (const int times : {1, 2, 4}) {
        ImGui::SameLine();
        ImGui::PushID(times);
        if (ImGui::Button(format("%dx", times).c_str())) {
            p.width_px = std::min(static_cast<int>(std::lround(static_cast<float>(times) * view.width)),
                                  PictureState::kSideMax);
            p.height_px = std::min(static_cast<int>(std::lround(static_cast<float>(times) * view.height)),
                                   PictureState::kSideMax);
        }
        explain("of the view, in pixels");
        ImGui::PopID();
    }
}

}  // namespace

void draw_picture_panel(const Theme& theme, PictureState& picture, SceneToggles& t, bool labels,
                        const PixelRect& view) {
    begin_view_panel(theme, "Picture", "Picture", kPictureButtonTop, view);
    ImGui::Checkbox("Depth cue", &t.depth_cue);
    explain("what is far fades into the background");
    ImGui::SameLine(theme.px(kSecond));
    ImGui::Checkbox("Smooth edges", &t.smooth_edges);
    ImGui::Checkbox("Shading", &t.shading);
    explain(
        "darker where little light reaches, and outlines; in software rendering only once the view rests");
    ImGui::SameLine(theme.px(kSecond));
    ImGui::Checkbox("White background", &t.white_ground);
    if (labels) {
        static constexpr std::array<const char*, 3> kLabels{"none", "chains", "residues"};
        text_coloured(colour::kDim, "Labels");
        ImGui::SameLine(theme.px(70.0F));
        choose(theme, kLabels, t.labels);
    }
    cut_row(theme, t);
    ImGui::Separator();
    size_row(theme, picture, view);
    ImGui::Checkbox("No background", &picture.transparent);
    explain("transparent where nothing is drawn");
    ImGui::SameLine(theme.px(kSecond));
    const bool valid =
        picture.width_px >= PictureState::kSideMin && picture.height_px >= PictureState::kSideMin;
    ImGui::BeginDisabled(!valid);
    if (ImGui::Button("Save picture")) picture.save_wanted = true;
    ImGui::EndDisabled();
    explain("the 3D view without panels and texts, in full detail; P saves the window as it is");
    if (!valid)
        text_small(theme, colour::kWatch,
                   format("from %d to %d pixels a side", PictureState::kSideMin, PictureState::kSideMax));
    else if (!picture.result.text.empty())
        text_small(theme, grade_colour(picture.result.grade), picture.result.text);
    end_view_panel();
}

}  // namespace tact
