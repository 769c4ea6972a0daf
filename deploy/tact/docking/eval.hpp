// The servo's docking force at poses from a file: for `tact eval`.
//
// In       poses of the tool, see poses_csv.hpp. The body is held at the tool: its centre of mass is at the
//          tool's origin and its axes are those of the tool, T_model_body = (to_model(p), q). `tact info`
//          prints the mapping. The other bodies stay at the positions in their files.
// Out      one line per pose, in order:
//          t_s,fx_n,fy_n,fz_n,tx_n_m,ty_n_m,tz_n_m,cost_us,error_n,points,status
//          force and torque in world axes at the tool's origin, without ramp or safety chain; cost measured on this
//          machine; error: estimated bound relative to all atoms; status: ok, out_of_time or out_of_range.
// Fails by StartupError; the output file is whole or absent.
#pragma once

#include <cstdint>
#include <filesystem>

namespace tact::launch {

struct EvalSummary {
    std::uint64_t poses = 0;
    std::uint64_t not_ok = 0;
    double force_n_max = 0.0;
    double cost_us_p50 = 0.0, cost_us_max = 0.0;
};

struct EvalRequest {
    std::filesystem::path scene, poses_csv, out_csv;
    double fidelity = 1.0;      // 1: all atoms; 0: the smallest codebook level
    std::uint32_t body = 1;     // id, from 1 in the order of the scene's structures
    std::uint32_t options = 0;  // DockingOption: clash, subtraction, Laplacian
};
EvalSummary run_eval(const EvalRequest& request);

}  // namespace tact::launch
