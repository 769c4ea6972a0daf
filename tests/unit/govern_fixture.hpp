// Knobs and governors for tests.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

#include "rt/govern/governor.hpp"

namespace tact::govern_test {

inline constexpr KnobSpec kMesh{.path = "gui.mesh", .floor = 0.05F, .start = 1.0F};
inline constexpr KnobSpec kForce{
    .path = "docking.force", .floor = 0.2F, .start = 1.0F, .slew_per_s = 2.0F, .haptic = true};
inline constexpr Duration kStep = std::chrono::milliseconds(100);

inline Governor with(const GovernorSettings& settings, std::initializer_list<KnobSpec> knobs) {
    Governor governor(settings);
    for (const KnobSpec& k : knobs) EXPECT_LT(governor.add(k), Governor::kPathsMax);
    return governor;
}

}  // namespace tact::govern_test
