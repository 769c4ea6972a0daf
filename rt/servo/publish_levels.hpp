// Publishes the governor's levels for the visual process and for monitoring.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Index of a visual path in the governor, from its index in ServoSettings::visual_paths.
[[nodiscard]] constexpr std::size_t visual_index(std::size_t path) {
    return path == 0 ? kDisplayPathIndex : kForcePathIndex + path;
}

void publish_levels(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
