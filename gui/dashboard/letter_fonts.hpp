// Fonts of the system for letters that the window's text font lacks, found by fontconfig.
//
// Choice    FcFontSort by charset: the fonts that have most of the letters, in the order of the user's own configuration and language.
//           Outlines of TrueType or OpenType only: ImGui draws neither bitmap nor colour fonts.
// Files     at most 64 MiB each; their directory of tables and every table in it must lie inside of the file.
// Fails     never: a letter without a font is left out, and missing_letters_text() says which package has it.
// Thread    any; each call reads fontconfig's configuration anew (tens of milliseconds, seconds with a cold cache), so that an installed font is found.
#pragma once

#include <imgui.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tact {

using FontData = std::vector<unsigned char>;

struct LetterFont {
    std::string file;
    int index = 0;                 // of the font in a collection
    float line_per_em = 1.0F;      // ascent + descent
    std::vector<ImWchar> letters;  // that are taken from it
    std::shared_ptr<FontData> data;
};

// before: files that are reused instead of read again.
[[nodiscard]] std::vector<LetterFont> find_letter_fonts(std::span<const ImWchar> letters,
                                                        const std::vector<LetterFont>& before = {});

// Ascent + descent per em of a font that ImGui can read. Empty: it cannot, or the file is damaged.
[[nodiscard]] std::optional<float> font_line_per_em(std::span<const unsigned char> file, int index);

// Debian packages with these letters. Empty for no letters.
[[nodiscard]] std::string letter_packages(std::span<const ImWchar> missing);
// "no font has the letter U+4E2D and 12 more of the names shown: install the package fonts-noto-cjk ...". Empty for no letters.
[[nodiscard]] std::string missing_letters_text(std::span<const ImWchar> missing);

}  // namespace tact
