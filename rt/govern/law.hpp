// The governor's named laws. Pure arithmetic, constant time.
//
// sensitus  the published law (SPEC 1.3) for V = level * items of the path, applied to the level itself:
//               V <- V - s V (r_g - r_c) / r_g    if r_c < (1 - e) r_g
//               V <- V + s V (r_c - r_g) / r_g    if r_c > (1 + e) r_g
//           with goal r_g, measured rate r_c, gain s in (0, 1], tolerance e. The paper prints (1 - e) and
//           (r_g - r_c) in both lines; taken literally, the second line would lower V when there is time to spare.
// elastic   uses a measured model of the display's cost (derivation: rt/govern/governor.cpp). Takes one step to
//           the level that should meet the goal, once the error is significant (rate_filter.hpp) and a frame has
//           applied the previous step.
// fixed     keeps the level that a person set, or the start level.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "ipc/base/rt.hpp"

namespace tact {

enum class Law : std::uint8_t { sensitus, fixed, elastic };
inline constexpr std::array<std::string_view, 3> kLawNames{"sensitus", "fixed", "elastic"};
inline constexpr Law kDefaultLaw = Law::elastic;  // better in measurements, see README.md

[[nodiscard]] inline std::optional<Law> law_named(std::string_view name) noexcept {
    for (std::size_t i = 0; i < kLawNames.size(); ++i) {
        if (kLawNames[i] == name) return static_cast<Law>(i);
    }
    return std::nullopt;
}

enum class RateIs : std::uint8_t { right, low, high };

[[nodiscard]] constexpr RateIs judge_rate(double rate_hz, double goal_hz, double tolerance) noexcept {
    if (rate_hz < (1.0 - tolerance) * goal_hz) return RateIs::low;
    if (rate_hz > (1.0 + tolerance) * goal_hz) return RateIs::high;
    return RateIs::right;
}

// Factor on V; 1 inside the tolerance. Never negative: s <= 1 and r_c >= 0.
[[nodiscard]] constexpr double sensitus_factor(double rate_hz, double goal_hz, double gain,
                                               double tolerance) noexcept {
    if (judge_rate(rate_hz, goal_hz, tolerance) == RateIs::right) return 1.0;
    return 1.0 + gain * (rate_hz - goal_hz) / goal_hz;
}

}  // namespace tact
