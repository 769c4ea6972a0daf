// A docking scene of one bent rod, for tests of the docking model.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "rt/force/docking/docking_model.hpp"

namespace tact::rod {

inline constexpr double kA = 1e-10;
inline constexpr double kCentre = 30.0 * kA;

// A bent rod of atoms in a map of Gaussians around its home.
struct Scene {
    SceneMeta meta{};
    DensityGrid grid;
    Structure rod;
    Codebook codebook;
};

inline void add_level(Codebook& codebook, const Structure& s, std::size_t share) {
    Codebook::Level level;
    for (std::size_t i = 0; i < s.size(); i += share) {
        double x = 0, y = 0, z = 0, w = 0;
        for (std::size_t k = i; k < std::min(i + share, s.size()); ++k) {
            const auto m = static_cast<double>(s.mass_fraction[k]);
            x += m * static_cast<double>(s.x_m[k]), y += m * static_cast<double>(s.y_m[k]);
            z += m * static_cast<double>(s.z_m[k]), w += m;
        }
        level.x_m.push_back(static_cast<float>(x / w)), level.y_m.push_back(static_cast<float>(y / w));
        level.z_m.push_back(static_cast<float>(z / w)), level.weight.push_back(static_cast<float>(w));
    }
    codebook.levels.push_back(std::move(level));
}

inline Scene make_scene(std::size_t atoms) {
    Scene scene;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-2.0 * kA, 2.0 * kA), mass(12.0, 16.0);
    std::vector<Vec3> place;
    std::vector<double> m;
    Vec3 com = Vec3::Zero();
    double total = 0.0;
    for (std::size_t i = 0; i < atoms; ++i) {
        const double s = 2.0 * static_cast<double>(i) / static_cast<double>(atoms) - 1.0;
        place.emplace_back(18.0 * kA * s + jitter(random), 9.0 * kA * s * s + jitter(random), jitter(random));
        m.push_back(mass(random));
        com += m.back() * place.back();
        total += m.back();
    }
    com /= total;
    Structure& rod = scene.rod;
    rod.name = "rod";
    rod.mass_u = total;
    rod.home_com_model_m = Vec3::Constant(kCentre);
    for (std::size_t i = 0; i < atoms; ++i) {
        rod.x_m.push_back(static_cast<float>((place[i] - com).x()));
        rod.y_m.push_back(static_cast<float>((place[i] - com).y()));
        rod.z_m.push_back(static_cast<float>((place[i] - com).z()));
        rod.mass_fraction.push_back(static_cast<float>(m[i] / total));
    }
    DensityGrid& grid = scene.grid;
    grid.size = {30, 30, 30};
    grid.spacing_m = Vec3::Constant(2.0 * kA);
    grid.values.assign(grid.count(), 0.0F);
    for (std::uint32_t z = 0; z < 30; ++z) {
        for (std::uint32_t y = 0; y < 30; ++y) {
            for (std::uint32_t x = 0; x < 30; ++x) {
                const Vec3 p = 2.0 * kA * Vec3(x, y, z);
                double v = 0.0;
                for (std::size_t i = 0; i < atoms; i += atoms / 40 + 1) {
                    const Vec3 atom = Vec3::Constant(kCentre) + place[i] - com;
                    v += std::exp(-(p - atom).squaredNorm() / (2.0 * 16.0 * kA * kA));
                }
                grid.values[(std::size_t{z} * 30 + y) * 30 + x] = static_cast<float>(v);
            }
        }
    }
    SceneMeta& meta = scene.meta;
    meta.kind = SceneKind::docking;
    meta.body_count = 1;
    meta.world_per_model = 0.1 / (60.0 * kA);
    for (double& c : meta.centre_model_m) c = kCentre;
    meta.energy_j_per_sigma = 0.02;
    meta.map_sigma = 1.5;
    meta.resolution_m = 8.0 * kA;
    for (const std::size_t share : {40, 20, 10, 4, 2}) add_level(scene.codebook, rod, share);
    return scene;
}

inline const Scene& scene() {
    static const Scene made = make_scene(1000);
    return made;
}

inline std::unique_ptr<DockingModel> make_model(const DockingSettings& settings = {}) {
    const Scene& s = scene();
    return std::make_unique<DockingModel>(s.meta, s.grid, std::vector<Structure>{s.rod},
                                          std::vector<Codebook>{s.codebook}, settings);
}

inline Pose world_pose(double x_m, double y_m, double z_m, const Vec3& turn_rad) {
    return {Vec3(x_m, y_m, z_m), quat_from_rotation_vector(turn_rad)};
}

inline const Pose kGrip = world_pose(0.03, -0.02, 0.05, Vec3(0.2, 0.1, -0.4));
inline const Pose kTouch = world_pose(0.04, -0.025, 0.052, Vec3(0.5, 0.1, -0.3));

inline ToolState tool_at(const Pose& pose, std::uint32_t buttons = 0) {
    ToolState tool;
    tool.T_world_tool = pose;
    tool.buttons = buttons;
    return tool;
}

inline Budget at(float fidelity) {
    Budget budget;
    budget.fidelity = fidelity;
    return budget;
}

}  // namespace tact::rod
