// Runs the live model of a scene against its reference over random and path-like poses: for `tact certify`.
//
// Fails by StartupError if the scene cannot be read or has no reference.  Throws Cancelled if the progress says so.
#pragma once

#include <cstdint>

#include "ipc/base/progress.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "tests/reference/promises.hpp"

namespace tact {

struct CertifySettings {
    std::uint64_t poses = 2000;  // about half of them random, the others along paths of a hand
    std::uint64_t seed = 1;
    Progress progress;
};

// By the kind of the scene.
[[nodiscard]] reference::Promises certify(const SceneFile& scene, const CertifySettings& settings);

void certify_docking(const SceneFile& scene, const CertifySettings& settings, reference::Promises& promises);
void certify_surface(const SceneFile& scene, const CertifySettings& settings, reference::Promises& promises);
// The mesh tool of a surface scene.
void certify_tool(const SceneFile& scene, const CertifySettings& settings, reference::Promises& promises);
void certify_drilling(const SceneFile& scene, const CertifySettings& settings, reference::Promises& promises);

}  // namespace tact
