// What a first contact of a drill costs on this machine, tried before the loop starts.
//
// Trial    At each of kLevels a copy of the tool goes kDeeper times as deep into bone (trial_bone.hpp) as kPressN press it, which
//          a hand reaches while the force fades in, and is then let out until it presses with kLightN: first it cuts most
//          bone, then it touches most. In steps of the loop's period, without a deadline
// Work     of each level: that of the step which was expected to cost most. Between levels the logarithm of the cost is linear
// Speed    of this machine (drill_speed.hpp): from steps that follow a pause each, as in a loop that sleeps, which find less
//          of their data in the processor's caches
// Time     at most kMostS
// Thread   any but the servo: allocates
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/scene/bone/bone_bricks.hpp"
#include "rt/force/drilling/drill_speed.hpp"
#include "rt/force/drilling/trial_bone.hpp"

namespace tact {

struct DrillSettings;

class DrillRehearsal {
public:
    static constexpr std::array<float, 9> kLevels{0.0F, 0.05F, 0.1F, 0.15F, 0.2F, 0.3F, 0.5F, 0.75F, 1.0F};
    static constexpr double kPressN = 3.0, kLightN = 1.0, kDeeper = 2.5;
    static constexpr double kMostS = 3.0;

    std::array<DrillWork, kLevels.size()> contact{};
    double step_s = 0.0;  // for which it was tried; 0: it was not

    // Of contacts too. Before the loop starts.
    void set_speed(const DrillSpeed& speed);
    [[nodiscard]] const DrillSpeed& speed() const noexcept TACT_RT { return speed_; }
    // Of a contact that may come; 0: not tried.
    [[nodiscard]] Duration contact_cost(float level) const noexcept TACT_RT;

private:
    DrillSpeed speed_;
    std::array<double, kLevels.size()> log_ns_{};  // of the contacts' costs
};

// In bone like that of a volume, which nothing changes meanwhile. voxel_m: edge of a voxel in the world. step_s: period of
// the loop. Fails by StartupError where the model would.
[[nodiscard]] DrillRehearsal rehearse_drill(const DrillSettings& settings, const BoneBricks& bricks,
                                            std::span<const std::uint8_t> density, double voxel_m,
                                            double step_s);
// In solid bone.
[[nodiscard]] DrillRehearsal rehearse_drill(const DrillSettings& settings, double voxel_m, double step_s);
// The work of the costliest step of a contact at a level, tried for so long at most; adds steps that tell the speed.
[[nodiscard]] DrillWork first_contact(const DrillSettings& settings, TrialBone trial, double step_s,
                                      float level, double most_s, std::vector<TimedWork>& samples);

}  // namespace tact
