// --save DIR: what the hand placed, written by tact-prep export when the run is over.
//
// Fails by  StartupError: before the run where it could not be saved anyway (DIR holds something, the scene
//           was made in code), after it where tact-prep fails.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "deploy/tact/docking/places.hpp"
#include "deploy/tact/signals.hpp"
#include "deploy/tact/system_run.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/topics/bodies.hpp"

namespace tact::launch {

// Does the scene's note name the files that its structures came from?
bool structures_have_sources(const SceneFile& scene);
// Throws where the folder holds something already.
void check_save_folder(const std::filesystem::path& folder);

// The places as tact-prep export and a run's --poses read them; bodies that make no sense are left out.
nlohmann::json poses_json(const BodiesTopic& bodies, const std::vector<Structure>& structures);

// Writes DIR/poses.json, runs tact-prep, which says on standard output what it wrote. A signal that comes
// while it works ends it, which is an error; those that came before asked for something else.
void save_fit(const SaveRequest& request, const nlohmann::json& poses, Signals& signals);

}  // namespace tact::launch
