#include "gui/window/import_form_panel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gui/dashboard/letters.hpp"
#include "gui/dashboard/widgets.hpp"

namespace tact {
namespace {

constexpr float kLabels = 132.0F, kAnswer = 96.0F, kHistogram = 92.0F;
constexpr ImU32 kBelow = IM_COL32(92, 100, 112, 255);

void line(const Theme& theme, const std::string& label, const std::string& value) {
    text_coloured(colour::kDim, cut_text(ImGui::GetFont(), label, theme.px(kLabels - 8.0F)));
    ImGui::SameLine(theme.px(kLabels));
    ImGui::PushTextWrapPos(0.0F);
    text_coloured(colour::kText, value);
    ImGui::PopTextWrapPos();
}

// The values of the files; what is above the first answer is coloured. A drag moves that answer.
void histogram(const Theme& theme, ImportForm& form) {
    const auto number = std::find_if(form.numbers.begin(), form.numbers.end(),
                                     [](const ImportForm::Number& n) { return n.in_histogram; });
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, theme.px(kHistogram)};
    ImGui::InvisibleButton("histogram", size);
    const auto value_at = [&](float x) {
        const float share = std::clamp((x - at.x) / size.x, 0.0F, 1.0F);
        return form.low + static_cast<double>(share) * (form.high - form.low);
    };
    if (ImGui::IsItemActive() && number != form.numbers.end()) number->set(value_at(ImGui::GetMousePos().x));
    if (ImGui::IsItemHovered() && number != form.numbers.end())
        ImGui::SetTooltip("how often each value occurs, on a logarithmic scale; drag to move \"%s\"",
                          number->label.c_str());
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(10, 13, 18, 255));
    const std::optional<double> from = number != form.numbers.end() ? number->value() : std::nullopt;
    const auto x_of = [&](double value) {
        return at.x + size.x * static_cast<float>((value - form.low) / (form.high - form.low));
    };
    const float step = size.x / static_cast<float>(form.bins.size());
    for (std::size_t i = 0; i < form.bins.size(); ++i) {
        const float x = at.x + step * static_cast<float>(i);
        const bool above = from && x + 0.5F * step >= x_of(*from);
        draw->AddRectFilled({x, at.y + size.y - (size.y - theme.px(4.0F)) * form.bins[i]},
                            {x + std::max(step, 1.0F), at.y + size.y}, above ? colour::kAccent : kBelow);
    }
    for (const ImportForm::Number& n : form.numbers)
        if (const auto value = n.value();
            value && n.in_histogram && *value >= form.low && *value <= form.high)
            draw->AddLine({x_of(*value), at.y}, {x_of(*value), at.y + size.y}, colour::kText, theme.px(1.5F));
    text_small(theme, colour::kDim, format("%.4g", form.low));
    const std::string high = format("%.4g", form.high);
    ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionMax().x - theme.px(16.0F) -
                    theme.small->CalcTextSizeA(theme.small->FontSize, 1e9F, 0.0F, high.c_str()).x);
    text_small(theme, colour::kDim, high);
}

void number_field(const Theme& theme, ImportForm::Number& n, bool focus, bool& entered) {
    ImGui::PushID(n.option.c_str());
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kText, n.label);
    ImGui::SameLine(theme.px(kLabels + 24.0F));
    ImGui::SetNextItemWidth(theme.px(kAnswer));
    if (focus) ImGui::SetKeyboardFocusHere();
    entered |= ImGui::InputText("##answer", n.typed.data(), n.typed.size(),
                                ImGuiInputTextFlags_CharsScientific | ImGuiInputTextFlags_EnterReturnsTrue);
    if (!n.unit.empty()) {
        ImGui::SameLine();
        text_coloured(colour::kText, n.unit);
    }
    ImGui::SameLine(theme.px(kLabels + kAnswer + 64.0F));
    const bool valid = n.value().has_value() || n.typed[0] == 0;
    ImGui::PushTextWrapPos(0.0F);
    const bool recalled = valid && !n.recalled.empty() && n.recalled == n.typed.data();
    text_small(theme,
               recalled ? colour::kAccent
               : valid  ? colour::kDim
                        : colour::kWatch,
               recalled ? n.recalled_from + " " + n.help
               : valid  ? n.help
                        : format("A number from %g to %g %s.", n.low, n.high, n.unit.c_str()));
    ImGui::PopTextWrapPos();
    ImGui::PopID();
}

void choice_list(const Theme& theme, ImportForm::Choice& choice, bool& other) {
    ImGui::PushID(choice.option.c_str());
    ImGui::AlignTextToFramePadding();
    text_coloured(colour::kDim, choice.label);
    ImGui::SameLine(theme.px(kLabels));
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::BeginCombo("##choice", noted(choice.rows[choice.chosen].second))) {
        for (std::size_t i = 0; i < choice.rows.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(noted(choice.rows[i].second), i == choice.chosen) && i != choice.chosen) {
                choice.chosen = i;
                other = true;
            }
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    if (!choice.recalled_from.empty()) {
        ImGui::SetCursorPosX(theme.px(kLabels));
        text_small(theme, colour::kAccent, choice.recalled_from);
    }
    ImGui::PopID();
}

// Colour, name to edit, and whether it is critical.
void structures_table(const Theme& theme, ImportForm& form) {
    text_small(theme, colour::kDim,
               "Structures. A critical one has its distance from the burr shown, and warnings. Changed names "
               "are kept in " +
                   form.structure_table);
    for (std::size_t i = 0; i < form.structures.size(); ++i) {
        ImportForm::Structure& s = form.structures[i];
        ImGui::PushID(static_cast<int>(i));
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float edge = theme.px(12.0F), high = ImGui::GetFrameHeight();
        ImGui::GetWindowDrawList()->AddRectFilled(
            {at.x, at.y + 0.5F * (high - edge)}, {at.x + edge, at.y + 0.5F * (high + edge)},
            IM_COL32(s.row.rgb[0], s.row.rgb[1], s.row.rgb[2], 255), theme.px(2.0F));
        ImGui::SetCursorScreenPos({at.x + edge + theme.px(8.0F), at.y});
        ImGui::SetNextItemWidth(theme.px(270.0F));
        letters_on_screen().note(s.name.data());
        ImGui::InputText("##name", s.name.data(), s.name.size());
        ImGui::SameLine();
        ImGui::Checkbox("critical", &s.critical);
        ImGui::SameLine(theme.px(430.0F));
        text_small(theme, colour::kDim, grouped(s.row.voxels) + " voxels", false);
        ImGui::PopID();
    }
}

}  // namespace

void draw_import_form(const Theme& theme, ImportForm& form) {
    ImGui::Spacing();
    text_coloured(colour::kText, form.title);
    ImGui::Spacing();
    ImGui::BeginChild("form", {0.0F, -ImGui::GetFrameHeightWithSpacing() - theme.px(4.0F)}, false,
                      ImGuiWindowFlags_NoBackground);
    for (const ImportForm::Line& l : form.lines) line(theme, l.label, l.value);
    for (ImportForm::Choice& c : form.choices) choice_list(theme, c, form.other_choice);
    for (const std::string& w : form.warnings) {
        ImGui::PushTextWrapPos(0.0F);
        text_coloured(colour::kWatch, w);
        ImGui::PopTextWrapPos();
    }
    ImGui::Spacing();
    if (!form.bins.empty()) histogram(theme, form);
    const bool first_frame = !std::exchange(form.shown, true);
    bool entered = false, focus = first_frame;
    for (ImportForm::Number& n : form.numbers) {
        const bool first = focus && n.proposed.empty();
        number_field(theme, n, first, entered);
        focus = focus && !first;
    }
    const bool asks = std::any_of(form.numbers.begin(), form.numbers.end(),
                                  [](const ImportForm::Number& n) { return n.proposed.empty(); });
    form.takes_keys = form.takes_keys || (!first_frame && (!asks || ImGui::IsAnyItemActive()));
    if (!form.structures.empty()) structures_table(theme, form);
    ImGui::EndChild();
    const bool complete = form.complete();
    ImGui::BeginDisabled(!complete);
    if (ImGui::Button("Import") || (entered && complete)) form.answered = true;
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) form.cancelled = true;
}

}  // namespace tact
