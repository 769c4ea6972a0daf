#include "gui/dashboard/letters.hpp"

#include <cstdint>
#include <cstring>

namespace tact {
namespace {

bool is_text_glyph(char32_t c) {
    for (const ImWchar* range = kTextGlyphs; range[0] != 0; range += 2)
        if (c >= range[0] && c <= range[1]) return true;
    return false;
}

struct Utf8Step {
    char32_t letter = 0;  // 0: invalid
    std::size_t bytes = 1;
};

// RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF.
Utf8Step utf8_step(std::string_view rest) {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(rest[i]); };
    const unsigned char first = at(0);
    if (first < 0x80U) return {first, 1};
    const std::size_t bytes = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
    if (first < 0xC2U || first > 0xF4U || rest.size() < bytes) return {};
    char32_t c = first & (0xFFU >> (bytes + 1));
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((at(i) & 0xC0U) != 0x80U) return {};
        c = (c << 6U) | (at(i) & 0x3FU);
    }
    constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    if (c < kLeast[bytes] || c > 0x10FFFF || (c >= 0xD800 && c <= 0xDFFF)) return {};
    return {c, bytes};
}

}  // namespace

void LetterSet::note(std::string_view utf8) {
    while (!utf8.empty()) {
        std::uint64_t eight = 0;
        if (utf8.size() >= sizeof eight) {
            std::memcpy(&eight, utf8.data(), sizeof eight);
            if ((eight & 0x8080808080808080ULL) == 0) {
                utf8.remove_prefix(sizeof eight);
                continue;
            }
        }
        const Utf8Step step = utf8_step(utf8);
        if (step.letter >= 0xA0) add(step.letter);
        utf8.remove_prefix(step.bytes);
    }
}

void LetterSet::add(char32_t letter) {
    if (letter > 0xFFFF || known_.test(letter) || is_text_glyph(letter)) return;
    if (letters_.size() >= kMost) {
        ++refused_;
        return;
    }
    known_.set(letter);
    letters_.push_back(static_cast<ImWchar>(letter));
}

void LetterSet::clear() {
    known_.reset();
    letters_.clear();
    refused_ = 0;
}

LetterSet& letters_on_screen() {
    static LetterSet letters;
    return letters;
}

}  // namespace tact
