// Calibration card: the steps with their status, the next action, points with their residuals, typed values.
#include <algorithm>
#include <array>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/widgets.hpp"
#include "gui/stereo/calibration_panel.hpp"

namespace tact {
namespace {

using Typed = CalibrationCardState::Typed;

struct Form {
    const Theme& theme;
    CalibrationCardState& state;

    void request(CalibrationAction action, std::size_t number = 0) const {
        state.requests.emplace_back(action, number);
    }
    void button(const char* name, float width, CalibrationAction action, bool possible = true) const {
        ImGui::BeginDisabled(!possible);
        if (ImGui::Button(name, {width, 0.0F})) request(action);
        ImGui::EndDisabled();
    }
    // A label and numbers in a row.
    template <std::size_t n>
    void numbers(const char* what, std::array<double, n>& values, Typed typed) const {
        ImGui::PushID(what);
        ImGui::AlignTextToFramePadding();
        text_coloured(colour::kDim, what);
        const float gap = theme.px(4.0F), left = theme.px(92.0F);
        ImGui::SameLine(left);
        const float width =
            (ImGui::GetContentRegionAvail().x - gap * static_cast<float>(n - 1)) / static_cast<float>(n);
        for (std::size_t i = 0; i < n; ++i) {
            if (i > 0) ImGui::SameLine(0.0F, gap);
            ImGui::PushID(static_cast<int>(i));
            ImGui::SetNextItemWidth(width);
            ImGui::InputDouble("##mm", &values[i], 0.0, 0.0, "%.1f");
            state.editing = state.editing || ImGui::IsItemActive();
            if (ImGui::IsItemDeactivatedAfterEdit()) state.edited = typed;
            ImGui::PopID();
        }
        ImGui::PopID();
    }
    void choice(const char* what, std::span<const char* const> words, int& chosen, Typed typed) const {
        ImGui::PushID(what);
        text_coloured(colour::kDim, what);
        ImGui::SameLine(theme.px(92.0F));
        const int before = chosen;
        choose(theme, words, chosen);
        if (chosen != before) state.edited = typed;
        ImGui::PopID();
    }
};

void dot(const Theme& theme, Grade grade) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float r = theme.px(4.0F), h = ImGui::GetTextLineHeight();
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    if (grade == Grade::unknown)
        draw->AddCircle({at.x + r, at.y + 0.55F * h}, r, colour::kDim, 12);
    else
        draw->AddCircleFilled({at.x + r, at.y + 0.55F * h}, r, grade_colour(grade), 12);
    ImGui::Dummy({2.0F * r, h});
    ImGui::SameLine(0.0F, theme.px(6.0F));
}

// Clipped at the card's edge; the full text stands below, or in the tooltip.
void one_line(const std::string& text, ImU32 ink) {
    const float room = ImGui::GetContentRegionAvail().x;
    std::string shown = text.substr(0, text.find(". "));
    bool cut = shown.size() < text.size();
    while (shown.size() > 3 && ImGui::CalcTextSize((shown + "...").c_str()).x > room) {
        shown.pop_back();
        cut = true;
        while (!shown.empty() && (static_cast<unsigned char>(shown.back()) & 0xC0U) == 0x80U)
            shown.pop_back();
    }
    text_coloured(ink, cut && shown.size() < text.find(". ") ? shown + "..." : shown);
    if (cut && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", noted(text));
}

void steps(const Form& form) {
    const CalibrationCardState& f = form.state;
    for (std::size_t i = 0; i < f.steps.size(); ++i) {
        const bool here = i == f.step;
        ImGui::PushID(static_cast<int>(i));
        dot(form.theme, f.steps[i].grade);
        const std::string name = format("%zu  %s", i + 1, f.steps[i].title.c_str());
        ImGui::PushStyleColor(ImGuiCol_Text, here ? colour::kAccent : colour::kText);
        if (here) ImGui::PushFont(form.theme.bold);
        if (ImGui::Selectable(name.c_str(), false, 0, ImGui::CalcTextSize(name.c_str())))
            form.request(CalibrationAction::go, i);
        if (here) ImGui::PopFont();
        ImGui::PopStyleColor();
        ImGui::SameLine(form.theme.px(112.0F));
        ImGui::PushFont(form.theme.small);
        one_line(f.steps[i].text,
                 f.steps[i].grade == Grade::unknown ? colour::kDim : grade_colour(f.steps[i].grade));
        ImGui::PopFont();
        ImGui::PopID();
    }
}

void points(const Form& form) {
    const CalibrationCardState& f = form.state;
    for (std::size_t i = 0; i < f.points.size(); ++i) {
        const CalibrationCardState::Point& p = f.points[i];
        ImGui::PushID(static_cast<int>(i) + 100);
        dot(form.theme, p.grade);
        const ImU32 ink = p.current ? colour::kWatch : p.taken ? colour::kText : colour::kDim;
        ImGui::PushStyleColor(ImGuiCol_Text, ink);
        if (ImGui::Selectable(format("%zu   %s", i + 1, p.text.c_str()).c_str()))
            form.request(CalibrationAction::redo, i);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip(p.taken ? "measure it again" : "measure this one next");
        ImGui::PopStyleColor();
        ImGui::PopID();
    }
    const float gap = form.theme.px(6.0F), width = (ImGui::GetContentRegionAvail().x - 2.0F * gap) / 3.0F;
    form.button(f.measuring ? "Stop" : "Measure  T", width, CalibrationAction::take, f.can_take);
    ImGui::SameLine(0.0F, gap);
    form.button("Skip  N", width, CalibrationAction::skip);
    ImGui::SameLine(0.0F, gap);
    form.button("Clear all", width, CalibrationAction::clear);
    ImGui::ProgressBar(f.progress, {-1.0F, form.theme.px(6.0F)}, "");
}

void screen_step(const Form& form) {
    CalibrationCardState& f = form.state;
    points(form);
    if (f.size_offered) form.button("Use the measured size", -1.0F, CalibrationAction::measured_size);
    ImGui::Separator();
    text_small(form.theme, colour::kDim, "Or type, mm: x right, y up, z to the viewer");
    static constexpr std::array<const char*, 3> kCorners{"Lower left", "Lower right", "Upper left"};
    for (std::size_t i = 0; i < 3; ++i) form.numbers(kCorners[i], f.corners_mm[i], Typed::corners);
}

void eyes_step(const Form& form) {
    CalibrationCardState& f = form.state;
    form.numbers("Distance, mm", f.apart_mm, Typed::eyes);
    form.numbers("From sensor", f.middle_mm, Typed::eyes);
    text_small(form.theme, colour::kDim,
               "Sensor to the midpoint of the eyes, mm: x to the right eye, y up, z back");
    if (ImGui::Checkbox("Swap eyes  X", &f.swapped)) f.edited = Typed::eyes;
    const std::size_t half = (f.modes.size() + 1) / 2;
    int upper = f.mode, lower = f.mode - static_cast<int>(half);
    const std::span<const char* const> modes(f.modes);
    form.choice("Shown as", modes.first(half), upper, Typed::mode);
    ImGui::NewLine();
    ImGui::SameLine(form.theme.px(92.0F));
    const int before = lower;
    choose(form.theme, modes.subspan(half), lower);
    if (lower != before) {
        f.mode = lower + static_cast<int>(half);
        f.edited = Typed::mode;
    } else {
        f.mode = upper;
    }
    static constexpr std::array<const char*, 2> kPlaces{"by the mouse", "at the hand"};
    form.choice("Scene", kPlaces, f.place, Typed::place);
}

void of_step(const Form& form) {
    CalibrationCardState& f = form.state;
    static constexpr std::array<const char*, 2> kTouched{"marks", "the wand"};
    switch (f.step) {
        case 0:
            form.numbers("Width, mm", f.width_mm, Typed::size);
            form.numbers("Height, mm", f.height_mm, Typed::size);
            break;
        case 1:
            form.numbers("Tip, mm", f.tip_mm, Typed::tip);
            form.button(f.measuring ? "Stop" : "Tilt about the tip  T", -1.0F, CalibrationAction::take);
            ImGui::ProgressBar(f.progress, {-1.0F, form.theme.px(6.0F)}, "");
            break;
        case 2:
            screen_step(form);
            break;
        case 3:
            form.choice("Touches", kTouched, f.touched_with, Typed::touched_with);
            points(form);
            break;
        case 4:
            eyes_step(form);
            break;
        default:
            break;
    }
}

void ending(const Form& form) {
    CalibrationCardState& f = form.state;
    ImGui::Separator();
    const float gap = form.theme.px(6.0F), width = (ImGui::GetContentRegionAvail().x - gap) / 2.0F;
    form.button("Back", width, CalibrationAction::back, f.step > 0);
    ImGui::SameLine(0.0F, gap);
    form.button("Next  Enter", width, CalibrationAction::next, f.step + 1 < f.steps.size());
    form.button("Save", width, CalibrationAction::save);
    ImGui::SameLine(0.0F, gap);
    form.button("Leave  Esc", width, CalibrationAction::leave);
    if (!f.saved.empty())
        text_small(form.theme, grade_colour(f.saved_grade), f.saved);
    else
        text_small(form.theme, colour::kDim, (f.changed ? "Not saved yet: " : "File: ") + f.file);
}

}  // namespace

void draw_calibration(const Theme& theme, CalibrationCardState& f, const PixelRect& card) {
    const Form form{theme, f};
    f.editing = false;
    begin_card(theme, "Calibration", card, true);
    steps(form);
    ImGui::Separator();
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(noted(f.instruction));
    ImGui::PopTextWrapPos();
    of_step(form);
    if (!f.status.text.empty() && f.step < 4)
        text_small(theme, f.status.grade == Grade::unknown ? colour::kDim : grade_colour(f.status.grade),
                   f.status.text);
    if (!f.live.empty()) text_small(theme, colour::kAccent, f.live);
    if (!f.message.empty()) text_small(theme, colour::kWatch, f.message);
    ending(form);
    end_card();
}

}  // namespace tact
