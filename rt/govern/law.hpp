// The named laws by which the governor moves levels. Pure arithmetic, constant time.
//
// sensitus  the seed's law (SPEC 1.3), on V = level * items of the path, so equally on the level itself:
//               V <- V - s V (r_g - r_c) / r_g    if r_c < (1 - e) r_g
//               V <- V + s V (r_c - r_g) / r_g    if r_c > (1 + e) r_g
//           with goal r_g, measured rate r_c, gain s in (0, 1], tolerance e. The print has (1 - e) and (r_g -
//           r_c) in both lines; read so, the second would shrink V when there is time to spare.
// elastic   the same aim by a measured model of the picture's cost (rt/govern/governor.cpp has the
// derivation):
//           one step to where the goal should be, taken when the error is certain (rate_filter.hpp) and the
//           picture has applied the step before.
// fixed     the level that a person set, or the start level.
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
inline constexpr Law kDefaultLaw = Law::elastic;  // measured better, see README.md

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
