// Publishes the inputs and results of each cycle, so that a recording can be replayed by the same code.
//
// Thread    servo; TACT_RT except start_topic()
#pragma once

#include <span>

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Settings and devices at the start of the loop, without the start time.
[[nodiscard]] StartTopic start_topic(const ServoSettings& settings, std::span<const HandParts> hands,
                                     bool lines);
void publish_cycle(const CycleState& c, RtRegion& region) noexcept TACT_RT;

}  // namespace tact::servo
