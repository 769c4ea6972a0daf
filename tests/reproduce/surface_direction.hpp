// Angle between the force and the true normal of a smooth surface: a sphere, so that the normal is known.
//
// Hand       slides at 55 and 220 mm/s, 1.5 +- 0.5 mm deep (touch_paths.hpp); no friction, because it would rotate the
//            force
// Reference  the direction from the centre of the sphere to the tool
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/touch_run.hpp"

namespace tact::launch {

struct DirectionRow {
    std::size_t triangles = 0, steps = 0;  // steps: number of steps in contact
    std::string tool, mode;
    double speed_mm_s = 0.0;
    double p50_deg = 0.0, p99_deg = 0.0, max_deg = 0.0;
};

// steps: of a run along the path, on a sphere centred at the origin of the model.
DirectionRow direction_of(const std::vector<TouchStep>& steps, const std::vector<Vec3>& path_model_m);

[[nodiscard]] std::string csv_of(const std::vector<DirectionRow>& rows);
[[nodiscard]] nlohmann::json json_of(const std::vector<DirectionRow>& rows);

}  // namespace tact::launch
