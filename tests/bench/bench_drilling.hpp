// Cost and accuracy of drilling on this machine: for `tact bench drilling`.
//
// Work     strokes through a block of bone (drill_run.hpp), 4000 steps, shell and air cells; force and erosion together
// Keys     cycle_us_p50/p99/max_rR_hH: burr of R mm, voxels of H mm (256 x 128 x 128; 256^3 for R = 20; 512^3 at 0.1 mm);
//         _finest: at the finest level instead of the default; _cylinder, _cone: heads of 8 mm
//          force_error_mean/max: relative difference of the elastic force at the default level from that voxel by voxel
//          removed_volume_error_max: relative difference of the removed mass from the integral of equation 12, over servo
//          rates of 500 Hz to 4 kHz and strokes of 5 to 200 mm/s; removed_volume_error_N_hz_V_mm_s: each, with its sign
// Memory   about 400 MB for the largest
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
// One line per position: t_s, force in N, microseconds, newly empty voxels, and removed mass in voxels of solid bone. The
// origin is the corner of the volume.
std::string drilling_work_csv(const DrillingWork& work);

}  // namespace tact::launch
