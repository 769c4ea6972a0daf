// What showing bone that is drilled needs and takes longer than a frame to make: the copy of its densities, and the cells
// that particles move through.
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

    std::unique_ptr<BoneFollower> follower;  // null: the scene is not of bone
    std::unique_ptr<SiteEffects> site;       // reads the follower's copy: goes first
};

}  // namespace tact
