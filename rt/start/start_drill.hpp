// A scene with bone: a burr in the first hand, a suction tube in the second, as the configuration has them.
//
// Thread  start-up. Values are checked where the models are made.
#pragma once

#include <memory>

#include "ipc/topics/regions.hpp"
#include "rt/config/config.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/drill_publisher.hpp"
#include "rt/servo/servo_settings.hpp"
#include "rt/start/scene_bone.hpp"
#include "rt/start/systems.hpp"

namespace tact {

// The bone, and the topics of its tools.
class DrillScene final : public SharedScene {
public:
    DrillScene(const SceneFile& scene, const RtConfig& config, RtRegion& region);
    [[nodiscard]] int fd() const override { return bone_.fd(); }
    [[nodiscard]] DrillBone& bone() { return bone_.bone(); }
    [[nodiscard]] DrillPublisher& publisher() { return publisher_; }

private:
    SceneBone bone_;
    DrillPublisher publisher_;
};

[[nodiscard]] DrillSettings burr_settings(const RtConfig& config, std::uint64_t seed);
// A tube: a ball at its tip and a shaft as thick. It cuts nothing.
[[nodiscard]] DrillSettings suction_tube_settings(const RtConfig& config, std::uint64_t seed);
[[nodiscard]] DrillRates drill_rates(const RtConfig& config);
// The switch of the burr (hand 0) or of the suction (hand 1).
[[nodiscard]] DriveInput drill_switch(const RtConfig& config, std::uint32_t hand);

// Nothing thinner than a voxel can be felt: shaft and tube become as thick as one. True: one did. A head that is too
// small stays as it is, and the model refuses it.
[[nodiscard]] bool fit_to_voxels(DrillSettings& settings, const SceneMeta& meta, const BoneBricks& bricks);

// The tool of a hand. The shared scene outlives it.
[[nodiscard]] std::unique_ptr<DrillModel> load_drill(const SceneFile& scene, const RtConfig& config,
                                                     std::uint64_t seed, DrillScene& shared,
                                                     std::uint32_t hand);

}  // namespace tact
