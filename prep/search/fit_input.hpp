// What search and refine read: a map with its resolution, and structures that are already placed in it. From files, or from a baked
// docking scene, which is what a window shows.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/scene/density/simulated_map.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "prep/map/read_map.hpp"

namespace tact {

struct FitInput {
    MapRequest map;  // a map, or a scene
    std::vector<std::string> models, fixed;
    // With a scene:
    std::string poses;                  // of its bodies (prep/export/poses_file.hpp); none: as baked
    std::optional<std::uint32_t> body;  // the only one to look for; none: each body

    void add_to(CLI::App& command);
    void add_scene_to(CLI::App& command);
    [[nodiscard]] std::vector<std::string> paths() const;  // of all files
};

// A structure and where it is.
struct StructureAt {
    std::string name;  // as given
    Structure structure;
    Pose T_model_body;
};

struct FitData {
    DensityGrid grid, rest;  // the map as it is, and without the fixed structures
    FitSettings metrics;     // resolution, background, sigma and contour of the map
    std::vector<StructureAt> models, fixed;
    [[nodiscard]] std::vector<PlacedStructure> placed() const;  // the fixed ones
};

// Fails by StartupError, also if no resolution is given: a guessed one ranks wrong places first.
[[nodiscard]] FitData read_fit_input(const FitInput& input);

// 3 x 4, row-major, from the coordinates of the structure's file to those of the map, angstrom.
[[nodiscard]] std::array<double, 12> matrix_of(const Structure& structure, const Pose& T_model_body);

}  // namespace tact
