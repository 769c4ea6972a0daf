// Restarts of the codebook: the chosen one, statistics of all, and the levels.
#include "prep/codebook/best_codebook.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace tact::prep_best_codebook_test {
namespace {

constexpr double kA = 1e-10;

Structure ball(std::size_t count, double radius_m, unsigned seed) {
    Structure s;
    s.name = "ball";
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    std::vector<Vec3> at;
    Vec3 mean = Vec3::Zero();
    while (at.size() < count) {
        const Vec3 p(u(random), u(random), u(random));
        if (p.norm() >= 1.0) continue;
        at.emplace_back(radius_m * p);
        mean += at.back() / static_cast<double>(count);
    }
    for (const Vec3& p : at) {
        s.x_m.push_back(static_cast<float>(p.x() - mean.x()));
        s.y_m.push_back(static_cast<float>(p.y() - mean.y()));
        s.z_m.push_back(static_cast<float>(p.z() - mean.z()));
        s.mass_fraction.push_back(1.0F / static_cast<float>(count));
    }
    return s;
}

TEST(BestCodebook, is_the_best_of_the_restarts) {
    const Structure s = ball(3000, 25.0 * kA, 1);
    const BestCodebook best = best_codebook(s);
    ASSERT_EQ(best.restarts, 4U);
    std::vector<Codebook> all;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CodebookSettings settings;
        settings.seed = seed;
        all.push_back(build_codebook(s, settings));
    }
    ASSERT_EQ(best.quality.size(), all[0].levels.size());
    double chosen = 0.0, least = 1e300;
    bool found = false;
    for (const Codebook& c : all) {
        double share = 0.0;
        bool same = true;
        for (std::size_t l = 0; l < c.levels.size(); ++l) {
            share += c.levels[l].rms_error_m / best.quality[l].rms_error_mean_m;
            same = same && c.levels[l].x_m == best.codebook.levels[l].x_m &&
                   c.levels[l].edges == best.codebook.levels[l].edges;
        }
        if (same) chosen = share;
        found = found || same;
        least = std::min(least, share);
    }
    EXPECT_TRUE(found);
    EXPECT_EQ(chosen, least);
    for (std::size_t l = 0; l < best.quality.size(); ++l) {
        double mean = 0.0, variance = 0.0;
        for (const Codebook& c : all) mean += c.levels[l].rms_error_m / 4.0;
        for (const Codebook& c : all) variance += std::pow(c.levels[l].rms_error_m - mean, 2.0) / 3.0;
        EXPECT_NEAR(best.quality[l].rms_error_mean_m, mean, 1e-6 * mean);
        EXPECT_NEAR(best.quality[l].rms_error_sd_m, std::sqrt(variance), 1e-6 * mean);
        EXPECT_EQ(best.quality[l].rms_error_m, best.codebook.levels[l].rms_error_m);
        // Restarts agree: measured spread 0.1 to 0.9 %.
        EXPECT_LT(best.quality[l].rms_error_sd_m, 0.02 * mean);
    }
}

TEST(BestCodebook, repeats_exactly) {
    const Structure s = ball(1500, 20.0 * kA, 2);
    const BestCodebook a = best_codebook(s), b = best_codebook(s);
    for (std::size_t l = 0; l < a.codebook.levels.size(); ++l) {
        EXPECT_EQ(a.codebook.levels[l].x_m, b.codebook.levels[l].x_m);
        EXPECT_EQ(a.quality[l].rms_error_sd_m, b.quality[l].rms_error_sd_m);
    }
}

TEST(BestCodebook, errors_follow_the_theory_of_a_ball_from_ten_to_thousands_of_vectors) {
    // The best partition of space has cells with second moment G N^(-2/3) V^(2/3) per axis, G = 0.0785 (Conway, Sloane).
    // With few cells the surface matters, so the bounds are wider.
    const double radius = 40.0 * kA;
    CodebookSettings settings;
    settings.smallest = 10;
    const Codebook c = build_codebook(ball(12000, radius, 3), settings);
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3.0);
    ASSERT_EQ(c.levels.size(), 10U);
    EXPECT_EQ(c.levels.front().size(), 10U);
    EXPECT_EQ(c.levels.back().size(), 5120U);
    for (std::size_t l = 0; l < 8; ++l) {  // up to 1280: in larger levels each cell holds few atoms
        const auto n = static_cast<double>(c.levels[l].size());
        const double best = std::sqrt(3.0 * 0.0785) * std::cbrt(volume / n);
        EXPECT_GT(c.levels[l].rms_error_m, 0.8 * best) << n;
        EXPECT_LT(c.levels[l].rms_error_m, 1.12 * best) << n;
    }
}

TEST(BestCodebook, small_structures_have_no_levels_and_cancelling_stops_all_restarts) {
    const BestCodebook none = best_codebook(ball(20, 5.0 * kA, 4));
    EXPECT_TRUE(none.codebook.levels.empty());
    EXPECT_TRUE(none.quality.empty());
    int calls = 0;
    EXPECT_THROW(static_cast<void>(best_codebook(ball(3000, 25.0 * kA, 5), {},
                                                 [&](double, const char*) { return ++calls < 3; })),
                 Cancelled);
    EXPECT_EQ(calls, 3);
}

TEST(BestCodebook, large_structures_get_fewer_restarts) {
    EXPECT_EQ(codebook_restarts(100), 4U);
    EXPECT_EQ(codebook_restarts(100'000), 2U);
    EXPECT_EQ(codebook_restarts(1'000'000), 1U);
}

}  // namespace
}  // namespace tact::prep_best_codebook_test
