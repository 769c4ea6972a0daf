// The tools of a scene with bone, as the configuration has them: a burr in the first hand, a sucker in the second.
//
// Thread  start-up. Values are checked where the models are made.
#pragma once

#include "rt/force/drilling/drill_model.hpp"
#include "rt/loop/config.hpp"

namespace tact {

[[nodiscard]] DrillSettings burr_settings(const RtConfig& config, std::uint64_t seed);
// A tube: a ball at its tip and a shaft as thick. It cuts nothing.
[[nodiscard]] DrillSettings sucker_settings(const RtConfig& config, std::uint64_t seed);

}  // namespace tact
