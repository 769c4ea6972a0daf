// Publishes the health of controller and devices, ten times a second and at every change of state.
//
// Thread    servo; TACT_RT
#pragma once

#include "rt/servo/cycle.hpp"

namespace tact::servo {

void publish_health(CycleState& c, const ServoSettings& settings,
                    Latest<HealthTopic>& topic) noexcept TACT_RT;
void publish_devices(CycleState& c, Latest<DevicesTopic>& topic) noexcept TACT_RT;
// Histogram since the start; once a second.
void publish_lateness(const CycleState& c, Latest<LatenessTopic>& topic) noexcept TACT_RT;

}  // namespace tact::servo
