// A drilling scene: a burr in the first hand, a suction tube in the second, with the settings of the configuration.
//
// Thread  start-up. The models check the values.
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
// A tube: a ball at its tip and a shaft of the same diameter. It does not cut.
[[nodiscard]] DrillSettings suction_tube_settings(const RtConfig& config, std::uint64_t seed);
[[nodiscard]] DrillRates drill_rates(const RtConfig& config);
// The switch of the burr (hand 0) or of the suction (hand 1).
[[nodiscard]] DriveInput drill_switch(const RtConfig& config, std::uint32_t hand);

// Loads the tool of a hand. The shared scene must outlive it.
[[nodiscard]] std::unique_ptr<DrillModel> load_drill(const SceneFile& scene, const RtConfig& config,
                                                     std::uint64_t seed, DrillScene& shared,
                                                     std::uint32_t hand);

}  // namespace tact
