// The bone of a run: a copy of the scene's in the region "tact.bone", which a window may watch, and the octree over it.
//
// Memory   all of it is filled, so every page is there before the servo thread needs it.
// Thread   made at the start (may throw StartupError); then the bone belongs to the servo thread. Outlives its models.
#pragma once

#include <optional>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/topics/bone_region.hpp"
#include "rt/force/drilling/drill_model.hpp"

namespace tact {

class SceneBone {
public:
    explicit SceneBone(const SceneFile& scene);  // with a section BONE
    [[nodiscard]] DrillBone& bone() { return *bone_; }
    [[nodiscard]] int fd() const { return region_->fd(); }

private:
    std::optional<OwnedBoneRegion> region_;
    std::optional<DrillBone> bone_;
};

}  // namespace tact
