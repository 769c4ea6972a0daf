// A docking scene small enough to be created in every test: a helix of atoms and the density around it.
#pragma once

#include <cmath>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

inline SceneWriter small_scene(std::size_t atoms = 240) {
    constexpr double kA = 1e-10;
    constexpr std::uint32_t kSize = 28;
    constexpr double kSpacing = 2.0 * kA;
    const Vec3 centre = Vec3::Constant(kSpacing * (kSize - 1) / 2.0);

    Structure s;
    s.name = "helix";
    s.home_com_model_m = centre;
    s.mass_u = 14.0 * static_cast<double>(atoms);
    s.chain_names = {"A"};
    Vec3 com = Vec3::Zero();
    std::vector<Vec3> place;
    for (std::size_t i = 0; i < atoms; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(atoms);
        place.emplace_back(9.0 * kA * std::cos(9.0 * t), 6.0 * kA * std::sin(9.0 * t), 28.0 * kA * (t - 0.5));
        com += place.back() / static_cast<double>(atoms);
    }
    Codebook book;
    book.levels.resize(1);
    Codebook::Level& level = book.levels[0];
    for (std::size_t i = 0; i < atoms; ++i) {
        const Vec3 p = place[i] - com;
        s.x_m.push_back(static_cast<float>(p.x()));
        s.y_m.push_back(static_cast<float>(p.y()));
        s.z_m.push_back(static_cast<float>(p.z()));
        s.mass_fraction.push_back(1.0F / static_cast<float>(atoms));
        s.element.push_back(6);
        s.chain.push_back(0);
        s.residue.push_back(static_cast<std::int32_t>(i));
        s.trace.push_back(i % 4 == 0 ? 1 : 0);
        if (i % 8 != 4) continue;
        level.x_m.push_back(s.x_m.back());
        level.y_m.push_back(s.y_m.back());
        level.z_m.push_back(s.z_m.back());
    }
    level.weight.assign(level.x_m.size(), 1.0F / static_cast<float>(level.x_m.size()));

    DensityGrid grid;
    grid.size = {kSize, kSize, kSize};
    grid.spacing_m = Vec3::Constant(kSpacing);
    double sum = 0.0, squares = 0.0;
    for (std::uint32_t z = 0; z < kSize; ++z) {
        for (std::uint32_t y = 0; y < kSize; ++y) {
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const Vec3 p = kSpacing * Vec3(x, y, z) - centre + com;
                double v = 0.0;
                for (std::size_t i = 0; i < atoms; i += 8) {
                    v += std::exp(-(p - place[i]).squaredNorm() / (2.0 * 25.0 * kA * kA));
                }
                grid.values.push_back(static_cast<float>(v));
                sum += v;
                squares += v * v;
            }
        }
    }
    const auto count = static_cast<double>(grid.values.size());
    SceneMeta meta{};
    meta.kind = SceneKind::docking;
    meta.body_count = 1;
    meta.world_per_model = 0.1 / (kSpacing * kSize);
    for (int i = 0; i < 3; ++i) meta.centre_model_m[i] = centre[i];
    meta.energy_j_per_sigma = 0.02;
    meta.resolution_m = 4.0 * kSpacing;
    meta.map_mean = sum / count;
    meta.map_sigma = std::sqrt(squares / count - meta.map_mean * meta.map_mean);
    meta.contour = meta.map_mean + meta.map_sigma;

    SceneWriter out;
    write_meta(out, meta, "source: small_scene");
    write_grid(out, grid);
    write_structure(out, 0, s);
    write_codebook(out, 0, book);
    return out;
}

}  // namespace tact
