#include "gui/window/panel_image.hpp"

#include <backends/imgui_impl_opengl3.h>

#include <algorithm>

#include "gui/window/grounds.hpp"

namespace tact {
namespace {

// Pixels left of the 3D view, and its height.
struct Split {
    int left_px, view_height_px;
};
Split split_of(const Layout& layout, float to_px) {
    return {static_cast<int>(layout.view.x * to_px),
            std::max(static_cast<int>(layout.view.height * to_px), 1)};
}

}  // namespace

bool reaches_into(const ImDrawList& list, const PixelRect& rect) {
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.ElemCount == 0) continue;
        const float x0 = std::max(command.ClipRect.x, rect.x), y0 = std::max(command.ClipRect.y, rect.y);
        const float x1 = std::min(command.ClipRect.z, rect.x + rect.width),
                    y1 = std::min(command.ClipRect.w, rect.y + rect.height);
        if (x1 <= x0 || y1 <= y0) continue;
        for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
            ImVec2 low(1e9F, 1e9F), high(-1e9F, -1e9F);
            for (unsigned k = i; k < i + 3; ++k) {
                const auto index = static_cast<int>(command.IdxOffset + k);
                const ImVec2 p =
                    list.VtxBuffer[static_cast<int>(command.VtxOffset + list.IdxBuffer[index])].pos;
                low = {std::min(low.x, p.x), std::min(low.y, p.y)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y)};
            }
            if (low.x < x1 && high.x > x0 && low.y < y1 && high.y > y0) return true;
        }
    }
    return false;
}

bool PanelImage::due(Instant now, bool changed) {
    if (changed) input_at_ = now;
    const bool follows_input = input_at_ != Instant{} && now - input_at_ <= kAfterInput;
    if (any_ && !follows_input && to_s(now - drawn_at_) < 1.0 / kPanelHz) return false;
    drawn_at_ = now;
    return true;
}

void PanelImage::forget() {
    column_.forget();
    strip_.forget();
    any_ = false;
}

bool PanelImage::show(const Layout& layout, float to_px, int width_px, int height_px) {
    const Split s = split_of(layout, to_px);
    if (!any_ || (s.left_px > 0 && !column_.fits(s.left_px, height_px)) ||
        !strip_.fits(width_px - s.left_px, height_px - s.view_height_px))
        return false;
    if (s.left_px > 0) column_.restore(0, 0);
    strip_.restore(s.left_px, 0);
    return true;
}

void PanelImage::draw(ImDrawData& all, const Layout& layout, float to_px, int width_px, int height_px) {
    all_ = all;
    cards_.clear();
    over_.clear();
    for (int i = 0; i < all.CmdListsCount; ++i)
        (reaches_into(*all.CmdLists[i], layout.view) ? over_ : cards_).push_back(all.CmdLists[i]);
    paint_cards(layout, to_px, width_px, height_px);
    draw_lists(cards_);
    const Split s = split_of(layout, to_px);
    any_ = s.left_px > 0 && width_px > s.left_px && height_px > s.view_height_px;
    if (any_) {
        if (s.left_px > 0) column_.save(0, 0, s.left_px, height_px);
        strip_.save(s.left_px, 0, width_px - s.left_px, height_px - s.view_height_px);
    }
    draw_over();
}

void PanelImage::draw_over() { draw_lists(over_); }

void PanelImage::draw_lists(std::vector<ImDrawList*>& lists) {
    if (lists.empty()) return;
    ImDrawData some = all_;
#if IMGUI_VERSION_NUM >= 18980
    some.CmdLists.resize(0);
    for (ImDrawList* const list : lists) some.CmdLists.push_back(list);
#else
    some.CmdLists = lists.data();
#endif
    some.CmdListsCount = static_cast<int>(lists.size());
    some.TotalIdxCount = some.TotalVtxCount = 0;
    for (const ImDrawList* const list : lists) {
        some.TotalIdxCount += list->IdxBuffer.Size;
        some.TotalVtxCount += list->VtxBuffer.Size;
    }
    ImGui_ImplOpenGL3_RenderDrawData(&some);
#if IMGUI_VERSION_NUM < 18980
    some.CmdLists = nullptr;  // belongs to this object
#endif
}

}  // namespace tact
