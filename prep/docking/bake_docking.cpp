#include "prep/docking/bake_docking.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/base/error.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/docking_gain.hpp"
#include "ipc/scene/density/isosurface.hpp"
#include "ipc/scene/density/start_place.hpp"
#include "prep/codebook/best_codebook.hpp"
#include "prep/map/low_pass.hpp"
#include "prep/map/map_resolution.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/mesh/progressive.hpp"
#include "prep/modes/bake_modes.hpp"

namespace tact {
namespace {

constexpr double kHandExtentM = 0.16;

// Mean position of the voxels above the contour, weighted by their height above it.
Vec3 centre_of_density(const DensityGrid& grid, double contour) {
    Vec3 sum = Vec3::Zero();
    double weight = 0.0;
    std::size_t i = 0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x, ++i) {
                const double w = static_cast<double>(grid.values[i]) - contour;
                if (w <= 0.0) continue;
                sum += w * Vec3(x, y, z);
                weight += w;
            }
        }
    }
    return grid.origin_m + grid.spacing_m.cwiseProduct(sum / weight);
}

void set_title(SceneMeta& meta, const std::string& title) {
    std::size_t length = std::min(title.size(), sizeof meta.title - 1);
    // Do not cut inside a UTF-8 character.
    while (length < title.size() && length > 0 && (static_cast<unsigned char>(title[length]) & 0xC0) == 0x80)
        --length;
    std::memcpy(meta.title, title.data(), length);
    for (std::size_t i = 0; i < length; ++i) {
        if (static_cast<unsigned char>(meta.title[i]) < 0x20 || meta.title[i] == 0x7f) meta.title[i] = '?';
    }
}

void check_input(const DockingInput& input) {
    if (input.structures.empty())
        throw StartupError("bake a docking scene", "no structure is given",
                           "give one or more PDB or mmCIF files after the map");
    if (input.structures.size() > kSceneBodiesMax) {
        throw StartupError("bake a docking scene",
                           std::to_string(input.structures.size()) + " structures are more than " +
                               std::to_string(kSceneBodiesMax),
                           "join some structures into one file, or give fewer");
    }
    check_resolution(input.resolution_m, "--resolution-a");
    if (input.force_map_resolution_m)
        check_resolution(*input.force_map_resolution_m, "--force-map-resolution-a");
}

void check_reach(const Structure& s, const DensityGrid& grid) {
    if (in_reach(grid, s.home_com_model_m)) return;
    throw StartupError(
        "bake a docking scene",
        s.name + printed(" lies %.0f Å outside the map, beyond the reach of the hand",
                         outside_m(grid, s.home_com_model_m) / kAngstromM),
        "move the structure near the map, correct the map's origin, or dock it beside the map: "
        "tact-prep dock --allow-outside, or add it to a scene with tact dock SCENE MODEL");
}

BakedBody describe(const Structure& s, const Codebook& codebook, const DensityMap& map,
                   double contour_sigma) {
    BakedBody body;
    body.name = s.name;
    body.atoms = s.size();
    for (const Codebook::Level& level : codebook.levels) body.codebook.push_back(level.size());
    std::size_t inside = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        Vec3 gradient;
        const double density = map.sample(s.home() * Vec3(s.x_m[i], s.y_m[i], s.z_m[i]), gradient);
        body.density_home_sigma += static_cast<double>(s.mass_fraction[i]) * density;
        if (density > contour_sigma) ++inside;
    }
    body.inside_home = static_cast<double>(inside) / static_cast<double>(s.size());
    return body;
}

void say_codebook(std::size_t body, const BestCodebook& best, std::string& note) {
    for (std::size_t l = 0; l < best.quality.size(); ++l) {
        const LevelQuality& q = best.quality[l];
        const Codebook::Level& level = best.codebook.levels[l];
        note += printed("codebook of body %zu: %zu vectors, %zu edges, quantization error %.3f Å rms", body,
                        level.size(), level.edges.size(), q.rms_error_m / kAngstromM);
        if (best.restarts > 1)
            note += printed(", best of %u restarts: mean %.3f, standard deviation %.4f", best.restarts,
                            q.rms_error_mean_m / kAngstromM, q.rms_error_sd_m / kAngstromM);
        note += '\n';
    }
}

}  // namespace

double world_per_model_for(double extent_m) {
    constexpr double kNice[] = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
    const double exact = kHandExtentM / extent_m;
    const double power = std::pow(10.0, std::floor(std::log10(exact)));
    double best = power;
    for (const double nice : kNice) {
        if (std::abs(std::log(nice * power / exact)) < std::abs(std::log(best / exact))) best = nice * power;
    }
    return best;
}

BakedDocking bake_docking(const DockingInput& input, SceneWriter& out, const Progress& progress) {
    check_input(input);
    const DensityGrid& grid = input.grid;
    BakedDocking baked;
    SceneMeta& meta = baked.meta;
    std::string& note = baked.note;
    for (const std::string& line : input.note) note += line + '\n';

    report(progress, 0.0, "computing map statistics");
    const MapStatistics statistics = map_statistics(grid);
    const auto say = [&](const std::string& line) { note += line + '\n'; };
    meta.kind = SceneKind::docking;
    meta.body_count = static_cast<std::uint32_t>(input.structures.size());
    meta.map_mean = statistics.mean;
    meta.map_sigma = statistics.sigma;
    meta.map_background = statistics.background;
    set_title(meta, input.title);
    say(printed("map values: %.6g to %.6g, mean %.6g, sigma %.6g (all voxels)", statistics.low,
                statistics.high, statistics.mean, statistics.sigma));
    say(printed("map background: %.6g, median of the box faces; it extends the map beyond the box",
                statistics.background));
    if (input.contour) {
        meta.contour = *input.contour;
        say(printed("contour: %.6g, as given; %.2f sigma above the mean", meta.contour,
                    (meta.contour - statistics.mean) / statistics.sigma));
    } else {
        const ContourChoice choice = choose_contour(grid, statistics);
        meta.contour = choice.level;
        say("contour: " + choice.rule);
    }
    if (!(meta.contour > statistics.low && meta.contour < statistics.high)) {
        throw StartupError("bake a docking scene",
                           printed("the contour %g is outside the map's values, %g to %g", meta.contour,
                                   statistics.low, statistics.high),
                           "give a contour between them, or none");
    }
    meta.resolution_m = input.resolution_m;
    say(printed("resolution: %.4g Å, %s", meta.resolution_m / kAngstromM, input.resolution_source.c_str()));
    const Vec3 extent_m =
        grid.spacing_m.cwiseProduct(Vec3(grid.size[0] - 1.0, grid.size[1] - 1.0, grid.size[2] - 1.0));
    meta.world_per_model = world_per_model_for(extent_m.maxCoeff());
    const Vec3 centre_m = centre_of_density(grid, meta.contour);
    for (int a = 0; a < 3; ++a) meta.centre_model_m[a] = centre_m[a];
    say(printed("world per model: %g, so that the map is %.3g m wide in the workspace of the hand",
                meta.world_per_model, meta.world_per_model * extent_m.maxCoeff()));
    say(printed("centre: (%.4g, %.4g, %.4g) Å, of the density above the contour", centre_m.x() / kAngstromM,
                centre_m.y() / kAngstromM, centre_m.z() / kAngstromM));

    // The gain is measured around the positions of structures, which says nothing of one far from the map.
    std::vector<Structure> felt = input.structures;
    for (std::size_t i = 0; i < felt.size(); ++i) {
        if (!input.outside) check_reach(felt[i], grid);
        if (in_reach(grid, felt[i].home_com_model_m)) continue;
        say(printed("body %zu is %.0f Å outside the map in its file: it starts beside the map", i,
                    outside_m(grid, felt[i].home_com_model_m) / kAngstromM));
        felt[i].home_com_model_m = centre_m;
    }

    // The progress fractions were measured on bakes that take seconds: GroEL, 26 929 atoms, in maps of 100^3 voxels,
    // 2026-11-23; codebooks take 92 %. A short bake ends before a wrong fraction matters.
    TriangleMesh surface = isosurface(grid, meta.contour, part(progress, 0.01, 0.05));
    if (surface.triangles() == 0) {
        throw StartupError("bake a docking scene", printed("no surface lies at the contour %g", meta.contour),
                           "give another contour");
    }
    const std::size_t vertices_found = surface.vertices();
    if (input.vertices_max > 0 && surface.vertices() > input.vertices_max) {
        SimplifySettings settings;
        settings.vertices_min = input.vertices_max;
        surface = simplify(surface, settings, part(progress, 0.05, 0.1)).mesh;
    }
    const ProgressiveMeshData mesh = make_progressive(surface, {}, part(progress, 0.1, 0.2));
    baked.vertices = static_cast<std::uint32_t>(mesh.vertex.size());
    baked.vertices_min = mesh.base_vertices;
    baked.triangles = static_cast<std::uint32_t>(mesh.triangle.size() / 3);
    say(printed("surface: %zu vertices found, %u kept, down to %u; %u triangles", vertices_found,
                baked.vertices, baked.vertices_min, baked.triangles));

    std::vector<Codebook> codebooks;
    const double share = 0.7 / static_cast<double>(input.structures.size());
    for (std::size_t i = 0; i < input.structures.size(); ++i) {
        const double from = 0.2 + share * static_cast<double>(i);
        BestCodebook best = best_codebook(input.structures[i], {}, part(progress, from, from + share));
        say_codebook(i, best, note);
        codebooks.push_back(std::move(best.codebook));
    }
    report(progress, 0.9, "preparing the map");
    const DensityMap map(grid, statistics.background, statistics.sigma);
    const double contour_sigma = (meta.contour - statistics.background) / statistics.sigma;
    for (std::size_t i = 0; i < input.structures.size(); ++i) {
        baked.bodies.push_back(describe(input.structures[i], codebooks[i], map, contour_sigma));
        const BakedBody& body = baked.bodies.back();
        std::string levels;
        for (const std::size_t n : body.codebook) levels += " " + std::to_string(n);
        say(printed("body %zu: ", i) + body.name +
            printed(", %zu atoms, vectors per codebook level:%s", body.atoms,
                    levels.empty() ? " none" : levels.c_str()));
        say(
            printed("body %zu at its position in the file: mean density %.3g sigma above background, %.0f %% "
                    "of its atoms above the contour",
                    i, body.density_home_sigma, 100.0 * body.inside_home));
    }
    DensityGrid force_map_grid;
    if (input.force_map_resolution_m) {
        force_map_grid =
            low_pass(grid, statistics.background, *input.force_map_resolution_m, part(progress, 0.9, 0.92));
        say(
            printed("force map: smoothed with a Gaussian of sigma = 0.225 * %.4g Å; sigma and background "
                    "are those of the original map",
                    *input.force_map_resolution_m / kAngstromM));
    } else {
        say("force map: not smoothed");
    }
    const LevelMaps level_maps = make_level_maps(
        input.force_map_resolution_m ? force_map_grid : grid, statistics.background, statistics.sigma,
        meta.resolution_m, level_smoothings_m(input.structures, codebooks, meta.resolution_m));
    const DockingGain gain =
        docking_gain(level_maps, felt, codebooks, meta.world_per_model, {}, part(progress, 0.92, 0.98));
    meta.energy_j_per_sigma = gain.energy_j_per_sigma;
    say(printed(
        "gain: %.4g J per sigma; force %.3g N (99th percentile near the density), stiffness up to %.3g N/m "
        "and %.3g N m/rad",
        gain.energy_j_per_sigma, gain.force_n_p99, gain.stiffness_n_m_max, gain.torque_n_m_rad_max));

    for (const std::string& line : bake_modes(input.structures, input.modes, out, part(progress, 0.98, 0.99)))
        say(line);
    report(progress, 0.99, "packing the scene");
    write_meta(out, meta, note);
    write_grid(out, grid);
    if (input.force_map_resolution_m) write_grid(out, force_map_grid, kForceMapGrid);
    write_mesh(out, 0, mesh);
    for (std::uint32_t i = 0; i < meta.body_count; ++i) {
        write_structure(out, i, input.structures[i]);
        write_codebook(out, i, codebooks[i]);
    }
    return baked;
}

}  // namespace tact
