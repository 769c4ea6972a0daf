#include "gui/dashboard/theme.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

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
// Latin, Greek, dashes, dots, primes, minus and comparisons: the glyphs of units and numbers.
constexpr ImWchar kGlyphs[] = {0x0020, 0x00FF, 0x0370, 0x03FF, 0x2010, 0x2033,
                               0x2212, 0x2212, 0x2248, 0x2265, 0};

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
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    theme.scale = scale;
    theme.font_file.clear();
    theme.text = theme.small = theme.bold = theme.large = nullptr;
    for (const FontPair& pair : kFonts) {
        std::error_code ignored;
        if (!std::filesystem::exists(pair.regular, ignored)) continue;
        const bool bold = std::filesystem::exists(pair.bold, ignored);
        const float px = std::round(pair.size * scale);
        theme.text = io.Fonts->AddFontFromFileTTF(pair.regular, px, nullptr, kGlyphs);
        theme.small = io.Fonts->AddFontFromFileTTF(pair.regular, std::round(0.84F * px), nullptr, kGlyphs);
        theme.bold = io.Fonts->AddFontFromFileTTF(bold ? pair.bold : pair.regular, px, nullptr, kGlyphs);
        theme.large = io.Fonts->AddFontFromFileTTF(bold ? pair.bold : pair.regular, std::round(1.65F * px),
                                                   nullptr, kGlyphs);
        theme.font_file = pair.regular;
        break;
    }
    if (theme.text == nullptr || theme.small == nullptr || theme.bold == nullptr || theme.large == nullptr) {
        io.Fonts->Clear();
        ImFontConfig config;
        config.SizePixels = std::round(13.0F * scale);
        theme.text = theme.small = theme.bold = theme.large = io.Fonts->AddFontDefault(&config);
        theme.font_file.clear();
    }
    style_for(scale);
}

}  // namespace tact
