// A rectangle of the window in ImGui's pixels.
#pragma once

namespace tact {

struct PixelRect {
    float x = 0, y = 0, width = 1, height = 1;  // y points down
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};
}  // namespace tact
