// Cost of touching a surface on this machine: for `tact bench surface`.
//
// Work     a rough sphere of about 50 mm radius, made by tact-prep, with the number of triangles in the key
//          (92k: 92 480, 2m: 1 997 120, 10m: 9 996 980); a tool slides over it at about 55 mm/s, 1.5 +- 0.5 mm
//          deep, 0.5 N/mm, 1000 positions per second for 4 s.
// Tools    tool1000: 1000 points of a block of 16 x 8 x 12 mm, one side flat on the sphere; scaler1000: 1000 points of a
//          dentist's scaler, on its tip
// Method   touch_run.hpp; three passes. Jammed are cycles, five or more in a row, whose proxy stands.
// Keys     TOOL_us_p50/p99/p999/max_SIZE: of a step, in one pass at 1 kHz, as the loop sees it; TOOL_us_best_of_3_...: of
//          the least times of each step in three passes, what the code alone costs
// Memory   some 4 GB for the largest, while it is baked
// Fails by StartupError: tact-prep does not bake, a mesh or path cannot be read.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

nlohmann::json bench_surface();

struct SurfaceWork {
    std::filesystem::path mesh, trajectory;  // trajectory: text, one line x y z, in the mesh's unit
    std::string unit = "mm";
    double radius_mm = 0.0;
};
// One line for each position: t_s, force in N, microseconds in one pass at 1 kHz, settled, least microseconds of three passes.
// 0.5 N/mm without friction and shading.
std::string surface_work_csv(const SurfaceWork& work);

}  // namespace tact::launch
