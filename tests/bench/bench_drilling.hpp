// Cost and accuracy of drilling on this machine: for `tact bench drilling`.
//
// Work     per case, a stroke of 4000 steps through a block of bone with a dense shell and air cells (drill_run.hpp);
//          the times include force and erosion
// Keys     cycle_us_p50/p99/p999/max_rR_hH: times of a step in one pass at 1 kHz; burr radius R mm, voxels of H mm
//          (256 x 128 x 128; 256^3 for R = 20; 512^3 at 0.1 mm)
//          cycle_us_best_of_3_p50/...: percentiles of the minimum time of each step over three passes, of which the
//          second and third run without pauses: an estimate of the cost of the code alone
//          _finest: at the finest level instead of the default; _cylinder, _cone: heads of 8 mm
//          force_error_mean/max: relative error of the elastic force at the default level; reference: voxel by voxel
//          removed_volume_error_max: maximum relative error of the removed mass over servo rates of 500 Hz to 4 kHz and
//          strokes of 5 to 200 mm/s; reference: the integral of equation 12
//          removed_volume_error_N_hz_V_mm_s: the signed error in each of these cases
// Memory   about 400 MB for the largest case
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tact::launch {

nlohmann::json bench_drilling();

struct DrillingWork {
    std::filesystem::path volume,
        trajectory;  // volume: raw bytes, x fastest; trajectory: text, one line x y z of the burr centre (mm)
    std::vector<std::uint32_t> size = {256, 128, 128};
    double voxel_mm = 0.3, radius_mm = 3.0;
};
// Returns one line per position: t_s, force (N), time in the first pass, which runs at 1 kHz (us), number of voxels
// emptied in this step, mass removed in this step (in voxels of solid bone), and the minimum time over three passes
// (us). The corner of the volume is the origin.
std::string drilling_work_csv(const DrillingWork& work);

}  // namespace tact::launch
