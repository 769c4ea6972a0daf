#include "tests/reproduce/experiment_scene.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "deploy/tact/files.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "tests/reproduce/run_prep.hpp"
#include "tests/support/map_file.hpp"

namespace tact::launch {
namespace {

void bake(std::vector<std::string> arguments, const std::filesystem::path& scene) {
    arguments.insert(arguments.end(), {"-o", scene.string()});
    run_prep(arguments, scene.string() + ".log", "baking " + scene.string());
}

std::string pdb_of(const Structure& s) {
    std::string text;
    const auto at = [](float body, double home) { return (static_cast<double>(body) + home) / kAngstromM; };
    for (std::size_t i = 0; i < s.size(); ++i) {
        std::array<char, 96> line{};
        std::snprintf(line.data(), line.size(),
                      "ATOM  %5zu  CA  GLY A%4zu    %8.3f%8.3f%8.3f  1.00  0.00           C\n", i + 1,
                      i % 9999 + 1, at(s.x_m[i], s.home_com_model_m.x()),
                      at(s.y_m[i], s.home_com_model_m.y()), at(s.z_m[i], s.home_com_model_m.z()));
        text += line.data();
    }
    return text + "END\n";
}

DensityGrid finer(const DensityGrid& grid, const SceneMeta& meta, int times) {
    const DensityMap map(grid, meta.map_background, meta.map_sigma);
    DensityGrid out;
    out.origin_m = grid.origin_m;
    out.spacing_m = grid.spacing_m / times;
    for (std::size_t i = 0; i < 3; ++i)
        out.size[i] = (grid.size[i] - 1) * static_cast<std::uint32_t>(times) + 1;
    out.values.reserve(out.count());
    Vec3 unused;
    for (std::uint32_t z = 0; z < out.size[2]; ++z)
        for (std::uint32_t y = 0; y < out.size[1]; ++y)
            for (std::uint32_t x = 0; x < out.size[0]; ++x) {
                const Vec3 at = out.origin_m + Vec3(x, y, z).cwiseProduct(out.spacing_m);
                out.values.push_back(
                    static_cast<float>(meta.map_background + meta.map_sigma * map.sample(at, unused)));
            }
    return out;
}

Structure repeated(const Structure& s, int times) {
    Structure out = s;
    for (float& m : out.mass_fraction) m /= static_cast<float>(times);
    const auto again = [times](auto& v, std::size_t n) {
        v.reserve(n * static_cast<std::size_t>(times));
        for (int i = 1; i < times; ++i)
            for (std::size_t k = 0; k < n; ++k) v.push_back(v[k]);
    };
    const std::size_t n = s.size();
    again(out.x_m, n), again(out.y_m, n), again(out.z_m, n);
    again(out.mass_fraction, n), again(out.element, n), again(out.chain, n), again(out.residue, n);
    out.trace.resize(n * static_cast<std::size_t>(times), 0);  // the trace is drawn once
    return out;
}

}  // namespace

ExperimentScene make_experiment_scene(const std::filesystem::path& folder, const SceneScale& scale) {
    const auto demo_path = folder / "demo.tact", fine_path = folder / "fine.tact";
    std::error_code ignored;
    if (!std::filesystem::exists(demo_path, ignored)) bake({"demo", "dock"}, demo_path);
    const SceneFile demo = SceneFile::open(demo_path);
    SceneMeta meta = read_meta(demo);
    const DensityGrid grid = read_grid(demo);
    const Structure structure = read_structure(demo, 0);
    if (!std::filesystem::exists(fine_path, ignored)) {
        write_whole(folder / "fine.mrc", map_file_bytes(finer(grid, meta, scale.map_finer)));
        write_whole(folder / "one.pdb", pdb_of(structure));
        bake({"dock", (folder / "fine.mrc").string(), (folder / "one.pdb").string(), "--contour",
              std::to_string(meta.contour), "--resolution-a", "12"},
             fine_path);
    }
    const SceneFile fine = SceneFile::open(fine_path);

    ExperimentScene made;
    made.path = folder / "experiment.tact";
    SceneWriter out;
    write_meta(out, meta,
               "made by: tact reproduce governor\nscale: map x " + std::to_string(scale.map_finer) +
                   ", atoms x " + std::to_string(scale.atom_repeats));
    write_grid(out, grid);
    const Structure heavy = repeated(structure, scale.atom_repeats);
    write_structure(out, 0, heavy);
    // A structure of this size requires one coarse level as a fallback. With a single level, every knob level above
    // zero blends it with the sum over all points, so the work is constant. With fewer than 200 vectors, the knob
    // starts at all points.
    Codebook coarse = read_codebook(demo, 0);
    std::erase_if(coarse.levels, [](const Codebook::Level& l) { return l.size() >= 200; });
    if (coarse.levels.size() > 1) coarse.levels.erase(coarse.levels.begin(), coarse.levels.end() - 1);
    write_codebook(out, 0, coarse);
    const ProgressiveMeshData mesh = read_mesh_data(fine, 0);
    write_mesh(out, 0, mesh);
    out.write(made.path);
    made.vertices = static_cast<std::uint32_t>(mesh.vertex.size());
    made.points_summed = heavy.size();
    return made;
}

}  // namespace tact::launch
