// Cost and accuracy of drilling on this machine: for `tact bench drilling`.
//
// Work     strokes through a block of bone (drill_run.hpp), 4000 steps, shell and air cells; force and erosion together
// Keys     cycle_us_p50/p99/p999/max_rR_hH: in one pass at 1 kHz, as the loop sees it; burr of R mm, voxels of H mm
//          (256 x 128 x 128; 256^3 for R = 20; 512^3 at 0.1 mm);
//          cycle_us_best_of_3_p50/...: of the least times of each step in three passes, steps following at once but in the
//          first: what the code alone costs
//          _finest: at the finest level instead of the default; _cylinder, _cone: heads of 8 mm
//          force_error_mean/max: of the elastic force at the default level against voxel by voxel, over the force
//          removed_volume_error_max: removed mass against the integral of equation 12, over servo rates of 500
//          Hz to 4 kHz and strokes of 5 to 200 mm/s; removed_volume_error_N_hz_V_mm_s: each, with its sign
// Memory   some 400 MB for the largest
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

nlohmann::json bench_drilling();

struct DrillingWork {
    std::filesystem::path volume,
        trajectory;  // raw bytes, x fastest; text: one line x y z of the burr's centre, mm
    std::vector<std::uint32_t> size = {256, 128, 128};
    double voxel_mm = 0.3, radius_mm = 3.0;
};
// One line for each position: t_s, force in N, microseconds in one pass at 1 kHz, voxels that are empty since, the mass that
// went, in voxels of solid bone, and the least microseconds of three passes. The corner of the volume is the origin.
std::string drilling_work_csv(const DrillingWork& work);

}  // namespace tact::launch
