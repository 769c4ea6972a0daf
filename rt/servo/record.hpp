// What a recording needs of a run, so that the same code can repeat it: its inputs as they came, and its results.
//
// Thread    servo; TACT_RT but for start_topic()
#pragma once

#include <span>

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// How the loop begins, but for the instant.
[[nodiscard]] StartTopic start_topic(const ServoSettings& settings, std::span<const HandParts> hands,
                                     bool lines);
void publish_cycle(const CycleState& c, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
