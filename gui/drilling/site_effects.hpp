// Particle effects where bone is drilled: dust from the burr, irrigation, bleeding, and suction.
//
// In        changes of the bone (BoneFollower), state of the tools (DrillTopic), the level of "gui.particles"
// Out       the current particles, their cost, and how long the burr was visible while it drilled
// Level     fraction of kMost particles, and of kBudgetMost_s for their steps in a frame. A lower level applies from
//           its first frame: excess particles are no longer shown (Particles::shown()) and are discarded in later
//           budgets
// Mass      ledger().drilled is the total loss of bone while this was shown
// Down      into the bone as it faces the surgeon, -z of the model: the patient lies on the side
// Thread    frame thread
#pragma once

#include <optional>
#include <span>

#include "gui/drilling/bleeding.hpp"
#include "gui/drilling/bone_follower.hpp"
#include "gui/drilling/particles.hpp"
#include "gui/drilling/wet_bone.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/topics/drill.hpp"

namespace tact {

struct SiteEffectsMetrics {
    std::uint32_t alive = 0, shown = 0, moves = 0, most = 0;  // of the last frame; most: at level 1
    double cost_s = 0.0;                                      // to move them, this frame
    double drilling_s = 0.0, seen_s = 0.0;                    // the burr turned in bone; and was visible
    bool suction_blocked = false;
};

class SiteEffects {
public:
    static constexpr std::uint32_t kMost = 100000;
    static constexpr double kBudgetMost_s = 8e-3;

    // bone: the copy being drilled (BoneFollower::volume()); it and the labels must outlive the site.
    SiteEffects(const BoneVolumeView& bone, const BoneLabelsView& labels, double world_per_model);

    struct Frame {
        double dt_s = 0.0;                  // since the last frame
        const DrillTopic* drill = nullptr;  // null: no controller
        std::span<const BrickChange> changes;
        float level = 1.0F;
        Vec3 eye_model_m = Vec3::Zero();
    };
    void step(const Frame& frame) noexcept;
    // Keeps this many particles: each step scatters the missing ones, of all kinds, over the bone, to measure the
    // cost of many. The level still limits them; 0 ends it.
    void keep(std::uint32_t count) noexcept { scattered_ = count; }

    [[nodiscard]] const Particles& particles() const noexcept { return particles_; }
    [[nodiscard]] const WetBone& wet() const noexcept { return wet_; }
    [[nodiscard]] const SiteEffectsMetrics& metrics() const noexcept { return metrics_; }

private:
    void take_changes(const Frame& frame, const DrillHand* burr) noexcept;
    void spray(double dt_s, const DrillTopic& drill, const DrillHand& burr) noexcept;
    void scatter() noexcept;
    void look(double dt_s, const DrillHand* burr, const Vec3& eye_model_m) noexcept;

    BoneBricks bricks_;
    double world_per_model_;
    Particles particles_;
    Bleeding bleeding_;
    WetBone wet_;
    SeededRandom random_{2};
    double water_owed_ = 0.0, looked_s_ = 0.0;
    bool seen_ = true;
    std::uint32_t kept_ = kMost, scattered_ = 0;
    SiteEffectsMetrics metrics_;
};

}  // namespace tact
