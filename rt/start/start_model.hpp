// The one place that knows which model a scene is for.
//
// Thread  start-up; fails by StartupError. Scene and bone outlive the models.
#pragma once

#include <memory>

#include "ipc/scene/file/scene_file.hpp"
#include "rt/force/force_model.hpp"
#include "rt/start/scene_bone.hpp"
#include "rt/start/start_options.hpp"

namespace tact {

// bone: null where the scene is of none.
[[nodiscard]] std::unique_ptr<ForceModel> load_model(const SceneFile& scene, SceneBone* bone,
                                                     const StartOptions& options, const RtConfig& config);
// Of the second hand.
[[nodiscard]] std::unique_ptr<ForceModel> load_second(const SceneFile& scene, SceneBone* bone,
                                                      const StartOptions& options, const RtConfig& config);

}  // namespace tact
