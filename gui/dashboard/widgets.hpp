// Widgets shared by the panels.
#pragma once

#include <imgui.h>

#include <span>
#include <string>

#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

// A fixed, bordered area with a title; end with end_card().
void begin_card(const Theme& theme, const char* title, const PixelRect& card, bool scrolls = false);
void end_card();

// A filled pill with a text.
void badge(const Theme& theme, const std::string& word, ImU32 fill, ImFont* font = nullptr);
// One row: label on the left, the value, and a text in the colour of its grade.
void row(const Theme& theme, const char* what, const std::string& value, const StatusText& status);
// A note that does not fit is shortened, and whole under the mouse.
void row(const Theme& theme, const char* what, const std::string& value,
         const std::string& unit_or_note = "");
// With the first note that fits, else the last.
void row(const Theme& theme, const char* what, const std::string& value, std::span<const std::string> notes);
void text_coloured(ImU32 c, const std::string& text);
void text_small(const Theme& theme, ImU32 c, const std::string& text, bool wrap = true);

// Continues the line if an item of this width fits into the window right of the last one, else begins the next line.
bool same_line_if_fits(float gap, float wide);

// A line of options, one of them selected.
void choose(const Theme& theme, std::span<const char* const> words, int& chosen);

// The text, or as much of it as fits with "...".
[[nodiscard]] std::string cut_text(ImFont* font, const std::string& text, float width_px);
[[nodiscard]] std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));
// "%.2f", but a number that rounds to zero has no sign.
[[nodiscard]] std::string fixed(double value, int digits);
// "1 234 567"
[[nodiscard]] std::string grouped(std::uint64_t n);
// In the most readable unit: "820 ns", "12.3 us", "4.56 ms".
[[nodiscard]] std::string duration_text(double seconds);
// From the ångströms of a map to the metres of a landscape mesh: "12 Å", "0.5 mm".
[[nodiscard]] std::string length_text(double m);
[[nodiscard]] std::string rate_text(double hz);  // "998 Hz", "1.25 kHz"

}  // namespace tact
