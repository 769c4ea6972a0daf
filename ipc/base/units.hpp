// Units that enter or leave at Tact's interfaces. Inside, everything is SI.
#pragma once

#include <numbers>

namespace tact {

inline constexpr double kAngstromM = 1e-10;
inline constexpr double kMillimetreM = 1e-3;
inline constexpr double kDegreeRad = std::numbers::pi / 180.0;

}  // namespace tact
