#include "gui/dashboard/letter_fonts.hpp"

#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace tact {
namespace {

constexpr std::uintmax_t kFontBytesMost = std::uintmax_t{64} << 20U;
constexpr std::size_t kFontsMost = 12;
constexpr std::uint32_t kTablesMost = 256;

template <auto Destroy>
struct FcDelete {
    template <class T>
    void operator()(T* object) const {
        Destroy(object);
    }
};
using FcConfigOwner = std::unique_ptr<FcConfig, FcDelete<FcConfigDestroy>>;
using FcPatternOwner = std::unique_ptr<FcPattern, FcDelete<FcPatternDestroy>>;
using FcCharSetOwner = std::unique_ptr<FcCharSet, FcDelete<FcCharSetDestroy>>;
using FcFontSetOwner = std::unique_ptr<FcFontSet, FcDelete<FcFontSetDestroy>>;

// Big-endian numbers of a font file; 0 outside of it.
class FontBytes {
public:
    explicit FontBytes(std::span<const unsigned char> file) : file_(file) {}
    [[nodiscard]] std::uint32_t u16(std::size_t at) const {
        return at + 2 <= file_.size() ? std::uint32_t{file_[at]} << 8U | file_[at + 1] : 0U;
    }
    [[nodiscard]] int i16(std::size_t at) const { return static_cast<std::int16_t>(u16(at)); }
    [[nodiscard]] std::uint32_t u32(std::size_t at) const { return u16(at) << 16U | u16(at + 2); }
    [[nodiscard]] std::size_t size() const { return file_.size(); }

private:
    std::span<const unsigned char> file_;
};

constexpr std::uint32_t font_tag(const char (&t)[5]) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(t[i]);
    return value;
}

std::shared_ptr<FontData> read_font(const std::string& file, const std::vector<LetterFont>& before) {
    for (const LetterFont& font : before)
        if (font.file == file) return font.data;
    std::error_code failed;
    const std::uintmax_t bytes = std::filesystem::file_size(file, failed);
    if (failed || bytes == 0 || bytes > kFontBytesMost) return nullptr;
    auto data = std::make_shared<FontData>(bytes);
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(data->data()), static_cast<std::streamsize>(bytes));
    return static_cast<std::uintmax_t>(in.gcount()) == bytes ? data : nullptr;
}

FcFontSetOwner fonts_by_charset(FcConfig* config, std::span<const ImWchar> letters) {
    const FcCharSetOwner wanted(FcCharSetCreate());
    const FcPatternOwner pattern(FcPatternCreate());
    if (!wanted || !pattern) return nullptr;
    for (const ImWchar letter : letters) FcCharSetAddChar(wanted.get(), letter);
    FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
    FcPatternAddCharSet(pattern.get(), FC_CHARSET, wanted.get());
    FcPatternAddBool(pattern.get(), FC_OUTLINE, FcTrue);
    FcConfigSubstitute(config, pattern.get(), FcMatchPattern);
    FcDefaultSubstitute(pattern.get());
    FcResult result = FcResultNoMatch;
    return FcFontSetOwner(FcFontSort(config, pattern.get(), FcTrue, nullptr, &result));
}

bool is_cjk(ImWchar c) {
    return (c >= 0x1100 && c <= 0x11FF) || (c >= 0x2E80 && c <= 0xA4CF) || (c >= 0xAC00 && c <= 0xD7FF) ||
           (c >= 0xF900 && c <= 0xFAFF) || (c >= 0xFF00 && c <= 0xFFEF);
}

}  // namespace

std::optional<float> font_line_per_em(std::span<const unsigned char> file, int index) {
    const FontBytes bytes(file);
    std::size_t begin = 0;
    if (bytes.u32(0) == font_tag("ttcf")) {
        if (index < 0 || static_cast<std::uint32_t>(index) >= bytes.u32(8)) return std::nullopt;
        begin = bytes.u32(12 + 4 * static_cast<std::size_t>(index));
    } else if (index != 0) {
        return std::nullopt;
    }
    const std::uint32_t kind = bytes.u32(begin);
    if (kind != 0x00010000U && kind != font_tag("OTTO") && kind != font_tag("true")) return std::nullopt;
    const std::uint32_t tables = bytes.u16(begin + 4);
    if (tables == 0 || tables > kTablesMost || begin + 12 + std::size_t{16} * tables > bytes.size())
        return std::nullopt;
    std::size_t head = 0, hhea = 0;
    bool hmtx = false, cmap = false, glyf = false, loca = false, cff = false;
    for (std::uint32_t i = 0; i < tables; ++i) {
        const std::size_t entry = begin + 12 + std::size_t{16} * i;
        const std::uint32_t tag = bytes.u32(entry);
        const std::size_t offset = bytes.u32(entry + 8), length = bytes.u32(entry + 12);
        if (offset + length > bytes.size()) return std::nullopt;
        if (tag == font_tag("head") && length >= 54) head = offset;
        if (tag == font_tag("hhea") && length >= 36) hhea = offset;
        hmtx = hmtx || tag == font_tag("hmtx");
        cmap = cmap || tag == font_tag("cmap");
        glyf = glyf || tag == font_tag("glyf");
        loca = loca || tag == font_tag("loca");
        cff = cff || tag == font_tag("CFF ");
    }
    const bool outlines = (glyf && loca) || cff;
    if (head == 0 || hhea == 0 || !hmtx || !cmap || !outlines) return std::nullopt;
    const std::uint32_t em = bytes.u16(head + 18);
    const int line = bytes.i16(hhea + 4) - bytes.i16(hhea + 6);
    if (em < 16 || line <= 0) return std::nullopt;
    return std::clamp(static_cast<float>(line) / static_cast<float>(em), 0.5F, 4.0F);
}

std::vector<LetterFont> find_letter_fonts(std::span<const ImWchar> letters,
                                          const std::vector<LetterFont>& before) {
    std::vector<LetterFont> found;
    if (letters.empty()) return found;
    const FcConfigOwner config(FcInitLoadConfigAndFonts());
    if (!config) return found;
    const FcFontSetOwner sorted = fonts_by_charset(config.get(), letters);
    if (!sorted) return found;
    std::vector<ImWchar> left(letters.begin(), letters.end());
    for (int i = 0; i < sorted->nfont && !left.empty() && found.size() < kFontsMost; ++i) {
        FcPattern* const pattern = sorted->fonts[i];
        FcChar8* name = nullptr;
        FcCharSet* has = nullptr;
        FcBool outline = FcFalse, colour = FcFalse;
        int index = 0;
        if (FcPatternGetString(pattern, FC_FILE, 0, &name) != FcResultMatch ||
            FcPatternGetCharSet(pattern, FC_CHARSET, 0, &has) != FcResultMatch)
            continue;
        FcPatternGetBool(pattern, FC_OUTLINE, 0, &outline);
        FcPatternGetBool(pattern, FC_COLOR, 0, &colour);
        FcPatternGetInteger(pattern, FC_INDEX, 0, &index);
        if (outline == FcFalse || colour != FcFalse) continue;
        LetterFont font{reinterpret_cast<const char*>(name), index & 0xFFFF, 1.0F, {}, nullptr};
        const auto rest = std::stable_partition(left.begin(), left.end(), [has](ImWchar letter) {
            return FcCharSetHasChar(has, letter) == FcFalse;
        });
        if (rest == left.end()) continue;
        font.data = read_font(font.file, before);
        const auto line = font.data ? font_line_per_em(*font.data, font.index) : std::nullopt;
        if (!line) continue;
        font.line_per_em = *line;
        font.letters.assign(rest, left.end());
        left.erase(rest, left.end());
        found.push_back(std::move(font));
    }
    return found;
}

std::string letter_packages(std::span<const ImWchar> missing) {
    const bool cjk = std::any_of(missing.begin(), missing.end(), is_cjk);
    const bool others = !std::all_of(missing.begin(), missing.end(), is_cjk);
    return std::string(cjk ? "fonts-noto-cjk (Chinese, Japanese, Korean)" : "") +
           (cjk && others ? " and " : "") + (others ? "fonts-noto-core (most other scripts)" : "");
}

std::string missing_letters_text(std::span<const ImWchar> missing) {
    if (missing.empty()) return {};
    char first[16];
    std::snprintf(first, sizeof first, "U+%04X", static_cast<unsigned>(missing.front()));
    std::string text = std::string("no font has the letter ") + first;
    if (missing.size() > 1) text += " and " + std::to_string(missing.size() - 1) + " more";
    return text + " of the names shown: install the package " + letter_packages(missing);
}

}  // namespace tact
