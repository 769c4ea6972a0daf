// Parses the parts requested on the command line of tact-emu: "--arm LEFT:premium-1.5", "--tracker
// vcan0:fd:240:4".
//
// Fails by StartupError with the expected form
// Thread   any; pure
#pragma once

#include <cstdint>
#include <string>

#include "hal/arm/arm_table.hpp"
#include "hal/tracker/can_reader.hpp"

namespace tact::emu {

struct ArmRequest {
    std::string serial;
    ArmParameterSet metrics;
};
[[nodiscard]] ArmRequest parse_arm(const std::string& text);  // SERIAL[:MODEL]

struct TrackerRequest {
    std::string interface;
    CanTrackerSettings can;
};
[[nodiscard]] TrackerRequest parse_tracker(
    const std::string& text);  // INTERFACE[:classic|fd[:RATE_HZ[:SENSORS]]]

}  // namespace tact::emu
