// Search for places: rotations, correlation at every position, and the ring of six, whose subunit has six right places.
#include <gtest/gtest.h>

#include <cmath>

#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/search/place_together.hpp"
#include "prep/search/rotation_set.hpp"
#include "prep/search/translation_search.hpp"
#include "prep/synthetic/ring.hpp"
#include "tests/support/error_of.hpp"

namespace tact::prep_search_test {
namespace {

const SyntheticRing& ring() {
    static const SyntheticRing made = make_ring();
    return made;
}

double rmsd_a(const Structure& s, const Pose& a, const Pose& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 at(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                      static_cast<double>(s.z_m[i]));
        sum += ((a.p_m + a.q * at) - (b.p_m + b.q * at)).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(s.size())) / kAngstromM;
}

SearchSettings settings() {
    const MapStatistics statistics = map_statistics(ring().grid);
    return {.resolution_m = ring().resolution_m,
            .background = statistics.background,
            .rotations_max = 1500,
            .threads = 2};
}

TEST(RotationSet, every_rotation_is_within_the_cover_of_one_of_the_set) {
    for (const double cover_rad : {0.5, 0.25}) {
        const std::vector<Quat> set = rotation_set(rotations_for_cover(cover_rad));
        EXPECT_LE(cover_of_rotations_rad(set.size()), cover_rad);
        SeededRandom random(3);
        double worst_rad = 0.0;
        for (int i = 0; i < 3000; ++i) {
            const Quat q = random.rotation();
            double best = 0.0;
            for (const Quat& r : set) best = std::max(best, std::abs(q.dot(r)));
            worst_rad = std::max(worst_rad, 2.0 * std::acos(std::min(best, 1.0)));
        }
        EXPECT_LT(worst_rad, cover_rad);
        EXPECT_GT(worst_rad, 0.6 * cover_rad);  // not more rotations than needed
    }
}

// Against sums over voxels in double precision, at positions all over the box and at its border.
TEST(TranslationSearch,
     the_score_at_a_voxel_is_the_correlation_about_the_mean_in_the_region_of_the_structure) {
    for (const bool laplacian : {false, true}) {
        const SearchMap map =
            search_map(ring().grid, 0.0, ring().resolution_m, ring().resolution_m, laplacian);
        const Structure& s = ring().subunits.front();
        const MapWaves waves(map, s);
        RotationScore score(waves);
        SeededRandom random(4);
        const Quat turn = random.rotation();
        ASSERT_TRUE(score.at(turn));
        Frame frame(s, map);
        ASSERT_TRUE(frame.fill(s, turn, map));
        double deviation = 0.0, mean = 0.0;
        for (const float v : map.grid.values)
            mean += static_cast<double>(v) / static_cast<double>(map.grid.count());
        for (const float v : map.grid.values)
            deviation += std::pow(static_cast<double>(v) - mean, 2.0) / static_cast<double>(map.grid.count());
        for (int k = 0; k < 40; ++k) {
            std::array<std::int64_t, 3> at{};
            for (std::size_t a = 0; a < 3; ++a)
                at[a] = k % 4 == 0 ? (k % 8 == 0 ? 0 : map.grid.size[a] - 1)
                                   : static_cast<std::int64_t>(random.below(map.grid.size[a]));
            double n = 0.0, u = 0.0, v = 0.0, uu = 0.0, vv = 0.0, uv = 0.0;
            std::size_t i = 0;
            for (std::uint32_t z = 0; z < frame.grid.size[2]; ++z)
                for (std::uint32_t y = 0; y < frame.grid.size[1]; ++y)
                    for (std::uint32_t x = 0; x < frame.grid.size[0]; ++x, ++i) {
                        if (!frame.inside(i)) continue;
                        const std::array<std::int64_t, 3> p{at[0] + x - frame.reach, at[1] + y - frame.reach,
                                                            at[2] + z - frame.reach};
                        bool in = true;
                        for (std::size_t a = 0; a < 3; ++a) in = in && p[a] >= 0 && p[a] < map.grid.size[a];
                        const double here =
                            in ? static_cast<double>(map.grid.at(static_cast<std::uint32_t>(p[0]),
                                                                 static_cast<std::uint32_t>(p[1]),
                                                                 static_cast<std::uint32_t>(p[2])))
                               : 0.0;
                        const auto own = static_cast<double>(frame.value()[i]);
                        n += 1.0, u += own, v += here;
                        uu += own * own, vv += here * here, uv += own * here;
                    }
            const double varied = std::max((vv - v * v / n) / n, 0.01 * deviation);
            const double right = (uv - u * v / n) / std::sqrt((uu - u * u / n) * n * varied);
            EXPECT_NEAR(static_cast<double>(score.score(static_cast<std::uint32_t>(at[0]),
                                                        static_cast<std::uint32_t>(at[1]),
                                                        static_cast<std::uint32_t>(at[2]))),
                        right, 2e-4)
                << laplacian << ", " << k;
        }
    }
}

TEST(Search, the_six_places_of_a_subunit_are_the_first_six_hits) {
    const Structure& s = ring().subunits.front();
    const SearchResult found = search(ring().grid, s, settings());
    ASSERT_GE(found.hits.size(), 7U);
    std::vector<bool> seen(6, false);
    for (std::size_t k = 0; k < 6; ++k) {
        const Pose& at = found.hits[k].T_model_body;
        for (std::size_t j = 0; j < 6; ++j) {
            // The subunits are copies, turned about the axis of the ring.
            const Quat turn(
                Eigen::AngleAxisd(static_cast<double>(j) * std::numbers::pi / 3.0, Vec3::UnitZ()));
            if (rmsd_a(s, at, {turn * s.home_com_model_m, turn}) < 1.0) seen[j] = true;
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 6);
    EXPECT_GT(found.hits[5].score, found.hits[6].score + 0.05);
    EXPECT_GT(found.hits[5].z, 4.0);
}

TEST(Search, the_hits_are_the_same_with_any_number_of_threads) {
    SearchSettings one = settings(), three = settings();
    one.rotations_max = three.rotations_max = 500;
    one.threads = 1, three.threads = 3;
    const Structure& s = ring().subunits.front();
    const SearchResult a = search(ring().grid, s, one), b = search(ring().grid, s, three);
    ASSERT_EQ(a.hits.size(), b.hits.size());
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
        EXPECT_EQ(a.hits[i].score, b.hits[i].score);
        EXPECT_EQ(a.hits[i].z, b.hits[i].z);
        EXPECT_EQ(a.hits[i].T_model_body.p_m, b.hits[i].T_model_body.p_m);
    }
}

TEST(Search, progress_can_cancel_and_an_unknown_resolution_is_refused) {
    const Structure& s = ring().subunits.front();
    EXPECT_THROW(
        search(ring().grid, s, settings(), [](double fraction, const char*) { return fraction < 0.1; }),
        Cancelled);
    SearchSettings unknown = settings();
    unknown.resolution_m = 0.0;
    EXPECT_NE(sample::error_of([&] { (void)search(ring().grid, s, unknown); }).find("--resolution-a"),
              std::string::npos);
}

TEST(PlaceTogether, structures_take_right_places_of_the_ring_and_none_twice) {
    std::vector<Structure> three(ring().subunits.begin(), ring().subunits.begin() + 3);
    SearchSettings by = settings();
    by.rotations_max = 500;
    const PlacedTogether placed = place_together(ring().grid, three, by);
    ASSERT_EQ(placed.order.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        double nearest_a = 1e9;
        const Pose& at = placed.found[i].hits.front().T_model_body;
        for (std::size_t j = 0; j < 6; ++j) {
            const Quat turn(
                Eigen::AngleAxisd(static_cast<double>(j) * std::numbers::pi / 3.0, Vec3::UnitZ()));
            nearest_a = std::min(nearest_a, rmsd_a(three[i], at, {turn * three[i].home_com_model_m, turn}));
        }
        EXPECT_LT(nearest_a, 1.0) << i;
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GT((at.p_m - placed.found[k].hits.front().T_model_body.p_m).norm(), 10.0 * kAngstromM);
    }
}

}  // namespace
}  // namespace tact::prep_search_test
