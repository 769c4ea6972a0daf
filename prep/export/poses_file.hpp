// Where bodies are, as JSON: what a run's report and the visual process write, and `tact run --poses` reads.
//
//   {"bodies": [{"id": 1, "structure": 0, "name": "1oel.pdb", "pos_model_a": [x, y, z],
//                "quat_model_body_xyzw": [x, y, z, w]}, …]}
//
// pos_model_a: of the centre of mass, in the map's frame, ångström. Other keys are passed over.
// Fails by  StartupError: not JSON, more than 1024 bodies, an id twice, a structure that the scene has not,
//           a place beyond 1e5 ångström, a quaternion whose norm is not 1 within 0.001.
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
};

std::vector<PlacedBody> read_poses(std::string_view json, const std::string& name, std::uint32_t structures);

}  // namespace tact
