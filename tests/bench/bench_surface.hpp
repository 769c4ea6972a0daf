// Cost of contact with a surface on this machine: for `tact bench surface`.
//
// Work     a rough sphere of about 50 mm radius, made by tact-prep; the key names the number of triangles (92k: 92 480,
//          2m: 1 997 120, 10m: 9 996 980). A tool slides over it at about 55 mm/s, 1.5 +- 0.5 mm deep, with a stiffness
//          of 0.5 N/mm, for 4 s at 1000 positions per second.
// Tools    tool1000: a block of 16 x 8 x 12 mm, sampled with 1000 points, one side flat on the sphere; scaler1000: a
//          dental scaler, sampled with 1000 points, on its tip; point, sphere1mm and sphere3mm: a point and balls
// Method   see touch_run.hpp; three passes. jammed: number of cycles in series of five or more with a stuck proxy.
// Keys     TOOL_us_p50/p99/p999/max_SIZE: times of a step in one pass at 1 kHz; TOOL_us_best_of_3_...: percentiles of
//          the minimum time of each step over three passes, an estimate of the cost of the code alone
// Memory   about 4 GB while the largest mesh is baked
// Fails by StartupError if tact-prep fails, or a mesh or path cannot be read
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

nlohmann::json bench_surface();

struct SurfaceWork {
    std::filesystem::path mesh, trajectory;  // trajectory: text, one line x y z, in the unit of the mesh
    std::string unit = "mm";
    double radius_mm = 0.0;
};
// Returns one line per position: t_s, force (N), time in the first pass, which runs at 1 kHz (us), whether the proxy
// has settled, and the minimum time over three passes (us). Stiffness 0.5 N/mm, without friction and force shading.
std::string surface_work_csv(const SurfaceWork& work);

}  // namespace tact::launch
