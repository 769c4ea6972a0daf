// Poses of bodies as JSON: in run reports and saves of the visual process; `tact run --poses` reads them.
//
//   {"bodies": [{"id": 1, "structure": 0, "name": "1oel.pdb", "pos_model_a": [x, y, z],
//                "quat_model_body_xyzw": [x, y, z, w], "fixed": false}, …]}
//
// mode_amplitudes_a: optional, how a body is bent along the modes of its structure, at most 20 numbers (ångström).
// pos_model_a: centre of mass in the map's frame, ångström. fixed: may be absent. Other keys are ignored.
// Fails by  StartupError: not JSON, more than 1024 bodies, a repeated id, a structure that the scene does not have,
//           a position beyond 1e5 ångström, a quaternion whose norm is not 1 within 0.001, an amplitude beyond 1000 ångström.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

struct PlacedBody {
    std::uint32_t id = 0;
    std::uint32_t structure = 0;
    Pose T_model_body;
    bool fixed = false;
    std::vector<float> amplitude_m{};  // of the modes; empty: straight
};

std::vector<PlacedBody> read_poses(std::string_view json, const std::string& name, std::uint32_t structures);

}  // namespace tact
