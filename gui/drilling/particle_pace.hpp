// Keeps how many particles fit into a picture where the processor draws it, on whatever machine this is.
//
// A few milliseconds of a drawing are for its pixels, however few particles there are: they are not counted to them.
// Too slow a drawing is believed at once, a quicker one slowly.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tact {

class ParticlePace {
public:
    static constexpr double kDraw_s = 0.016;  // of a picture, about: half of 30 pictures a second
    static constexpr double kPixels_s = 0.004;
    static constexpr std::uint32_t kLeast = 5000;  // fewer do not say any more where water and blood are

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
