// Start poses of the bodies of a run: from the options, or from a file with the final poses of an earlier run.
//
// File     JSON, an object with a list "bodies", as in the report of `tact run --json`. Each body has "structure" (index
//          in the scene), "pos_model_a" (centre of mass, model axes, angstrom) and "quat_model_body_xyzw" (unit length
//          within 2 %, then normalized). Optional: "name" (must equal the structure's name in this scene), "fixed" and
//          "in_hand" (true or false). Other members are ignored.
// Copies   of the first structure are free, on a circle around the map in the plane of the screen, a tenth outside its
//          box, the first copy at the top.
// Thread   start-up only. Fails by StartupError with file, body and problem.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "rt/force/docking/docking_bodies.hpp"

namespace tact {

// names: of the scene's structures.
std::vector<StartBody> read_start_bodies(const std::filesystem::path& path,
                                         const std::vector<std::string>& names);
std::vector<StartBody> parse_start_bodies(const std::string& text, const std::string& file,
                                          const std::vector<std::string>& names);

// The copies of structure 0, without the first body.
std::vector<StartBody> copies_about(const DensityGrid& grid, std::uint32_t copies);

}  // namespace tact
