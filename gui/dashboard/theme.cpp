#include "gui/dashboard/theme.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include "gui/dashboard/letters.hpp"

namespace tact {
namespace {

struct FontPair {
    const char* regular;
    const char* bold;
    float size;  // the same visible size for every family
};
constexpr FontPair kFonts[] = {
    {"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
     "/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Medium.ttf", 15.0F},
    {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
     "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf", 13.0F},
};
constexpr float kTextLinePerEm = 1.17F;  // of both families
constexpr Duration kLettersAfter = std::chrono::milliseconds(500);
// Of the atlas for letters of other fonts: with the text's own glyphs it stays below textures of 8192 x 8192.
constexpr float kLetterPixelsMost = 16e6F;

// Ranges of ImGui for single letters; valid until the atlas is built.
std::vector<ImWchar> letter_ranges(const std::vector<ImWchar>& letters, std::size_t most) {
    std::vector<ImWchar> ranges;
    for (std::size_t i = 0; i < std::min(letters.size(), most); ++i)
        ranges.insert(ranges.end(), {letters[i], letters[i]});
    ranges.push_back(0);
    return ranges;
}

// Sizes of the text font, each with the letters of other fonts. Must outlive the building of the atlas.
class FontMaker {
public:
    FontMaker(const Theme& theme, float text_px) : fonts_(theme.letter_fonts) {
        const float pixels = 5.4F * text_px * text_px;  // of one letter in the four sizes
        auto room = static_cast<std::size_t>(kLetterPixelsMost / pixels);
        text_.assign(std::begin(kTextGlyphs), std::end(kTextGlyphs) - 1);
        const auto& own = letters_on_screen().letters();
        const auto more = letter_ranges(own, room);
        text_.insert(text_.end(), more.begin(), more.end());
        for (const LetterFont& font : fonts_) {
            ranges_.push_back(letter_ranges(font.letters, room));
            room -= std::min(room, font.letters.size());
        }
    }
    [[nodiscard]] ImFont* make(const char* file, float px) const {
        ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
        ImFontConfig text;
        if (px > 60.0F) text.OversampleH = 1;
        ImFont* const font = atlas.AddFontFromFileTTF(file, px, &text, text_.data());
        if (font != nullptr) merge_letters(px);
        return font;
    }
    // Into the font that was added last.
    void merge_letters(float px) const {
        ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
        for (std::size_t i = 0; i < fonts_.size(); ++i) {
            ImFontConfig other;
            other.MergeMode = true;
            other.FontDataOwnedByAtlas = false;
            other.FontNo = fonts_[i].index;
            other.OversampleH = 1;
            other.PixelSnapH = true;
            FontData& data = *fonts_[i].data;
            const float same_em = std::round(px * fonts_[i].line_per_em / kTextLinePerEm);
            atlas.AddFontFromMemoryTTF(data.data(), static_cast<int>(data.size()), same_em, &other,
                                       ranges_[i].data());
        }
    }

private:
    const std::vector<LetterFont>& fonts_;
    std::vector<ImWchar> text_;
    std::vector<std::vector<ImWchar>> ranges_;
};

ImVec4 vec(ImU32 c) { return ImGui::ColorConvertU32ToFloat4(c); }

void style_for(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowPadding = {10.0F, 8.0F};
    style.FramePadding = {8.0F, 3.0F};
    style.ItemSpacing = {8.0F, 4.0F};
    style.ItemInnerSpacing = {5.0F, 4.0F};
    style.CellPadding = {3.0F, 2.0F};
    style.ScrollbarSize = 9.0F;
    style.WindowRounding = 0.0F;
    style.FrameRounding = 4.0F;
    style.GrabRounding = 4.0F;
    style.ScrollbarRounding = 4.0F;
    style.WindowBorderSize = 0.0F;
    style.AntiAliasedLinesUseTex = true;
    style.ScaleAllSizes(scale);
    const std::pair<ImGuiCol, ImVec4> colours[] = {
        {ImGuiCol_Text, vec(colour::kText)},
        {ImGuiCol_TextDisabled, vec(colour::kDim)},
        {ImGuiCol_Border, vec(colour::kPanelEdge)},
        {ImGuiCol_FrameBg, ImVec4(0.125F, 0.153F, 0.196F, 1.0F)},
        {ImGuiCol_FrameBgHovered, ImVec4(0.17F, 0.21F, 0.27F, 1.0F)},
        {ImGuiCol_FrameBgActive, ImVec4(0.20F, 0.25F, 0.32F, 1.0F)},
        {ImGuiCol_Button, ImVec4(0.145F, 0.19F, 0.25F, 1.0F)},
        {ImGuiCol_ButtonHovered, ImVec4(0.20F, 0.28F, 0.37F, 1.0F)},
        {ImGuiCol_ButtonActive, ImVec4(0.22F, 0.36F, 0.48F, 1.0F)},
        {ImGuiCol_CheckMark, vec(colour::kAccent)},
        {ImGuiCol_SliderGrab, vec(colour::kAccent)},
        {ImGuiCol_SliderGrabActive, vec(colour::kAccent)},
        {ImGuiCol_PopupBg, ImVec4(0.07F, 0.086F, 0.115F, 0.98F)},
        {ImGuiCol_ScrollbarBg, ImVec4(0.0F, 0.0F, 0.0F, 0.0F)},
        {ImGuiCol_ScrollbarGrab, ImVec4(0.23F, 0.28F, 0.35F, 1.0F)},
    };
    for (const auto& [which, value] : colours) style.Colors[which] = value;
    ImGui::GetStyle() = style;
}

void add_fonts(Theme& theme, float scale, const FontMaker& maker) {
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    theme.scale = scale;
    theme.font_file.clear();
    theme.text = theme.small = theme.bold = theme.large = nullptr;
    for (const FontPair& pair : kFonts) {
        std::error_code ignored;
        if (!std::filesystem::exists(pair.regular, ignored)) continue;
        const char* const bold = std::filesystem::exists(pair.bold, ignored) ? pair.bold : pair.regular;
        const float px = std::round(pair.size * scale);
        theme.text = maker.make(pair.regular, px);
        theme.small = maker.make(pair.regular, std::round(0.84F * px));
        theme.bold = maker.make(bold, px);
        theme.large = maker.make(bold, std::round(1.65F * px));
        theme.font_file = pair.regular;
        break;
    }
    if (theme.text == nullptr || theme.small == nullptr || theme.bold == nullptr || theme.large == nullptr) {
        io.Fonts->Clear();
        ImFontConfig config;
        config.SizePixels = std::round(13.0F * scale);
        theme.text = theme.small = theme.bold = theme.large = io.Fonts->AddFontDefault(&config);
        maker.merge_letters(config.SizePixels);
        theme.font_file.clear();
    }
}

}  // namespace

ImU32 grade_colour(Grade grade) noexcept {
    switch (grade) {
        case Grade::good:
            return colour::kGood;
        case Grade::watch:
            return colour::kWatch;
        case Grade::bad:
            return colour::kBad;
        case Grade::unknown:
            break;
    }
    return colour::kDim;
}

float theme_scale(int width_px, int height_px, float density, float requested) {
    const float fit =
        std::min(static_cast<float>(width_px) / 1280.0F, static_cast<float>(height_px) / 720.0F);
    // Slower than the window: a larger screen shows larger text and also more of it.
    const float by_size = std::pow(std::max(fit, 0.1F), 0.75F);
    const float by_density = std::isfinite(density) ? std::min(density, fit) : 1.0F;
    const float scale = std::clamp(std::round(4.0F * std::max(by_size, by_density)) / 4.0F, 0.75F, 3.0F);
    return std::clamp(scale * (std::isfinite(requested) ? requested : 1.0F), 0.5F, 6.0F);
}

void build_theme(Theme& theme, float scale) {
    const auto build = [&] {
        const FontMaker maker(theme, kFonts[0].size * scale);
        add_fonts(theme, scale, maker);
        return ImGui::GetIO().Fonts->Build();
    };
    if (!build() && !theme.letter_fonts.empty()) {
        theme.letter_fonts.clear();  // ImGui cannot read one of them
        build();
    }
    style_for(scale);
}

namespace {

void use_found_letters(Theme& theme, std::span<const ImWchar> asked_for) {
    try {
        theme.letter_fonts = theme.finding.get();
    } catch (const std::exception& e) {  // out of memory
        spdlog::warn("searching fonts for letters of names: {}", e.what());
    }
    build_theme(theme, theme.scale);
    std::vector<ImWchar> found;
    for (const LetterFont& font : theme.letter_fonts)
        found.insert(found.end(), font.letters.begin(), font.letters.end());
    std::sort(found.begin(), found.end());
    theme.missing.clear();
    for (const ImWchar letter : asked_for)
        if (!std::binary_search(found.begin(), found.end(), letter) &&
            theme.text->FindGlyphNoFallback(letter) == nullptr)
            theme.missing.push_back(letter);
    const std::string packages = letter_packages(theme.missing);
    if (!packages.empty() && packages != theme.missing_logged)
        spdlog::warn("{}", missing_letters_text(theme.missing));
    theme.missing_logged = packages;
}

}  // namespace

bool follow_letters(Theme& theme, Instant now) {
    if (theme.text == nullptr) return false;
    const std::vector<ImWchar>& letters = letters_on_screen().letters();
    if (theme.finding.valid()) {
        if (theme.finding.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
        use_found_letters(theme, std::span(letters).first(std::min(theme.letters, letters.size())));
        return true;
    }
    if (letters.size() == theme.letters) return false;
    if (theme.letters_at != Instant{} && now - theme.letters_at < kLettersAfter) return false;
    theme.letters_at = now;
    theme.letters = letters.size();
    try {
        theme.finding = std::async(std::launch::async, theme.find, letters, theme.letter_fonts);
    } catch (const std::system_error& e) {  // the letters stay substituted until there are new ones
        spdlog::warn("searching fonts for letters of names: no thread: {}", e.what());
    }
    return false;
}

}  // namespace tact
