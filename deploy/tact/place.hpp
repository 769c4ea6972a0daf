// How far a structure is from the place that its file gives it, and how well it explains the map there.
#pragma once

#include <optional>
#include <vector>

#include "ipc/assets/density_map.hpp"
#include "ipc/assets/fit_metrics.hpp"
#include "ipc/assets/scene_file.hpp"
#include "ipc/assets/scene_meta.hpp"
#include "ipc/assets/structure.hpp"
#include "ipc/topics/bodies.hpp"

namespace tact::launch {

struct Offset {
    double distance_a = 0.0;  // of the centre of mass
    double angle_deg = 0.0;
};

// The parts of a docking scene that a run is judged by.
class Places {
public:
    explicit Places(const SceneFile& file);  // throws StartupError
    [[nodiscard]] const SceneMeta& meta() const { return meta_; }
    [[nodiscard]] const std::vector<Structure>& structures() const { return structures_; }
    [[nodiscard]] const DensityGrid& grid() const { return grid_; }

    // Empty where the topic does not fit the scene or holds no numbers.
    [[nodiscard]] std::optional<std::vector<Pose>> poses(const BodiesTopic& bodies) const;
    [[nodiscard]] std::vector<Pose> file_poses() const;
    [[nodiscard]] Offset offset(const Pose& T_model_body, std::size_t body) const;
    // Empty where the map's resolution is not known. Takes up to seconds for large maps.
    [[nodiscard]] std::optional<FitMetrics> fit(const std::vector<Pose>& poses) const;

private:
    SceneMeta meta_;
    DensityGrid grid_;
    std::vector<Structure> structures_;
};

}  // namespace tact::launch
