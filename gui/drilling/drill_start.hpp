// Data for drilling that takes longer than a frame to prepare: the copy of the densities, and the cells for
// particles.
//
// Thread   made on the loader thread, used on the frame thread
#pragma once

#include <memory>

#include "gui/drilling/bone_content.hpp"
#include "gui/drilling/bone_follower.hpp"
#include "gui/drilling/site_effects.hpp"
#include "gui/system/scene_system.hpp"

namespace tact {

class DrillStart : public SceneStart {
public:
    explicit DrillStart(const SceneContent& content);

    std::unique_ptr<BoneFollower> follower;  // null: not a bone scene
    std::unique_ptr<SiteEffects> site;       // reads the follower's copy: destroyed first
};

}  // namespace tact
