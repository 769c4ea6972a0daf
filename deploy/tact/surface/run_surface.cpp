// A run on a surface: adds nothing to the common run.
#include <nlohmann/json.hpp>

#include "deploy/tact/surface/surface.hpp"

namespace tact::launch {

std::unique_ptr<SystemRun> open_surface_run(const SceneFile& /*scene*/) {
    return std::make_unique<SystemRun>();
}

std::string surface_summary(const nlohmann::json& /*report*/) { return {}; }

}  // namespace tact::launch
