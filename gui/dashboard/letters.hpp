// The letters that names from files, devices and people contain, noted where they are drawn, so that fonts with them are found.
//
// Noted     code points outside of kTextGlyphs, in the order of their first appearance. Invalid UTF-8, controls, surrogates and what
//           ImGui's character type cannot hold are skipped: ImGui shows its replacement character for them.
// Bounded   kMost letters, because a file may contain any; further ones are counted.
// Cost      one pass over the bytes of a text; ASCII, eight bytes at a time. No allocation.
// Thread    frame thread.
#pragma once

#include <imgui.h>

#include <bitset>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tact {

// First and last of each range, as for ImGui, ending with 0: Latin of Europe, accents, Greek, Cyrillic, dashes, dots, primes, minus,
// comparisons and the replacement character. These are in every font of the window.
inline constexpr ImWchar kTextGlyphs[] = {0x0020, 0x017F, 0x0300, 0x036F, 0x0370, 0x03FF,
                                          0x0400, 0x04FF, 0x2010, 0x2033, 0x2212, 0x2212,
                                          0x2248, 0x2265, 0xFFFD, 0xFFFD, 0};

class LetterSet {
public:
    static constexpr std::size_t kMost = 2000;

    LetterSet() { letters_.reserve(kMost); }
    void note(std::string_view utf8);
    [[nodiscard]] const std::vector<ImWchar>& letters() const { return letters_; }
    [[nodiscard]] std::size_t refused() const {
        return refused_;
    }  // letters beyond kMost, each time that they are noted
    void clear();

private:
    void add(char32_t letter);

    std::bitset<0x10000> known_;
    std::vector<ImWchar> letters_;
    std::size_t refused_ = 0;
};

// Of everything drawn so far.
[[nodiscard]] LetterSet& letters_on_screen();

// Notes the letters of a text that goes to ImGui directly.
[[nodiscard]] inline const char* noted(const std::string& text) {
    letters_on_screen().note(text);
    return text.c_str();
}

}  // namespace tact
