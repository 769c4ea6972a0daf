// A baked scene as it is drawn and measured, read at once: what every system has, and what one system alone
// has.
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

// What one system alone has in a scene; each derives its own.
class SystemContent {
public:
    virtual ~SystemContent() = default;
    // Points that the home view holds, model.
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
    ContourScale scale;                     // what a level of it means
    Vec3 centre_model_m = Vec3::Zero();     // of what is drawn: origin of the scene frame
    double radius_m = 0.0;                  // of a ball about it that holds everything at home
    Vec3 box_min_model_m = Vec3::Zero(),
         box_max_model_m = Vec3::Zero();  // of the map
    std::unique_ptr<SystemContent> system;

    // Null: the scene is of another system.
    template <class Content>
    [[nodiscard]] const Content* of() const {
        return dynamic_cast<const Content*>(system.get());
    }
};

}  // namespace tact
