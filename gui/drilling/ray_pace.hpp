// Limits the rays of a frame on a software renderer to what fits by the clock.
//
// The governor's level is a fraction of the pixels, whatever their number and the machine. This class compares frames
// with and without rays: the estimate follows a higher cost at once, a lower one slowly.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tact {

class RayPace {
public:
    // For the whole frame, within the governor's goal for the display.
    static constexpr double kFrame_s = 0.03;
    static constexpr std::uint32_t kFewest = 6000;

    [[nodiscard]] std::uint32_t rays_most() const noexcept {
        const double left_s = std::max(kFrame_s - without_s_, 0.2 * kFrame_s);
        return std::max(kFewest, static_cast<std::uint32_t>(std::min(left_s / ray_s_, 1e8)));
    }
    // For a finished frame, without waiting for the display.
    void took(std::uint32_t rays, double work_s) noexcept {
        if (!(work_s > 0.0 && work_s < 10.0)) return;
        if (rays < kFewest / 2) {
            without_s_ += 0.1 * (work_s - without_s_);
            return;
        }
        const double each = std::clamp((work_s - without_s_) / rays, 1e-9, 1e-4);
        ray_s_ = std::max(each > 4.0 * ray_s_ ? 4.0 * ray_s_ : each, ray_s_ + 0.1 * (each - ray_s_));
    }

private:
    double ray_s_ = 1e-6, without_s_ = 0.005;
};

}  // namespace tact
