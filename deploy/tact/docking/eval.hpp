// The servo's docking force at poses from a file: for `tact eval`.
//
// In       poses of the tool, see poses_csv.hpp. Body 0 of the scene is held at the tool: its centre of mass is at the
//          tool's origin and its axes are those of the tool, T_model_body = (to_model(p), q). `tact info`
//          prints the mapping.
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

// fidelity in [0, 1]: 1 is all atoms, 0 the smallest codebook level.
EvalSummary run_eval(const std::filesystem::path& scene, const std::filesystem::path& poses_csv,
                     const std::filesystem::path& out_csv, double fidelity);

}  // namespace tact::launch
