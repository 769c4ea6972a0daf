// A picture of any size from a view that is drawn offscreen: averaged over four samples of each pixel where the driver and the time allow it, and
// transparent where nothing is drawn.
//
// Opacity  the view is drawn over black and over white; what differs is the background that shines through. So fog, glass and fine edges keep
//          their own transparency.
// Thread   frame thread, context current; the framebuffer that was bound is bound again.
// Fails    by StartupError: the driver rejects an image of this size.
#pragma once

#include <functional>

#include "gui/render/target.hpp"

namespace tact {

struct StillPicture {
    std::uint32_t width_px = 0, height_px = 0;
    bool transparent = false;
    std::vector<std::uint8_t> pixels;  // rows from the top; RGBA if transparent, else RGB
};

// Draws the view into the bound framebuffer of this size, over this background; null: the view's own.
using DrawPicture =
    std::function<void(int width_px, int height_px, bool many_samples, const Eigen::Vector3f* ground)>;

// samples_max: so many pixels may be drawn for four samples each; above, one sample.
[[nodiscard]] StillPicture draw_still_picture(int width_px, int height_px, bool transparent,
                                              double samples_max, const DrawPicture& draw);
// Of one pixel, from its colours over black and over white: colour and opacity.
[[nodiscard]] std::array<std::uint8_t, 4> matted(const std::array<int, 3>& over_black,
                                                 const std::array<int, 3>& over_white) noexcept;

}  // namespace tact
