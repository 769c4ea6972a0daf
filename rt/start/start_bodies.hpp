// Where the bodies of a run start: what the options say, or a file in which an earlier run wrote its end.
//
// File     JSON, an object with a list "bodies", as in the report of `tact run --json`. Of each body:
//          "structure" (index in the scene), "pos_model_a" (centre of mass, model axes, angstrom) and
//          "quat_model_body_xyzw" (unit length within 2 %, then normalized); may have "name" (of the
//          structure, which then has to be so called in this scene), "fixed" and "in_hand" (true or false).
//          Anything else in the file is passed over.
// Copies   of the first structure stand free on a circle about the map, in the plane of the screen, a tenth
//          outside of its box, the first of them at the top.
// Thread   start-up only. Fails by StartupError naming the file, the body and what is wrong.
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

// All copies of structure 0 but the first.
std::vector<StartBody> copies_about(const DensityGrid& grid, std::uint32_t copies);

}  // namespace tact
