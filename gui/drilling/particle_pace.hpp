// Estimates how many particles fit into a frame of a software renderer, on any machine.
//
// Some milliseconds of a drawing are for its pixels, whatever the number of particles, and are excluded. The estimate
// follows a slower drawing quickly, a faster one slowly.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tact {

class ParticlePace {
public:
    static constexpr double kDraw_s = 0.016;  // of a frame: about half of one at 30 Hz
    static constexpr double kPixels_s = 0.004;
    static constexpr std::uint32_t kLeast = 5000;  // fewer no longer show where water and blood are

    void took(std::size_t particles, double draw_s) noexcept {
        if (particles < kWorth || !(draw_s >= 0.0)) return;
        const double each_s = std::max(draw_s - kPixels_s, 0.1 * draw_s) / static_cast<double>(particles);
        each_s_ += (each_s > each_s_ ? 0.5 : 0.05) * (std::min(each_s, 20e-6) - each_s_);
    }
    [[nodiscard]] std::uint32_t most() const noexcept {
        return std::max(kLeast, static_cast<std::uint32_t>((kDraw_s - kPixels_s) / std::max(each_s_, 1e-9)));
    }

private:
    static constexpr std::size_t kWorth = 500;
    double each_s_ = 1e-6;
};

}  // namespace tact
