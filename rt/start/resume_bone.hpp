// Continues with the bone that an earlier run kept in a file (--resume): its bricks, and its strokes, which can be undone.
//
// Thread   start-up; throws StartupError, and the bone is then of no use
#pragma once

#include <filesystem>

#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "rt/force/drilling/drill_bone.hpp"

namespace tact {

// bone: as baked.
DrilledBoneSummary resume_bone(const std::filesystem::path& file, const SceneFile& scene, DrillBone& bone);

}  // namespace tact
