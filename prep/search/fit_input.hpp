// What search and refine read: a map with its resolution, and structures that are already placed in it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ipc/scene/density/simulated_map.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"

namespace tact {

struct FitInput {
    std::string map;
    std::vector<std::string> models, fixed;
    std::optional<double> resolution_a;

    void add_to(CLI::App& command);
    [[nodiscard]] std::vector<std::string> paths() const;  // of all files
};

struct FitData {
    DensityGrid grid, rest;  // the map as it is, and without the fixed structures
    FitSettings metrics;     // resolution, background, sigma and contour of the map
    std::vector<Structure> models, fixed;
    [[nodiscard]] std::vector<PlacedStructure> placed() const;  // the fixed ones
};

// Fails by StartupError, also if no resolution is given: a guessed one ranks wrong places first.
[[nodiscard]] FitData read_fit_input(const FitInput& input);

// 3 x 4, row-major, from the coordinates of the structure's file to those of the map, angstrom.
[[nodiscard]] std::array<double, 12> matrix_of(const Structure& structure, const Pose& T_model_body);

}  // namespace tact
