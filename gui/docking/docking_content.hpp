// Content of a docking scene besides map and mesh: structures, their codebooks and bonds.
#pragma once

#include <vector>

#include "gui/render/scene_content.hpp"
#include "ipc/scene/density/bonds.hpp"
#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

class DockingContent : public SystemContent {
public:
    std::vector<Structure> bodies;
    std::vector<Codebook> codebooks;       // one per body
    std::vector<std::vector<Bond>> bonds;  // one list per body
    std::vector<NormalModes> modes;        // one per body, or none
    std::vector<Pose> starts;              // where a controller starts the bodies; none: as in their files

    [[nodiscard]] Pose start_of(std::size_t body) const {
        return body < starts.size() ? starts[body] : bodies[body].home();
    }
    // count() 0: the body does not bend.
    [[nodiscard]] const NormalModes& modes_of(std::size_t body) const;
    void each_point(const std::function<void(const Vec3&)>& take) const override;
};

// Has no bodies if the scene belongs to another system.
[[nodiscard]] const DockingContent& docking_of(const SceneContent& content);
// Throws StartupError naming the file.
[[nodiscard]] std::unique_ptr<SystemContent> read_docking(SceneFile file, SceneContent& content);

}  // namespace tact
