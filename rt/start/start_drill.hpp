// The tools of a scene with bone, as the configuration has them: a burr in the first hand, a suction tube in the second.
//
// Thread  start-up. Values are checked where the models are made.
#pragma once

#include "rt/config/config.hpp"
#include "rt/force/drilling/drill_model.hpp"

namespace tact {

[[nodiscard]] DrillSettings burr_settings(const RtConfig& config, std::uint64_t seed);
// A tube: a ball at its tip and a shaft as thick. It cuts nothing.
[[nodiscard]] DrillSettings suction_tube_settings(const RtConfig& config, std::uint64_t seed);

// What is thinner than a voxel cannot be felt: shaft and tube become as thick as one. True: one did. A head that is too
// small stays as it is, and the model refuses it.
[[nodiscard]] bool fit_to_voxels(DrillSettings& settings, const SceneMeta& meta, const BoneBricks& bricks);

}  // namespace tact
