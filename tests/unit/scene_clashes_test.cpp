// Clash counts against the sum over all pairs, and pairs with known results.
#include "ipc/scene/fit/clashes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ipc/base/random.hpp"

namespace tact::scene_clashes_test {
namespace {

constexpr double kA = 1e-10;

Structure cloud(std::size_t atoms, double wide_m, std::uint64_t seed) {
    Structure s;
    s.name = "cloud";
    SeededRandom random(seed);
    const std::array<std::uint8_t, 6> elements{6, 7, 8, 16, 30, 0};
    for (std::size_t i = 0; i < atoms; ++i) {
        s.x_m.push_back(static_cast<float>(wide_m * (random.uniform() - 0.5)));
        s.y_m.push_back(static_cast<float>(wide_m * (random.uniform() - 0.5)));
        s.z_m.push_back(static_cast<float>(wide_m * (random.uniform() - 0.5)));
        s.element.push_back(elements[random.below(elements.size())]);
    }
    return s;
}

Structure one_atom(std::uint8_t element) {
    Structure s;
    s.x_m = s.y_m = s.z_m = {0.0F};
    s.element = {element};
    return s;
}

ClashCounts by_all_pairs(std::span<const PlacedStructure> placed) {
    ClashCounts counts;
    counts.pairs_of.resize(placed.size());
    counts.atoms_of.resize(placed.size());
    const auto place = [&](std::size_t k, std::size_t i) {
        const Structure& s = *placed[k].structure;
        return Vec3(placed[k].T_model_body * Vec3(static_cast<double>(s.x_m[i]),
                                                  static_cast<double>(s.y_m[i]),
                                                  static_cast<double>(s.z_m[i])));
    };
    const auto polar = [](std::uint8_t e) { return e == 7 || e == 8 || e == 16; };
    for (std::size_t a = 0; a < placed.size(); ++a) {
        for (std::size_t i = 0; i < placed[a].structure->size(); ++i) {
            bool clashes = false;
            for (std::size_t b = 0; b < placed.size(); ++b) {
                for (std::size_t j = 0; b != a && j < placed[b].structure->size(); ++j) {
                    const std::uint8_t ei = placed[a].structure->element[i],
                                       ej = placed[b].structure->element[j];
                    const double overlap = van_der_waals_radius_m(ei) + van_der_waals_radius_m(ej) -
                                           (place(a, i) - place(b, j)).norm() -
                                           (polar(ei) && polar(ej) ? 0.4 * kA : 0.0);
                    if (!(overlap >= 0.6 * kA)) continue;
                    clashes = true;
                    ++counts.pairs_of[a];
                    if (a < b) ++counts.pairs;
                }
            }
            if (clashes) ++counts.atoms_of[a];
        }
    }
    return counts;
}

TEST(Clashes, match_the_sum_over_all_pairs) {
    SeededRandom random(5);
    const std::array<Structure, 3> s{cloud(300, 30.0 * kA, 1), cloud(700, 40.0 * kA, 2),
                                     cloud(50, 10.0 * kA, 3)};
    std::uint64_t most = 0;
    for (int k = 0; k < 20; ++k) {
        std::vector<PlacedStructure> placed;
        for (const Structure& one : s) {
            placed.push_back({&one, {random.within(25.0 * kA), random.rotation()}});
        }
        const ClashCounts fast = count_clashes(placed), slow = by_all_pairs(placed);
        EXPECT_EQ(fast.pairs, slow.pairs);
        EXPECT_EQ(fast.pairs_of, slow.pairs_of);
        EXPECT_EQ(fast.atoms_of, slow.atoms_of);
        most = std::max(most, fast.pairs);
    }
    EXPECT_GT(most, 100U);
}

TEST(Clashes, begin_at_an_overlap_of_six_tenths_of_an_angstrom) {
    const Structure carbon = one_atom(6), oxygen = one_atom(8), nitrogen = one_atom(7), unknown = one_atom(0);
    const auto clashes = [](const Structure& a, const Structure& b, double apart_a) {
        const PlacedStructure placed[] = {{&a, Pose{}},
                                          {&b, {apart_a * kA * Vec3::UnitY(), Quat::Identity()}}};
        return count_clashes(placed).pairs == 1;
    };
    EXPECT_TRUE(clashes(carbon, carbon, 2.79));
    EXPECT_FALSE(clashes(carbon, carbon, 2.81));
    EXPECT_TRUE(clashes(carbon, oxygen, 2.61));
    EXPECT_FALSE(clashes(carbon, oxygen, 2.63));
    // A hydrogen bond is not a clash.
    EXPECT_FALSE(clashes(nitrogen, oxygen, 2.7));
    EXPECT_TRUE(clashes(nitrogen, oxygen, 2.06));
    EXPECT_FALSE(clashes(nitrogen, oxygen, 2.08));
    EXPECT_TRUE(clashes(unknown, carbon, 2.79));
}

TEST(Clashes, non_finite_positions_clash_with_nothing) {
    Structure broken = cloud(100, 20.0 * kA, 1);
    const Structure good = cloud(100, 20.0 * kA, 2);
    const PlacedStructure whole[] = {{&broken, Pose{}}, {&good, Pose{}}};
    EXPECT_GT(count_clashes(whole).pairs, 0U);
    for (float& v : broken.x_m) v = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(count_clashes(whole).pairs, 0U);
    const PlacedStructure nowhere[] = {
        {&good, {Vec3::Constant(std::numeric_limits<double>::infinity()), Quat::Identity()}},
        {&good, Pose{}}};
    EXPECT_EQ(count_clashes(nowhere).pairs, 0U);
    EXPECT_EQ(count_clashes({}).pairs, 0U);
    EXPECT_EQ(count_clashes({whole, 1}).pairs, 0U);
}

}  // namespace
}  // namespace tact::scene_clashes_test
