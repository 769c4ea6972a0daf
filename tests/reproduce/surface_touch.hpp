// Measures contact with one mesh for every tool, a slow and a fast hand and the three modes: rows of table 1.
//
// Tools     a point, balls, and a block of 1000 points (TOOLS.md of rt/force/surface)
// Off-brute only up to a maximum number of triangles, with fewer steps for larger meshes
// Thread    one. Fails by StartupError if the scene is not a surface with a forest.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/reproduce/surface_rows.hpp"

namespace tact::launch {

struct TouchBall {
    const char* name;
    double radius_m;
};
inline constexpr TouchBall kTouchBalls[] = {{"point", 0.0}, {"1 mm", 1e-3}, {"3 mm", 3e-3}};
inline constexpr const char* kSlowHand = "slow";  // as in the paper

[[nodiscard]] SurfaceSettings settings_to_measure(double radius_m);
// Prints each row when it is complete.
[[nodiscard]] std::vector<TouchRow> touch_in_all_modes(const std::string& name,
                                                       const std::filesystem::path& scene, bool quick);

}  // namespace tact::launch
