#include "prep/search/fit_input.hpp"

#include <cstdio>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "prep/map/import_map.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/structure/import_structure.hpp"

namespace tact {
namespace {

double resolution_m(const FitInput& input, const DensityGrid& grid) {
    if (input.resolution_a) return *input.resolution_a * kAngstromM;
    const double voxel_a = grid.spacing_m.maxCoeff() / kAngstromM;
    char fix[160];
    std::snprintf(fix, sizeof fix,
                  "give it with --resolution-a; with voxels of %.2f Å it is probably between %.1f and %.1f",
                  voxel_a, 2.0 * voxel_a, 5.0 * voxel_a);
    throw StartupError("fitting into " + input.map, "the resolution of the map is unknown", fix);
}

}  // namespace

void FitInput::add_to(CLI::App& command) {
    command.add_option("map", map, "Density map: MRC, CCP4 or Situs, also .gz")->required();
    command.add_option("models", models, "Structures: PDB or mmCIF, also .gz")->required();
    command.add_option("--resolution-a", resolution_a, "Resolution of the map (angstrom)")
        ->check(CLI::PositiveNumber);
    command
        .add_option(
            "--fixed", fixed,
            "Structure at the position of its file: subtracted from the map first. Repeat for several")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::vector<std::string> FitInput::paths() const {
    std::vector<std::string> all = models;
    all.push_back(map);
    all.insert(all.end(), fixed.begin(), fixed.end());
    return all;
}

std::vector<PlacedStructure> FitData::placed() const {
    std::vector<PlacedStructure> list;
    for (const Structure& s : fixed) list.push_back({&s, s.home()});
    return list;
}

FitData read_fit_input(const FitInput& input) {
    FitData data;
    data.grid = import_map(input.map).grid;
    const MapStatistics statistics = map_statistics(data.grid);
    data.metrics = {resolution_m(input, data.grid), choose_contour(data.grid, statistics).level,
                    statistics.background, statistics.sigma};
    for (const std::string& path : input.models) data.models.push_back(import_structure(path).structure);
    for (const std::string& path : input.fixed) data.fixed.push_back(import_structure(path).structure);
    data.rest = data.fixed.empty() ? data.grid
                                   : subtract_placed(data.grid, statistics.background, data.placed(),
                                                     data.metrics.resolution_m)
                                         .grid;
    return data;
}

std::array<double, 12> matrix_of(const Structure& structure, const Pose& T_model_body) {
    const Eigen::Matrix3d turn = T_model_body.q.toRotationMatrix();
    const Vec3 shift_a = (T_model_body.p_m - turn * structure.home_com_model_m) / kAngstromM;
    std::array<double, 12> m{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            m[static_cast<std::size_t>(4 * row + column)] = turn(row, column);
        m[static_cast<std::size_t>(4 * row + 3)] = shift_a[row];
    }
    return m;
}

}  // namespace tact
