// Poses of bodies in the format of tact-prep export, tact-search and tact-rt --poses (prep/export/poses_file.hpp).
#pragma once

#include <span>
#include <string>

#include "gui/docking/fit_worker.hpp"

namespace tact {

struct PosedBody {
    FitBody body;
    bool fixed = false;
};

// The structures must be those of the content, which has a docking scene.
[[nodiscard]] std::string bodies_json(std::span<const PosedBody> bodies,
                                      const SceneContent& content);  // the list alone
[[nodiscard]] std::string poses_json(std::span<const PosedBody> bodies, const SceneContent& content);

}  // namespace tact
