// Small pieces that the panels share.
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

// A filled pill with a word.
void badge(const Theme& theme, const std::string& word, ImU32 fill, ImFont* font = nullptr);
// One row: what on the left, the value right of it, words after it in the colour of the grade.
void row(const Theme& theme, const char* what, const std::string& value, const StatusText& status);
void row(const Theme& theme, const char* what, const std::string& value,
         const std::string& unit_or_note = "");
// With the first of the notes that fits, else the last.
void row(const Theme& theme, const char* what, const std::string& value, std::span<const std::string> notes);
void text_coloured(ImU32 c, const std::string& text);
void text_small(const Theme& theme, ImU32 c, const std::string& text, bool wrap = true);

// Words in a line, one of them chosen.
void choose(const Theme& theme, std::span<const char* const> words, int& chosen);

[[nodiscard]] std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));
// "%.2f", but a number that rounds to nothing has no sign.
[[nodiscard]] std::string fixed(double value, int digits);
// "1 234 567"
[[nodiscard]] std::string grouped(std::uint64_t n);
// In the unit that reads best: "820 ns", "12.3 us", "4.56 ms".
[[nodiscard]] std::string duration_text(double seconds);
// Maps are measured in angstrom, meshes may be as large as landscapes: "12 Å", "0.5 mm".
[[nodiscard]] std::string length_text(double m);
[[nodiscard]] std::string rate_text(double hz);  // "998 Hz", "1.25 kHz"

}  // namespace tact
