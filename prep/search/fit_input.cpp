#include "prep/search/fit_input.hpp"

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/density/subtracted_map.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/file/scene_peek.hpp"
#include "prep/export/poses_file.hpp"
#include "prep/input/read_file.hpp"
#include "prep/map/map_resolution.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/structure/import_structure.hpp"

namespace tact {
namespace {

constexpr std::uint64_t kPosesBytesMax = 4 << 20;

FitData from_files(const FitInput& input) {
    const auto refuse = [&](const char* why, const char* fix) {
        throw StartupError("fitting into " + input.map.path, why, fix);
    };
    if (input.models.empty()) refuse("no structure is given", "name PDB or mmCIF files after the map");
    if (!input.poses.empty() || input.body)
        refuse("--poses and --body need a baked docking scene",
               "bake one with tact-prep dock, or leave them out");
    FitData data;
    ReadMap map = read_map(input.map);
    data.grid = std::move(map.grid);
    const MapStatistics statistics = map_statistics(data.grid);
    data.metrics = {map.resolution_m, choose_contour(data.grid, statistics).level, statistics.background,
                    statistics.sigma};
    const auto read = [](const std::vector<std::string>& paths, std::vector<StructureAt>& list) {
        for (const std::string& path : paths) {
            Structure s = import_structure(path).structure;
            const Pose home = s.home();
            list.push_back({path, std::move(s), home});
        }
    };
    read(input.models, data.models);
    read(input.fixed, data.fixed);
    return data;
}

FitData from_scene(const FitInput& input) {
    const auto refuse = [&](const std::string& why, const std::string& fix) {
        throw StartupError("fitting in the scene " + input.map.path, why, fix);
    };
    if (!input.map.mask.empty() || !input.map.half_maps.empty())
        refuse("a scene holds its map as it was masked when it was baked",
               "bake it with --mask and --half-map");
    if (!input.models.empty() || !input.fixed.empty())
        refuse("a scene holds its structures; files beside it are not used",
               "leave them out, or give the map itself in place of the scene");
    const SceneFile scene = SceneFile::open(input.map.path);
    const SceneMeta meta = read_meta(scene);
    if (meta.body_count == 0)
        refuse("it has no structures", "use a docking scene, baked with tact-prep dock");
    FitData data;
    data.grid = read_grid(scene);
    const double resolution_m =
        input.map.resolution_a ? *input.map.resolution_a * kAngstromM : meta.resolution_m;
    if (!(resolution_m > 0.0)) refuse_unknown_resolution(input.map.path, data.grid.spacing_m);
    check_resolution(resolution_m, "--resolution-a");
    data.metrics = {resolution_m, meta.contour, meta.map_background, meta.map_sigma};
    std::vector<PlacedBody> bodies;
    if (input.poses.empty()) {
        for (std::uint32_t i = 0; i < meta.body_count; ++i)
            bodies.push_back({i + 1, i, read_structure(scene, i).home(), false, {}});
    } else {
        const std::vector<char> json = read_whole_file(input.poses, kPosesBytesMax);
        bodies = read_poses({json.data(), json.size()}, input.poses, meta.body_count);
    }
    for (const PlacedBody& body : bodies) {
        const bool wanted = input.body ? body.id == *input.body : !body.fixed;
        if (!wanted && !body.fixed) continue;
        const Structure straight = read_structure(scene, body.structure);
        Structure s = bent_structure(straight, read_modes(scene, body.structure, straight), body.amplitude_m);
        const std::string name = s.name;
        (wanted ? data.models : data.fixed).push_back({name, std::move(s), body.T_model_body});
    }
    if (data.models.empty())
        refuse(input.body ? "it has no body " + std::to_string(*input.body) : "all its bodies are fixed",
               "name a body of the scene with --body");
    return data;
}

}  // namespace

void FitInput::add_to(CLI::App& command) {
    command.add_option("map", map.path, "Density map: MRC, CCP4 or Situs, also .gz")->required();
    command.add_option("models", models, "Structures: PDB or mmCIF, also .gz");
    map.add_options(command);
    command
        .add_option(
            "--fixed", fixed,
            "Structure at the position of its file: subtracted from the map first. Repeat for several")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void FitInput::add_scene_to(CLI::App& command) {
    command.get_option("map")->description(
        "Density map: MRC, CCP4 or Situs, also .gz; or a baked docking scene");
    command
        .add_option("--poses", poses,
                    "With a scene: JSON file with the poses of its bodies; those with \"fixed\": true are "
                    "subtracted from the map first")
        ->type_name("FILE");
    command.add_option("--body", body, "With a scene: id of the only body to look for")->type_name("ID");
}

std::vector<std::string> FitInput::paths() const {
    std::vector<std::string> all = models;
    for (const std::string& file : map.paths()) all.push_back(file);
    all.insert(all.end(), fixed.begin(), fixed.end());
    if (!poses.empty()) all.push_back(poses);
    return all;
}

std::vector<PlacedStructure> FitData::placed() const {
    std::vector<PlacedStructure> list;
    for (const StructureAt& s : fixed) list.push_back({&s.structure, s.T_model_body});
    return list;
}

FitData read_fit_input(const FitInput& input) {
    FitData data = is_scene(input.map.path) ? from_scene(input) : from_files(input);
    data.rest = data.fixed.empty() ? data.grid
                                   : subtract_placed(data.grid, data.metrics.background, data.placed(),
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
