// The whole search in the ring of six: a subunit has six right places there.
#include <gtest/gtest.h>

#include "prep/search/place_together.hpp"
#include "tests/unit/prep_search_fixture.hpp"

namespace tact::prep_search_places_test {
namespace {

using namespace search_test;

TEST(Search, the_six_places_of_a_subunit_are_the_first_six_hits) {
    const Structure& s = ring().subunits.front();
    const SearchResult found = search(ring().grid, s, settings());
    ASSERT_GE(found.hits.size(), 7U);
    std::vector<bool> seen(6, false);
    for (std::size_t k = 0; k < 6; ++k) {
        const Pose& at = found.hits[k].T_model_body;
        for (std::size_t j = 0; j < 6; ++j) {
            if (rmsd_a(s, at, place_in_ring(s, j)) < 1.0) seen[j] = true;
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

TEST(PlaceTogether, structures_take_right_places_of_the_ring_and_none_twice) {
    std::vector<Structure> three(ring().subunits.begin(), ring().subunits.begin() + 3);
    SearchSettings by = settings();
    by.rotations_max = 500;
    const PlacedTogether placed = place_together(ring().grid, three, by);
    ASSERT_EQ(placed.found.size(), 3U);
    EXPECT_GT(placed.correlation, 0.5);
    for (std::size_t i = 0; i < 3; ++i) {
        double nearest_a = 1e9;
        const Pose& at = placed.found[i].hits.front().T_model_body;
        for (std::size_t j = 0; j < 6; ++j) {
            nearest_a = std::min(nearest_a, rmsd_a(three[i], at, place_in_ring(three[i], j)));
        }
        EXPECT_LT(nearest_a, 1.0) << i;
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GT((at.p_m - placed.found[k].hits.front().T_model_body.p_m).norm(), 10.0 * kAngstromM);
    }
}

}  // namespace
}  // namespace tact::prep_search_places_test
