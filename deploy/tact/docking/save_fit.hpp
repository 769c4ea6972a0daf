// --save DIR: tact-prep export writes the placed structures at the end of the run.
//
// Fails by  StartupError: before the run if saving could not succeed (DIR is not empty, the scene is synthetic), after
//           it if tact-prep fails.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "deploy/tact/docking/places.hpp"
#include "deploy/tact/signals.hpp"
#include "deploy/tact/system_run.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/topics/bodies.hpp"
#include "ipc/topics/shapes.hpp"

namespace tact::launch {

// True if the scene's note names the source files of its structures.
bool structures_have_sources(const SceneFile& scene);
// Throws if the folder is not empty.
void check_save_folder(const std::filesystem::path& folder);

// The poses in the format of tact-prep export and --poses; omits invalid bodies. shapes: null if no body bends.
nlohmann::json poses_json(const BodiesTopic& bodies, const ShapesTopic* shapes,
                          const std::vector<Structure>& structures);
// Angstrom.
nlohmann::json amplitudes_json(std::span<const float> amplitude_m);

// Writes DIR/poses.json and runs tact-prep, which prints the files that it wrote. A signal during the save ends
// tact-prep, which is an error; earlier signals were meant for the run.
void save_fit(const SaveRequest& request, const nlohmann::json& poses, Signals& signals);

}  // namespace tact::launch
