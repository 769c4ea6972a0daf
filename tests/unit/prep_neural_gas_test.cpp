// The codebook against the theory of quantising lines, balls and rings.
#include "prep/codebook/neural_gas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "ipc/base/error.hpp"
#include "ipc/scene/density/vector_grid.hpp"

namespace tact::prep_neural_gas_test {
namespace {

constexpr double kA = 1e-10;

Structure structure(const std::vector<Vec3>& at, const std::vector<double>& mass = {}) {
    Structure s;
    s.name = "test";
    Vec3 com = Vec3::Zero();
    double total = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double m = mass.empty() ? 1.0 : mass[i];
        com += m * at[i];
        total += m;
    }
    com /= total;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3 p = at[i] - com;
        s.x_m.push_back(static_cast<float>(p.x()));
        s.y_m.push_back(static_cast<float>(p.y()));
        s.z_m.push_back(static_cast<float>(p.z()));
        s.mass_fraction.push_back(static_cast<float>((mass.empty() ? 1.0 : mass[i]) / total));
    }
    return s;
}

std::vector<Vec3> line(std::size_t count, double length_m) {
    std::vector<Vec3> at;
    for (std::size_t i = 0; i < count; ++i) {
        at.emplace_back(length_m * (static_cast<double>(i) + 0.5) / static_cast<double>(count), 0.0, 0.0);
    }
    return at;
}

std::vector<Vec3> ball(std::size_t count, double radius_m, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    std::vector<Vec3> at;
    while (at.size() < count) {
        const Vec3 p(u(random), u(random), u(random));
        if (p.norm() < 1.0) at.push_back(radius_m * p);
    }
    return at;
}

TEST(NeuralGas, error_on_a_uniform_line_matches_equal_pieces) {
    // N pieces of length L / N: the rms distance to the centre is L / (N sqrt(12)), the minimum.
    const double length = 500.0 * kA;
    const Codebook codebook = build_codebook(structure(line(8000, length)));
    ASSERT_GE(codebook.levels.size(), 4U);
    for (std::size_t l = 0; l < 4; ++l) {  // 25 to 200: pieces of 40 atoms or more
        const double best = length / (static_cast<double>(codebook.levels[l].size()) * std::sqrt(12.0));
        EXPECT_GT(codebook.levels[l].rms_error_m, 0.999 * best);
        EXPECT_LT(codebook.levels[l].rms_error_m, 1.15 * best) << "level " << l;
    }
}

TEST(NeuralGas, error_in_a_ball_falls_with_the_cube_root_of_the_vectors) {
    // The best partition of space has cells with second moment G N^(-2/3) V^(2/3) per axis, G = 0.0785 (Conway, Sloane).
    const double radius = 40.0 * kA;
    const Codebook codebook = build_codebook(structure(ball(12000, radius, 1)));
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3.0);
    for (std::size_t l = 1; l < 5; ++l) {  // 50 to 400: enough cells, and enough atoms per cell
        const auto n = static_cast<double>(codebook.levels[l].size());
        const double best = std::sqrt(3.0 * 0.0785) * std::cbrt(volume / n);
        EXPECT_GT(codebook.levels[l].rms_error_m, 0.85 * best) << n;
        EXPECT_LT(codebook.levels[l].rms_error_m, 1.10 * best) << n;
    }
}

TEST(NeuralGas, levels_double_up_to_half_the_atoms_and_errors_fall) {
    const Codebook codebook = build_codebook(structure(ball(1000, 20.0 * kA, 2)));
    ASSERT_EQ(codebook.levels.size(), 5U);
    for (std::size_t l = 0; l < 5; ++l) {
        EXPECT_EQ(codebook.levels[l].size(), std::size_t{25} << l);
        if (l > 0) {
            EXPECT_LT(codebook.levels[l].rms_error_m, codebook.levels[l - 1].rms_error_m);
        }
    }
    EXPECT_TRUE(build_codebook(structure(ball(49, 20.0 * kA, 2))).levels.empty());
    EXPECT_EQ(build_codebook(structure(ball(50, 20.0 * kA, 2))).levels.size(), 1U);
}

TEST(NeuralGas, keeps_mass_and_centre_of_mass_at_every_level) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(1.0, 32.0);
    std::vector<double> mass(3000);
    for (double& m : mass) m = uniform(random);
    const Codebook codebook = build_codebook(structure(ball(3000, 30.0 * kA, 3), mass));
    for (const Codebook::Level& level : codebook.levels) {
        double total = 0.0;
        Vec3 com = Vec3::Zero();
        for (std::size_t i = 0; i < level.size(); ++i) {
            const auto w = static_cast<double>(level.weight[i]);
            EXPECT_GT(w, 0.0);
            total += w;
            com += w * Vec3(static_cast<double>(level.x_m[i]), static_cast<double>(level.y_m[i]),
                            static_cast<double>(level.z_m[i]));
        }
        EXPECT_NEAR(total, 1.0, 1e-5);
        EXPECT_LT(com.norm(), 1e-4 * kA);
    }
}

TEST(NeuralGas, heavy_parts_get_more_vectors) {
    std::vector<Vec3> at = line(4000, 100.0 * kA);
    std::vector<double> mass;
    for (std::size_t i = 0; i < at.size(); ++i) mass.push_back(i < 2000 ? 8.0 : 1.0);
    const Codebook codebook = build_codebook(structure(at, mass));
    const Codebook::Level& level = codebook.levels[0];  // trained longest, from scratch
    // Border in the body frame: the centre of mass is at 50 - 25 * 7/9 A.
    const double border = (50.0 - (25.0 * 8.0 + 75.0) / 9.0) * kA;
    const auto heavy = std::count_if(level.x_m.begin(), level.x_m.end(),
                                     [&](float x) { return static_cast<double>(x) < border; });
    // In one dimension the density of vectors is proportional to mass density to the power 1/3: 2 to 1.
    EXPECT_NEAR(static_cast<double>(heavy) / static_cast<double>(level.size()), 2.0 / 3.0, 0.1);
}

TEST(NeuralGas, graph_of_a_ring_is_the_ring) {
    std::vector<Vec3> at;
    for (int i = 0; i < 6000; ++i) {
        const double a = 2.0 * std::numbers::pi * i / 6000.0;
        at.emplace_back(60.0 * kA * std::cos(a), 60.0 * kA * std::sin(a), 0.0);
    }
    const Codebook codebook = build_codebook(structure(at));
    for (std::size_t l = 0; l < 4; ++l) {
        const Codebook::Level& level = codebook.levels[l];
        std::vector<std::uint32_t> by_angle(level.size());
        for (std::uint32_t i = 0; i < by_angle.size(); ++i) by_angle[i] = i;
        std::sort(by_angle.begin(), by_angle.end(), [&](auto a, auto b) {
            return std::atan2(level.y_m[a], level.x_m[a]) < std::atan2(level.y_m[b], level.x_m[b]);
        });
        std::vector<std::array<std::uint32_t, 2>> ring;
        for (std::size_t i = 0; i < by_angle.size(); ++i) {
            const std::uint32_t a = by_angle[i], b = by_angle[(i + 1) % by_angle.size()];
            ring.push_back({std::min(a, b), std::max(a, b)});
        }
        std::sort(ring.begin(), ring.end());
        auto edges = level.edges;
        std::sort(edges.begin(), edges.end());
        EXPECT_EQ(edges, ring) << "level " << l;
    }
}

TEST(NeuralGas, two_separate_bodies_are_not_joined) {
    std::vector<Vec3> at = ball(3000, 15.0 * kA, 4);
    for (std::size_t i = 0; i < 3000; ++i) at.push_back(at[i] + Vec3(80.0 * kA, 0.0, 0.0));
    const Codebook codebook = build_codebook(structure(at));
    for (const Codebook::Level& level : codebook.levels) {
        EXPECT_FALSE(level.edges.empty());
        for (const auto& edge : level.edges) EXPECT_EQ(level.x_m[edge[0]] < 0.0F, level.x_m[edge[1]] < 0.0F);
    }
}

TEST(NeuralGas, repeats_exactly_for_a_seed_and_differs_for_another) {
    const Structure s = structure(ball(2000, 25.0 * kA, 5));
    CodebookSettings settings;
    const Codebook a = build_codebook(s, settings), b = build_codebook(s, settings);
    settings.seed = 2;
    const Codebook c = build_codebook(s, settings);
    for (std::size_t l = 0; l < a.levels.size(); ++l) {
        EXPECT_EQ(a.levels[l].x_m, b.levels[l].x_m);
        EXPECT_EQ(a.levels[l].weight, b.levels[l].weight);
        EXPECT_EQ(a.levels[l].edges, b.levels[l].edges);
        EXPECT_NE(a.levels[l].x_m, c.levels[l].x_m);
    }
}

TEST(NeuralGas, coinciding_and_massless_atoms_are_handled) {
    std::vector<Vec3> at(200, Vec3(1e-9, 2e-9, 3e-9));
    const Codebook same = build_codebook(structure(at));
    ASSERT_EQ(same.levels.size(), 3U);
    EXPECT_NEAR(same.levels[0].rms_error_m, 0.0, 1e-15);
    std::vector<double> mass(200, 0.0);
    for (std::size_t i = 0; i < 200; i += 50) mass[i] = 1.0;
    const Codebook few = build_codebook(structure(ball(200, 10.0 * kA, 6), mass));
    for (const auto& level : few.levels) {
        for (std::size_t i = 0; i < level.size(); ++i)
            EXPECT_TRUE(std::isfinite(level.x_m[i] + level.weight[i]));
    }
}

TEST(NeuralGas, refuses_non_finite_atoms_and_stops_on_request) {
    Structure s = structure(ball(200, 10.0 * kA, 7));
    EXPECT_THROW(build_codebook(s, {}, [](double, const char*) { return false; }), Cancelled);
    s.y_m[7] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(build_codebook(s), StartupError);
}

TEST(VectorGrid, matches_a_slow_search_while_vectors_move) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> u(-1.0, 1.0), wide(-1.6, 1.6);
    std::vector<Vec3> vectors;
    for (int i = 0; i < 300; ++i) vectors.emplace_back(u(random), 0.3 * u(random), u(random));
    VectorGrid grid(vectors, Vec3(-1.0, -0.3, -1.0), Vec3(1.0, 0.3, 1.0));
    for (int trial = 0; trial < 300; ++trial) {
        const auto moved = static_cast<std::uint32_t>(trial);
        vectors[moved] = Vec3(wide(random), u(random), wide(random));
        grid.move(moved, vectors[moved]);
        const Vec3 p(wide(random), wide(random), wide(random));
        std::array<VectorGrid::Near, 5> near{};
        ASSERT_EQ(grid.nearest(p, near), 5U);
        std::vector<double> slow;
        for (const Vec3& v : vectors) slow.push_back((v - p).squaredNorm());
        std::sort(slow.begin(), slow.end());
        for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(near[k].distance_2, slow[k]);
    }
}

}  // namespace
}  // namespace tact::prep_neural_gas_test
