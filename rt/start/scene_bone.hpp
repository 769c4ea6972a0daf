// The bone of a run: a copy of the scene's bone in the region "tact.bone", which a window may map, and the octree over it.
//
// Memory   filled at start-up, so every page is resident before the servo thread needs it.
// Thread   constructed at start-up (may throw StartupError); then owned by the servo thread. Outlives its models.
#pragma once

#include <optional>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/topics/bone_region.hpp"
#include "rt/force/drilling/drill_model.hpp"

namespace tact {

class SceneBone {
public:
    explicit SceneBone(const SceneFile& scene);  // scene: with a section BONE
    [[nodiscard]] DrillBone& bone() { return *bone_; }
    [[nodiscard]] int fd() const { return region_->fd(); }

private:
    std::optional<OwnedBoneRegion> region_;
    std::optional<DrillBone> bone_;
};

}  // namespace tact
