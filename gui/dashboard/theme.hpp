// Colours, fonts and sizes of the dashboard.
//
// Scale    1 at 1280x720; grows with the window, so that the same layout stays readable on a large screen.
// Fonts    the first existing font of a list from Debian, else ImGui's own (reported once). Letters that it lacks come from the
//          system's fonts (letter_fonts), once a name with them was drawn.
#pragma once

#include <imgui.h>

#include <cstddef>
#include <functional>
#include <future>
#include <string>
#include <vector>

#include "gui/dashboard/letter_fonts.hpp"
#include "gui/dashboard/status_text.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

namespace colour {
inline constexpr ImU32 kGround = IM_COL32(9, 11, 15, 255);
inline constexpr ImU32 kPanel = IM_COL32(18, 22, 29, 255);
inline constexpr ImU32 kPanelEdge = IM_COL32(38, 46, 58, 255);
inline constexpr ImU32 kGrid = IM_COL32(44, 52, 65, 255);
inline constexpr ImU32 kText = IM_COL32(219, 226, 236, 255);
inline constexpr ImU32 kDim = IM_COL32(146, 158, 175, 255);
inline constexpr ImU32 kAccent = IM_COL32(86, 180, 233, 255);
inline constexpr ImU32 kGood = IM_COL32(63, 195, 128, 255);
inline constexpr ImU32 kWatch = IM_COL32(240, 180, 60, 255);
inline constexpr ImU32 kBad = IM_COL32(255, 107, 94, 255);
inline constexpr ImU32 kForce = IM_COL32(255, 92, 92, 255);
inline constexpr ImU32 kNormal = IM_COL32(120, 220, 255, 255);  // of a contact point
inline constexpr ImU32 kMouse = IM_COL32(255, 214, 102, 255);   // a tool that the mouse may lead
inline constexpr ImU32 kSecondHand = IM_COL32(178, 132, 255, 255);
inline constexpr ImU32 kOrange = IM_COL32(230, 159, 0, 255);
inline constexpr ImU32 kGreen = IM_COL32(0, 190, 140, 255);
inline constexpr ImU32 kPink = IM_COL32(204, 121, 167, 255);
}  // namespace colour

[[nodiscard]] ImU32 grade_colour(Grade grade) noexcept;

struct Theme {
    float scale = 1.0F;
    ImFont* text = nullptr;
    ImFont* small = nullptr;
    ImFont* bold = nullptr;
    ImFont* large = nullptr;
    std::string font_file;  // empty: ImGui's own font

    std::vector<LetterFont> letter_fonts;
    std::vector<ImWchar> missing;  // letters that no font has
    std::string missing_logged;    // packages that the log named
    std::size_t letters = 0;       // of letters_on_screen() that were asked for
    Instant letters_at{};
    // A search under way, on a thread of its own: fontconfig may read all fonts of the system, which takes seconds.
    std::future<std::vector<LetterFont>> finding;
    std::function<std::vector<LetterFont>(std::vector<ImWchar>, std::vector<LetterFont>)> find =
        [](std::vector<ImWchar> wanted, std::vector<LetterFont> before) {
            return find_letter_fonts(wanted, before);
        };

    [[nodiscard]] float px(float at_scale_1) const { return at_scale_1 * scale; }
};

// For a window of this size in pixels; in steps of a quarter, so that fonts are rarely rebuilt.
// density     of the display, 1 at 96 dots per inch: text grows on a dense display as long as a 1280x720 layout of
//             that size fits
// requested   the user's own factor
[[nodiscard]] float theme_scale(int width_px, int height_px, float density = 1.0F, float requested = 1.0F);
// Clears and fills ImGui's font atlas and style. The caller uploads the atlas.
void build_theme(Theme& theme, float scale);
// Has fonts searched for letters drawn since the last search, at most twice a second and one search at a time, and rebuilds the theme
// with what a search has found; names once in the log a package with letters that no font has. Never waits for a search; only the
// destructor of the theme does. Between frames. True: the atlas is another one.
bool follow_letters(Theme& theme, Instant now);

}  // namespace tact
