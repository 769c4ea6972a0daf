#include "gui/dashboard/widgets.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "gui/dashboard/letters.hpp"
#include "ipc/base/units.hpp"

namespace tact {

void begin_card(const Theme& theme, const char* title, const PixelRect& card, bool scrolls) {
    ImGui::SetNextWindowPos({card.x, card.y});
    ImGui::SetNextWindowSize({card.width, card.height});
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                             ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                             ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBackground |
                             ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;
    if (!scrolls) flags |= ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    ImGui::Begin(title, nullptr, flags);
    ImGui::GetWindowDrawList()->AddRect({card.x, card.y}, {card.x + card.width, card.y + card.height},
                                        colour::kPanelEdge);
    ImGui::PushFont(theme.bold);
    text_coloured(colour::kAccent, title);
    ImGui::PopFont();
}

void end_card() { ImGui::End(); }

void badge(const Theme& theme, const std::string& word, ImU32 fill, ImFont* font) {
    ImGui::PushFont(font != nullptr ? font : theme.bold);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 text = ImGui::CalcTextSize(noted(word));
    const float pad_x = theme.px(8.0F), pad_y = theme.px(2.0F);
    const ImVec2 size(text.x + 2.0F * pad_x, text.y + 2.0F * pad_y);
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, {at.x + size.x, at.y + size.y}, fill, 0.5F * size.y);
    draw->AddText({at.x + pad_x, at.y + pad_y}, IM_COL32(10, 13, 18, 255), word.c_str());
    ImGui::Dummy(size);
    ImGui::PopFont();
}

void text_coloured(ImU32 c, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, c);
    ImGui::TextUnformatted(noted(text));
    ImGui::PopStyleColor();
}

void text_small(const Theme& theme, ImU32 c, const std::string& text, bool wrap) {
    ImGui::PushFont(theme.small);
    ImGui::PushStyleColor(ImGuiCol_Text, c);
    if (wrap) ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(noted(text));
    if (wrap) ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

namespace {
void row_start(const Theme& theme, const char* what, const std::string& value, ImU32 value_colour) {
    text_coloured(colour::kDim, what);
    ImGui::SameLine(theme.px(100.0F));
    text_coloured(value_colour, value);
}
}  // namespace

void row(const Theme& theme, const char* what, const std::string& value, const StatusText& status) {
    row_start(theme, what, value, colour::kText);
    ImGui::SameLine(0.0F, theme.px(8.0F));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float r = theme.px(4.0F), h = ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddCircleFilled({at.x + r, at.y + 0.55F * h}, r, grade_colour(status.grade),
                                                12);
    ImGui::SetCursorScreenPos({at.x + 2.0F * r + theme.px(4.0F), at.y});
    ImGui::PushTextWrapPos(0.0F);
    text_coloured(grade_colour(status.grade), status.text);
    ImGui::PopTextWrapPos();
}

void row(const Theme& theme, const char* what, const std::string& value, const std::string& note) {
    row_start(theme, what, value, colour::kText);
    if (note.empty()) return;
    ImGui::SameLine(0.0F, theme.px(6.0F));
    const std::string shown = cut_text(ImGui::GetFont(), note, ImGui::GetContentRegionAvail().x);
    text_coloured(colour::kDim, shown);
    if (shown != note && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", noted(note));
}

void row(const Theme& theme, const char* what, const std::string& value, std::span<const std::string> notes) {
    row_start(theme, what, value, colour::kText);
    ImGui::SameLine(0.0F, theme.px(6.0F));
    const float room = ImGui::GetContentRegionAvail().x;
    for (std::size_t i = 0; i < notes.size(); ++i) {
        if (i + 1 < notes.size() && ImGui::CalcTextSize(notes[i].c_str()).x > room) continue;
        text_coloured(colour::kDim, notes[i]);
        return;
    }
}

bool same_line_if_fits(float gap, float wide) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const bool fits = ImGui::GetItemRectMax().x + gap + wide <= right;
    if (fits) ImGui::SameLine(0.0F, gap);
    return fits;
}

void choose(const Theme& theme, std::span<const char* const> words, int& chosen) {
    ImGui::PushStyleColor(ImGuiCol_HeaderHovered, colour::kPanelEdge);
    ImGui::PushStyleColor(ImGuiCol_HeaderActive, colour::kPanelEdge);
    const float left = ImGui::GetCursorPosX(), right = left + ImGui::GetContentRegionAvail().x;
    float x = left;
    for (std::size_t i = 0; i < words.size(); ++i) {
        // A word that would be cut begins a line.
        x += ImGui::CalcTextSize(words[i]).x + theme.px(10.0F);
        if (i > 0 && x - theme.px(10.0F) <= right) {
            ImGui::SameLine(0.0F, theme.px(10.0F));
        } else if (i > 0) {
            ImGui::SetCursorPosX(left);
            x = left + ImGui::CalcTextSize(words[i]).x + theme.px(10.0F);
        }
        const bool on = chosen == static_cast<int>(i);
        ImGui::PushStyleColor(ImGuiCol_Text, on ? colour::kAccent : colour::kDim);
        if (ImGui::Selectable(words[i], false, 0, ImGui::CalcTextSize(words[i])))
            chosen = static_cast<int>(i);
        ImGui::PopStyleColor();
    }
    ImGui::PopStyleColor(2);
}

std::string cut_text(ImFont* font, const std::string& text, float width_px) {
    const auto width = [font](const std::string& t) {
        return font->CalcTextSizeA(font->FontSize, 1e9F, 0.0F, t.c_str()).x;
    };
    letters_on_screen().note(text);
    if (width(text) <= width_px) return text;
    std::string cut = text;
    while (!cut.empty() && width(cut + "...") > width_px) {
        while (cut.size() > 1 && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0x80U) cut.pop_back();
        cut.pop_back();
    }
    return cut + "...";
}

std::string format(const char* pattern, ...) {
    char text[256];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

std::string fixed(double value, int digits) {
    std::string text = format("%.*f", digits, value);
    if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
    return text;
}

std::string grouped(std::uint64_t n) {
    std::string digits = std::to_string(n);
    for (std::size_t i = digits.size(); i > 3;) {
        i -= 3;
        digits.insert(i, "\u00A0");  // no-break space
    }
    return digits;
}

std::string duration_text(double seconds) {
    const double a = std::fabs(seconds);
    if (!std::isfinite(seconds)) return "unknown";
    if (a < 0.9995e-6) return format("%.0f ns", seconds * 1e9);
    if (a < 0.9995e-3) return format("%.3g µs", seconds * 1e6);
    if (a < 0.9995) return format("%.3g ms", seconds * 1e3);
    return format("%.3g s", seconds);
}

std::string length_text(double m) {
    struct Unit {
        double m;
        const char* name;
    };
    for (const Unit& u : {Unit{1.0, "m"}, Unit{1e-3, "mm"}, Unit{1e-6, "µm"}})
        if (m >= u.m) return format("%.3g %s", m / u.m, u.name);
    return format("%.3g Å", m / kAngstromM);
}

std::string rate_text(double hz) {
    if (!std::isfinite(hz)) return "unknown";
    return hz < 9999.5 ? format("%.0f Hz", hz) : format("%.1f kHz", hz * 1e-3);
}

}  // namespace tact
