// What showing bone that is drilled needs and takes longer than a frame to make: the copy of its densities, and the cells
// that particles move through.
//
// Thread   made on any, used on the frame thread
#pragma once

#include <memory>

#include "gui/drilling/bone_follower.hpp"
#include "gui/drilling/site_effects.hpp"
#include "gui/render/scene_content.hpp"

namespace tact {

struct DrillStart {
    std::unique_ptr<BoneFollower> follower;  // null: the scene is not of bone
    std::unique_ptr<SiteEffects> site;       // reads the follower's copy: goes first
};

[[nodiscard]] inline DrillStart make_drill_start(const SceneContent& content) {
    DrillStart start;
    if (!content.bone) return start;
    start.follower = std::make_unique<BoneFollower>(content.bone->volume, content.checksum);
    start.site = std::make_unique<SiteEffects>(start.follower->volume(), content.bone->labels,
                                               content.meta.world_per_model);
    return start;
}

}  // namespace tact
