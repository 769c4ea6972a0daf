// The map that a person names, with what is known of it: its resolution, its half-maps, a mask.
//
// The resolution is given, or measured from the half-maps; it is never guessed: forces, search and scores depend on it.
// Errors   StartupError
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "prep/map/import_map.hpp"

namespace tact {

struct MapRequest {
    std::string path;
    std::vector<std::string> half_maps;  // two, or none
    std::string mask;
    std::optional<double> resolution_a;

    void add_options(CLI::App& command);  // all but the path
    [[nodiscard]] std::vector<std::string> paths() const;
};

struct ReadMap {
    DensityGrid grid;  // masked
    double resolution_m = 0.0;
    std::string resolution_source;  // "as given"
    std::vector<std::string> note;  // lines "key: value"
};
[[nodiscard]] ReadMap read_map(const MapRequest& request);

// "100 x 100 x 100 voxels of 1.5 x 1.5 x 1.5 Å"
[[nodiscard]] std::string grid_text(const DensityGrid& grid);

}  // namespace tact
