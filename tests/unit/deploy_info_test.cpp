// What `tact info --json` says is enough to compute the force of every level elsewhere: by the independent spline of tests/reference in
// a map that is smoothed here by the definition of the discrete Gaussian.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "deploy/tact/docking/docking.hpp"
#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "tests/reference/docking_reference.hpp"
#include "tests/unit/force_rod_scene.hpp"

namespace tact::launch::deploy_info_test {
namespace {

using nlohmann::json;

std::vector<std::byte> rod_scene() {
    const rod::Scene& s = rod::scene();
    Structure body = s.rod;
    body.element.assign(body.size(), 6);
    body.chain.assign(body.size(), 0);
    body.trace.assign(body.size(), 0);
    for (std::size_t i = 0; i < body.size(); ++i) body.residue.push_back(static_cast<std::int32_t>(i + 1));
    body.chain_names = {"A"};
    SceneWriter out;
    write_meta(out, s.meta, "made by: a test");
    write_grid(out, s.grid);
    write_structure(out, 0, body);
    write_codebook(out, 0, s.codebook);
    return out.to_bytes();
}

// exp(-t) I_n(t), the kernel of variance t: by its power series, which converges for any t.
double kernel(int n, double t) {
    double term = 1.0, sum = 0.0;
    for (int k = 1; k <= n; ++k) term *= 0.5 * t / k;
    for (int m = 0; m < 200; ++m) {
        sum += term;
        term *= 0.25 * t * t / ((m + 1.0) * (m + 1.0 + n));
    }
    return std::exp(-t) * sum;
}

// The values of the map less its background, with a border of zeros into which they spread.
reference::Grid smoothed(const json& map, const DensityGrid& grid, double smoothing_a) {
    const double voxel_a = map["spacing_a"][0];
    const int n = static_cast<int>(grid.size[0]),
              border = static_cast<int>(std::ceil(6.0 * smoothing_a / voxel_a));
    const int wide = n + 2 * border;
    const auto at = [&](int x, int y, int z) {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(wide) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(wide) +
               static_cast<std::size_t>(x);
    };
    std::vector<double> values(at(0, 0, wide), 0.0);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                values[at(x + border, y + border, z + border)] =
                    static_cast<double>(grid.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                                static_cast<std::uint32_t>(z))) -
                    map["background"].get<double>();
    const double t = std::pow(smoothing_a / voxel_a, 2);
    for (int axis = 0; axis < 3 && smoothing_a > 0.0; ++axis) {
        std::vector<double> next(values.size(), 0.0);
        for (int z = 0; z < wide; ++z)
            for (int y = 0; y < wide; ++y)
                for (int x = 0; x < wide; ++x)
                    for (int k = -border; k <= border; ++k) {
                        std::array<int, 3> from{x, y, z};
                        int& moved = from[static_cast<std::size_t>(axis)];
                        moved += k;
                        if (moved < 0 || moved >= wide) continue;
                        next[at(x, y, z)] += kernel(std::abs(k), t) * values[at(from[0], from[1], from[2])];
                    }
        values = next;
    }
    reference::Grid out;
    out.size = {wide, wide, wide};
    for (int a = 0; a < 3; ++a) {
        out.spacing_m[a] = map["spacing_a"][a].get<double>() * kAngstromM;
        out.origin_m[a] = map["origin_a"][a].get<double>() * kAngstromM - border * out.spacing_m[a];
    }
    out.values = values;
    out.sigma = map["sigma"];
    return out;
}

TEST(DockingInfo, is_enough_to_compute_the_force_of_every_level) {
    const std::vector<std::byte> bytes = rod_scene();
    const SceneFile file = SceneFile::from_bytes(bytes, "rod");
    const json info = json::parse(docking_info(file).dump());
    const auto model = load_docking_model(file, {});
    const json& body = info["bodies"][0];
    json levels = body["codebook"];
    levels.push_back({{"fidelity", 1.0}, {"map_smoothing_a", 0.0}, {"points", body["atom_points"]}});
    ASSERT_EQ(levels.size(), 6U);
    EXPECT_GT(levels[0]["map_smoothing_a"].get<double>(), 0.5) << "otherwise the smoothing is not tested";
    const DensityGrid grid = read_grid(file);
    for (const json& level : levels) {
        reference::Atoms atoms;
        double weight = 0.0;
        for (const json& p : level["points"]) {
            atoms.at_m.emplace_back(p[0], p[1], p[2]);
            atoms.weight.push_back(p[3]);
            weight += atoms.weight.back();
        }
        EXPECT_NEAR(weight, 1.0, 1e-5);
        const reference::Spline spline(smoothed(info["map"], grid, level["map_smoothing_a"]));
        Budget budget;
        budget.fidelity = level["fidelity"];
        SeededRandom random(5);
        double off_2 = 0.0, all_2 = 0.0;
        for (int k = 0; k < 10; ++k) {
            const Pose pose{rod::scene().rod.home_com_model_m + 5e-10 * random.uniform() * random.direction(),
                            quat_from_rotation_vector(0.4 * random.direction())};
            const reference::Sums sums = sum(spline, atoms, {pose.p_m, pose.q});
            const Vec3 expected_n = info["energy_j_per_sigma"].get<double>() /
                                    info["world_per_model"].get<double>() * sums.gradient;
            const StepResult r = model->evaluate(pose, budget);
            EXPECT_EQ(r.load.items, level["points"].size());
            off_2 += (r.wrench_world.force_n - expected_n).squaredNorm();
            all_2 += expected_n.squaredNorm();
        }
        // The product sums a smoothed map on fewer voxels.
        EXPECT_LT(std::sqrt(off_2 / all_2), 0.02) << level["fidelity"];
    }
}

}  // namespace
}  // namespace tact::launch::deploy_info_test
