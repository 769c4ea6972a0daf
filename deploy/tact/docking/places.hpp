// Distance of a structure from the position in its file, and its fit to the map.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "ipc/topics/bodies.hpp"
#include "ipc/topics/shapes.hpp"

namespace tact::launch {

struct Offset {
    double distance_a = 0.0;  // distance of the centres of mass
    double angle_deg = 0.0;
};

// A body of a run: a placed copy of a structure of the scene.
struct BodyAt {
    std::uint32_t id = 0;  // 0: not from a run
    std::uint32_t structure = 0;
    Pose T_model_body;
    bool fixed = false, in_hand = false;
    std::vector<float> amplitude_m{};  // bent along its modes; empty: straight
};

// The map and the structures of a docking scene.
class Places {
public:
    explicit Places(const SceneFile& file);  // throws StartupError
    [[nodiscard]] const SceneMeta& meta() const { return meta_; }
    [[nodiscard]] const std::vector<Structure>& structures() const { return structures_; }
    [[nodiscard]] const std::vector<NormalModes>& modes() const { return modes_; }  // one per structure
    [[nodiscard]] const DensityGrid& grid() const { return grid_; }

    // Empty if a topic does not fit the scene or holds numbers that are not finite. shapes: null if no body bends.
    [[nodiscard]] std::optional<std::vector<BodyAt>> bodies(const BodiesTopic& topic,
                                                            const ShapesTopic* shapes = nullptr) const;
    // One body per structure, at the position in its file.
    [[nodiscard]] std::vector<BodyAt> file_bodies() const;
    [[nodiscard]] Offset offset(const BodyAt& body) const;
    // Takes up to seconds for large maps.
    [[nodiscard]] FitMetrics fit(const std::vector<BodyAt>& bodies) const;

private:
    SceneMeta meta_;
    DensityGrid grid_;
    std::vector<Structure> structures_;
    std::vector<NormalModes> modes_;
};

}  // namespace tact::launch
