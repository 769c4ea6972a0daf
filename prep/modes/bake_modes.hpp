// The MODE sections of a docking scene, one for each structure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// Returns lines for the scene's note. count: of modes per structure, to kModesMax; 0: writes nothing.
std::vector<std::string> bake_modes(const std::vector<Structure>& structures, std::uint32_t count,
                                    SceneWriter& out, const Progress& progress = {});

}  // namespace tact
