// The governor's levels, for the visual process and for whoever watches.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// The place of a visual path among the governor's paths, by its place in ServoSettings::visual_paths.
[[nodiscard]] constexpr std::size_t visual_index(std::size_t path) {
    return path == 0 ? kDisplayPathIndex : kForcePathIndex + path;
}

void publish_levels(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
