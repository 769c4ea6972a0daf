// The dashboard between two frames that draw it: its cards are saved after drawing and copied from then on.
//
// Rate      drawn kPanelHz times a second, and in every frame for kAfterInput after the user's last input, so that nothing lags
//           behind the mouse. In between, ImGui neither begins nor ends a frame; its draw lists stay valid.
// Copied    the column and the strip beside the 3D view. Draw lists that reach into the view (overlay, tooltips, the scene list) are
//           drawn again in every frame, because the view below them changes.
// Thread    frame thread, context current.
#pragma once

#include <imgui.h>

#include <vector>

#include "gui/render/saved_area.hpp"
#include "gui/window/layout.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

class PanelImage {
public:
    static constexpr double kPanelHz = 12.0;
    static constexpr Duration kAfterInput = std::chrono::milliseconds(250);

    // Whether this frame draws the dashboard. changed: input, or another reason to show it at once.
    [[nodiscard]] bool due(Instant now, bool changed);
    // Copies the saved cards into the bound framebuffer. False: none of this size are saved.
    bool show(const Layout& layout, float to_px, int width_px, int height_px);
    // Draws what ImGui has just finished, over the cards' backgrounds, and saves the cards.
    void draw(ImDrawData& all, const Layout& layout, float to_px, int width_px, int height_px);
    // Draws the lists that reach into the view once more.
    void draw_over();
    void forget();

private:
    void draw_lists(std::vector<ImDrawList*>& lists);

    SavedArea column_, strip_;
    ImDrawData all_{};  // of the newest dashboard, without its lists
    std::vector<ImDrawList*> cards_, over_;
    Instant drawn_at_{}, input_at_{};
    bool any_ = false;
};

// True if something in the list is drawn inside the rectangle.
[[nodiscard]] bool reaches_into(const ImDrawList& list, const PixelRect& rect);

}  // namespace tact
