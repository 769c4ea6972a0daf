// The texts of a finished ImGui frame, read back from its draw lists: what a person sees, for tests and for scripts that operate the window by its
// visible labels.
//
// How      a letter is a quad with a glyph's place in the font texture. Letters of one draw command that follow each other on a line are one text;
//          gaps wider than a space separate texts
// Thread   frame thread, after ImGui::Render().
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

namespace tact {

struct DrawnText {
    std::string text;   // UTF-8
    std::string owner;  // name of the draw list: a window, or "##Background"
    float x = 0.0F, y = 0.0F, w = 0.0F,
          h = 0.0F;  // visible part of its letters, from the upper left corner of the window
    bool cut = false,
         cut_below = false;  // a letter reaches out of its clip rectangle at a side; above or below
    std::size_t list = 0;    // number of the draw list
};

[[nodiscard]] std::vector<DrawnText> drawn_texts(const ImDrawData& data);
// Pairs that lie on each other within one draw list, other than a text and its shadow.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> overlapping(
    const std::vector<DrawnText>& texts);
[[nodiscard]] std::string texts_json(const std::vector<DrawnText>& texts);

}  // namespace tact
