// Colour map viridis (Smith, van der Walt 2015), as M. Zucker's polynomial, accurate to a few thousandths.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tact {

// From 0 (dark violet) to 1 (yellow); clamped outside.
[[nodiscard]] inline std::array<std::uint8_t, 3> viridis(float part) noexcept {
    static constexpr std::array<std::array<float, 3>, 7> kC{{{0.277727F, 0.005407F, 0.334100F},
                                                             {0.105093F, 1.404614F, 1.384590F},
                                                             {-0.330862F, 0.214848F, 0.095095F},
                                                             {-4.634230F, -5.799101F, -19.332441F},
                                                             {6.228270F, 14.179933F, 56.690553F},
                                                             {4.776385F, -13.745145F, -65.353033F},
                                                             {-5.435456F, 4.645853F, 26.312435F}}};
    const float x = part >= 0.0F ? std::min(part, 1.0F) : 0.0F;  // NaN: 0
    std::array<std::uint8_t, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
        float value = 0.0F;
        for (std::size_t k = kC.size(); k-- > 0;) value = value * x + kC[k][i];
        rgb[i] = static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
    }
    return rgb;
}

// The same without the darkest part, which lighting cannot show.
[[nodiscard]] inline std::array<std::uint8_t, 3> light_viridis(float part) noexcept {
    constexpr float kFrom = 0.18F;
    return viridis(kFrom + (1.0F - kFrom) * (part >= 0.0F ? std::min(part, 1.0F) : 0.0F));
}

}  // namespace tact
