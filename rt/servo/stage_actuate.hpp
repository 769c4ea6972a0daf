// Stage 10: sends the wrenches to the devices.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

// Sets each hand's write_status.
void actuate(CycleState& c) noexcept TACT_RT;

}  // namespace tact::servo
