// A baked scene, loaded for rendering and measuring: the part common to all systems, and one system's own part.
//
// Thread   made by load_scene() on the loader thread; immutable afterwards.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "ipc/scene/density/contour_scale.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"

namespace tact {

// A system's own part of a scene; each system derives one.
class SystemContent {
public:
    virtual ~SystemContent() = default;
    // Passes the points that the home view must contain, model frame, to `take`.
    virtual void each_point(const std::function<void(const Vec3&)>& take) const { static_cast<void>(take); }

protected:
    SystemContent() = default;
    SystemContent(const SystemContent&) = default;
    SystemContent(SystemContent&&) = default;
    SystemContent& operator=(const SystemContent&) = default;
    SystemContent& operator=(SystemContent&&) = default;
};

struct SceneContent {
    std::filesystem::path path;
    std::uint64_t checksum = 0;
    SceneMeta meta{};
    std::string note;
    std::unique_ptr<ProgressiveMesh> mesh;  // null: the scene has none
    DensityGrid grid;                       // empty: none
    ContourScale scale;                     // conversion of its levels
    Vec3 centre_model_m = Vec3::Zero();     // of the drawn content: origin of the scene frame
    double radius_m = 0.0;                  // of a ball about it that contains the home view
    Vec3 box_min_model_m = Vec3::Zero(),
         box_max_model_m = Vec3::Zero();  // of the map
    std::unique_ptr<SystemContent> system;

    // Null: the scene belongs to another system.
    template <class Content>
    [[nodiscard]] const Content* of() const {
        return dynamic_cast<const Content*>(system.get());
    }
};

}  // namespace tact
