// Reproduces the table of docking results in rt/force/README.md from real maps.
//
//     docking_finds FOLDER [starts [name]]
//
// FOLDER contains the maps and structures named below. Without it the program exits with code 77, which CTest counts as
// skipped. `name` selects the rows whose names contain it.
//
// Method  from random starts with fixed seeds, 15 A and 30 degrees (and 8 A and 15 degrees) from the known pose,
//         steepest ascent maximizes the reduced correlation of all atoms. A start succeeds if it ends within one voxel
//         and 5 degrees of the known pose, or of a pose that is equivalent by the symmetry of the structure.
// Maps    the density; its Laplacian (at 20 A or the resolution of the map, as in rt/force/docking/force_map.hpp); both
//         with the other parts of the assembly subtracted
// Prints  the number of successes, and the mean distance of the end poses from the known pose
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/climb.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/laplacian_map.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "prep/map/import_map.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/structure/import_structure.hpp"
#include "rt/force/docking/force_map.hpp"
#include "rt/force/docking/start_pose.hpp"

namespace tact {
namespace {

constexpr double kA = kAngstromM;

PointsView points_of(const Structure& s) { return {s.x_m, s.y_m, s.z_m, s.mass_fraction}; }

Vec3 atom(const Structure& s, std::size_t i) {
    return {static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]), static_cast<double>(s.z_m[i])};
}

// To a maximum of the summed density, in steps that do not depend on the voxels of the map.
Pose climb(const DensityMap& map, const Structure& s, const Pose& pose) {
    constexpr ClimbSteps kSteps{.first_m = 0.5 * kA, .most_m = 2.0 * kA, .least_m = 1e-3 * kA};
    return climbed(map, points_of(s), pose, 3001, &kSteps);
}

// The poses equivalent by symmetry, which map the first chain onto each chain, if all chains are alike.
std::vector<Pose> equivalent_poses(const Structure& s) {
    std::vector<std::vector<std::size_t>> chain(s.chain_names.size());
    for (std::size_t i = 0; i < s.size(); ++i) chain[s.chain[i]].push_back(i);
    const auto matrix = [&](const std::vector<std::size_t>& of) {
        Eigen::Matrix3Xd m(3, static_cast<Eigen::Index>(of.size()));
        for (std::size_t i = 0; i < of.size(); ++i) {
            m.col(static_cast<Eigen::Index>(i)) = atom(s, of[i]);
        }
        return m;
    };
    std::vector<Pose> poses{Pose{}};
    for (std::size_t c = 1; c < chain.size(); ++c) {
        if (chain[c].size() != chain[0].size()) return {Pose{}};
        const Eigen::Matrix4d t = Eigen::umeyama(matrix(chain[0]), matrix(chain[c]), false);
        poses.push_back({t.topRightCorner<3, 1>(), Quat(Eigen::Matrix3d(t.topLeftCorner<3, 3>()))});
        // Only a symmetry about the centre of the structure maps the structure onto itself.
        if (poses.back().p_m.norm() > 2.0 * kA) return {Pose{}};
    }
    return poses;
}

struct Row {
    std::string name;
    std::string map;
    double resolution_a;
    Structure body;
    std::vector<Structure> neighbours;  // at their home poses
};

struct Variant {
    const char* name;
    bool subtract, laplacian;
};
constexpr Variant kVariants[] = {
    {"density", false, false},
    {"Laplacian", false, true},
    {"density, subtracted", true, false},
    {"Laplacian, subtracted", true, true},
};

struct Ends {
    int found = 0;
    double away_a = 0.0, turned_deg = 0.0;  // mean, from the nearest equivalent pose
};

Ends ends(const DensityMap& map, const Structure& s, double offset_m, double turn_rad, int starts) {
    const std::vector<Pose> equivalent = equivalent_poses(s);
    Ends out;
    for (int k = 1; k <= starts; ++k) {
        const Pose end =
            climb(map, s, start_pose(s.home(), offset_m, turn_rad, static_cast<std::uint64_t>(k)));
        Pose nearest;
        double least = 1e300;  // displacement of the atoms (m)
        for (const Pose& e : equivalent) {
            const Pose place = s.home() * e;
            const double d =
                (end.p_m - place.p_m).norm() + radius_of_gyration_m(s) * end.q.angularDistance(place.q);
            if (d < least) least = d, nearest = place;
        }
        const double away_m = (end.p_m - nearest.p_m).norm(), turned = end.q.angularDistance(nearest.q);
        out.away_a += away_m / kA / starts;
        out.turned_deg += turned / kDegreeRad / starts;
        if (away_m < map.spacing_m().maxCoeff() && turned < 5.0 * kDegreeRad) ++out.found;
    }
    return out;
}

void run(const Row& row, const std::filesystem::path& folder, int starts) {
    const DensityGrid grid = import_map(folder / row.map).grid;
    const MapStatistics statistics = map_statistics(grid);
    std::vector<PlacedStructure> placed;
    for (const Structure& s : row.neighbours) placed.push_back({&s, s.home()});
    for (const Variant& v : kVariants) {
        if (v.subtract && placed.empty()) continue;
        DensityGrid force_map = grid;
        double scale = 0.0, explained = 0.0;
        const auto begin = std::chrono::steady_clock::now();
        if (v.subtract) {
            SubtractedMap m = subtract_placed(grid, statistics.background, placed, row.resolution_a * kA);
            force_map = std::move(m.grid), scale = m.scale, explained = m.explained;
        }
        double background = statistics.background, sigma = statistics.sigma;
        if (v.laplacian) {
            force_map =
                laplacian_map(force_map, background, std::max(row.resolution_a * kA, kContourResolutionM));
            background = 0.0, sigma = rms_of(force_map);
        }
        const DensityMap map(force_map, background, sigma);
        const std::chrono::duration<double, std::milli> made = std::chrono::steady_clock::now() - begin;
        const Ends far = ends(map, row.body, 15.0 * kA, 30.0 * kDegreeRad, starts);
        const Ends near = ends(map, row.body, 8.0 * kA, 15.0 * kDegreeRad, starts);
        std::printf(
            "%-28s %-23s %2d (%2d) of %d, mean error %5.1f A %5.1f deg (%4.1f A %4.1f deg), map made in "
            "%3.0f ms",
            row.name.c_str(), v.name, far.found, near.found, starts, far.away_a, far.turned_deg, near.away_a,
            near.turned_deg, made.count());
        if (v.subtract) std::printf(", scale %.3g, explained %.2f", scale, explained);
        std::printf("\n");
        std::fflush(stdout);
    }
}

Structure read(const std::filesystem::path& path) { return import_structure(path).structure; }

// A structure from the given atoms at the given positions.
Structure placed_at(const Structure& from, const std::vector<std::size_t>& atoms,
                    const std::vector<Vec3>& place_m) {
    Structure s;
    s.name = from.name;
    double total = 0.0;
    for (std::size_t k = 0; k < atoms.size(); ++k) {
        const auto mass = static_cast<double>(from.mass_fraction[atoms[k]]);
        s.home_com_model_m += mass * place_m[k];
        total += mass;
    }
    s.home_com_model_m /= total;
    s.mass_u = from.mass_u * total;
    s.chain_names = {"A"};
    for (std::size_t k = 0; k < atoms.size(); ++k) {
        const Vec3 p = place_m[k] - s.home_com_model_m;
        s.x_m.push_back(static_cast<float>(p.x()));
        s.y_m.push_back(static_cast<float>(p.y()));
        s.z_m.push_back(static_cast<float>(p.z()));
        s.mass_fraction.push_back(
            static_cast<float>(static_cast<double>(from.mass_fraction[atoms[k]]) / total));
        s.element.push_back(from.element[atoms[k]]);
        s.chain.push_back(0);
    }
    return s;
}

Structure moved(const Structure& from, const Pose& home) {
    std::vector<std::size_t> atoms;
    std::vector<Vec3> place_m;
    for (std::size_t i = 0; i < from.size(); ++i) {
        atoms.push_back(i);
        place_m.push_back(home * atom(from, i));
    }
    return placed_at(from, atoms, place_m);
}

// The domains of one chain, each with the other four as neighbours.
void add_1gte(const std::filesystem::path& folder, std::vector<Row>& rows) {
    std::vector<Structure> domains;
    for (int d = 1; d <= 5; ++d)
        domains.push_back(read(folder / ("sim_1gte_d" + std::to_string(d) + ".pdb")));
    for (std::size_t d = 0; d < domains.size(); ++d) {
        rows.push_back({"1GTE domain " + std::to_string(d + 1), "sim_1gte_A_20A.mrc", 20.0, domains[d], {}});
        for (std::size_t o = 0; o < domains.size(); ++o) {
            if (o != d) rows.back().neighbours.push_back(domains[o]);
        }
    }
}

// Both rings of GroEL: the seven chains of 1OEL, moved by one placement per ring (from the answers file).
std::vector<Structure> groel_chains(const std::filesystem::path& folder) {
    const Structure ring = read(folder / "1oel.pdb.gz");
    std::ifstream file(folder / "answers_emd_1080_1oel.json");
    const auto answers = nlohmann::json::parse(file);
    std::vector<std::string> seen;
    std::vector<Structure> chains;
    for (const auto& answer : answers.at("placements")) {
        const auto which = answer.at("ring").get<std::string>();
        if (std::find(seen.begin(), seen.end(), which) != seen.end()) continue;
        seen.push_back(which);
        Eigen::Matrix3d r;
        Vec3 t;
        for (int i = 0; i < 3; ++i) {
            t[i] = kA * answer.at("t").at(static_cast<std::size_t>(i)).get<double>();
            for (int j = 0; j < 3; ++j) {
                r(i, j) = answer.at("R")
                              .at(static_cast<std::size_t>(i))
                              .at(static_cast<std::size_t>(j))
                              .get<double>();
            }
        }
        for (std::uint16_t c = 0; c < ring.chain_names.size(); ++c) {
            std::vector<std::size_t> atoms;
            std::vector<Vec3> place_m;
            for (std::size_t i = 0; i < ring.size(); ++i) {
                if (ring.chain[i] != c) continue;
                atoms.push_back(i);
                place_m.push_back(r * (ring.home() * atom(ring, i)) + t);
            }
            chains.push_back(placed_at(ring, atoms, place_m));
        }
    }
    return chains;
}

// One chain with the thirteen others as neighbours, at the pose of its authors (1KP8) and from the answers file (1OEL).
void add_groel(const std::filesystem::path& folder, std::vector<Row>& rows) {
    const char* const map = "emd_1080_groel_11.5A.mrc";
    Row fitted{"EMD-1080, 1KP8 chain A", map, 11.5, read(folder / "1kp8A_fitted_in_emd_1080.pdb"), {}};
    Row answer{"EMD-1080, 1OEL chain", map, 11.5, {}, {}};
    for (Structure& s : groel_chains(folder)) {
        if ((s.home_com_model_m - fitted.body.home_com_model_m).norm() < 20.0 * kA) {
            answer.body = std::move(s);
        } else {
            fitted.neighbours.push_back(s);
            answer.neighbours.push_back(std::move(s));
        }
    }
    rows.push_back(std::move(fitted));
    if (answer.body.size() > 0) rows.push_back(std::move(answer));
}

// F-actin, with the other subunits of the filament as neighbours. Their start poses are -166.6 degrees and 27.6 A apart
// along the axis through the middle of the map; climb() refines them. Subunits outside the box are excluded, because
// there is no density to subtract.
void add_actin(const std::filesystem::path& folder, const char* file, std::vector<Row>& rows) {
    Row row{std::string("EMD-5168, ") + std::string(file).substr(0, 4),
            "emd_5168_factin.map",
            6.6,
            read(folder / file),
            {}};
    const DensityGrid grid = import_map(folder / row.map).grid;
    const MapStatistics statistics = map_statistics(grid);
    const DensityMap map(grid, statistics.background, statistics.sigma);
    const double at_home = map.sum(points_of(row.body), row.body.home()).density_sigma;
    for (int k = -4; k <= 5; ++k) {
        if (k == 0) continue;
        const Quat turn(Eigen::AngleAxisd(-166.6 * kDegreeRad * k, Vec3::UnitZ()));
        const Pose guess{turn * row.body.home_com_model_m + 27.6 * kA * k * Vec3::UnitZ(), turn};
        const Pose end = climb(map, row.body, guess);
        if (map.sum(points_of(row.body), end).density_sigma < 0.5 * at_home) continue;
        row.neighbours.push_back(moved(row.body, end));
    }
    rows.push_back(std::move(row));
}

}  // namespace
}  // namespace tact

int main(int argc, char** argv) {
    using namespace tact;
    const std::filesystem::path folder = argc > 1 ? argv[1] : "";
    if (!std::filesystem::is_directory(folder)) {
        std::printf("skipped: no folder with maps. Usage: docking_finds FOLDER [starts [name]]\n");
        return 77;
    }
    const int starts = argc > 2 ? std::max(1, std::atoi(argv[2])) : 10;
    const std::string only = argc > 3 ? argv[3] : "";
    try {
        std::vector<Row> rows;
        const auto add = [&](const char* name, const char* map, double resolution_a, const char* structure) {
            rows.push_back({name, map, resolution_a, read(folder / structure), {}});
        };
        add("simulated 1OEL", "sim_1oel_10A.mrc", 10.0, "1oel.pdb.gz");
        add("simulated 1AKE", "sim_1akeA_10A.mrc", 10.0, "sim_1akeA.pdb");
        add("simulated 2DQJ", "sim_2dqj_10A.mrc", 10.0, "sim_2dqj.pdb");
        add("simulated 1Z5S", "sim_1z5s_20A.mrc", 20.0, "sim_1z5s.pdb");
        add("EMD-5778, one chain", "emd_5778_monomer.situs.gz", 3.3, "emd_5778_native.pdb");
        add("EMD-5925, one chain", "emd_5925_monomer.situs.gz", 3.5, "emd_5925_native.pdb");
        add_actin(folder, "3MFP.pdb", rows);
        add_actin(folder, "1J6Z_fitted_in_emd_5168.pdb", rows);
        add_groel(folder, rows);
        add_1gte(folder, rows);
        for (const Row& row : rows) {
            if (row.name.find(only) != std::string::npos) run(row, folder, starts);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
