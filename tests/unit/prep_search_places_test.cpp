// The whole search in the ring of six: a subunit has six right places there.
#include <gtest/gtest.h>

#include "ipc/base/error.hpp"
#include "ipc/scene/fit/fit_metrics.hpp"
#include "prep/search/place_scorer.hpp"
#include "prep/search/place_symmetric.hpp"
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

// The ring is C6; that is found among symmetries whose copies would be too few, too many or nowhere.
TEST(PlaceSymmetric, six_copies_of_a_subunit_are_placed_about_the_axis_of_the_ring) {
    const Structure& s = ring().subunits.front();
    SearchSettings by = settings();
    by.rotations_max = 500;
    const std::vector<Symmetry> any{symmetry_of("C2"), symmetry_of("C5"), symmetry_of("C6"),
                                    symmetry_of("C12"), symmetry_of("D3")};
    const PlacedSymmetric placed = place_symmetric(ring().grid, s, any, by);
    EXPECT_EQ(placed.symmetry.name(), "C6");
    ASSERT_EQ(placed.found.hits.size(), 6U);
    std::vector<bool> seen(6, false);
    for (const SearchHit& hit : placed.found.hits)
        for (std::size_t j = 0; j < 6; ++j)
            if (rmsd_a(s, hit.T_model_body, place_in_ring(s, j)) < 1.0) seen[j] = true;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 6);
    const Vec3 axis = placed.place.T_model_frame.q * Vec3::UnitZ();
    EXPECT_GT(std::abs(axis.z()), std::cos(0.5 * kDegreeRad));
    EXPECT_LT(placed.place.T_model_frame.p_m.head<2>().norm(), 0.5 * kAngstromM);
    EXPECT_LT(placed.free_difference_m, 1.0 * kAngstromM);
    EXPECT_THROW(place_symmetric(ring().grid, s, {symmetry_of("helix:400,10,3")}, by), StartupError);
}

// Copies by two-fold axes and along a helix, in maps simulated from known places.
TEST(PlaceSymmetric, copies_of_a_dihedral_and_of_a_helix_are_found) {
    const Structure& s = ring().subunits.front();
    SearchSettings by = settings();
    by.rotations_max = 500;
    by.background = 0.0;
    SeededRandom random(12);
    for (const char* name : {"D2", "helix:45,60,4"}) {
        const Symmetry symmetry = symmetry_of(name);
        DensityGrid grid = ring().grid;
        Vec3 middle = grid.origin_m;
        for (int axis = 0; axis < 3; ++axis)
            middle[axis] += 0.5 * grid.spacing_m[axis] * grid.size[static_cast<std::size_t>(axis)];
        SymmetricPlace right{{middle, random.rotation()}, {}};
        const Vec3 first_m = symmetry.kind == Symmetry::Kind::dihedral ? Vec3(25e-10, 25e-10, 28e-10)
                                                                       : Vec3(30e-10, 0.0, -67e-10);
        right.T_model_first = right.T_model_frame * Pose{first_m, random.rotation()};
        std::vector<PlacedStructure> copies;
        for (std::size_t k = 0; k < symmetry.copies(); ++k)
            copies.push_back({&s, pose_of_copy(symmetry, right, k)});
        grid.values = simulated_map(grid, copies, by.resolution_m);
        const PlacedSymmetric placed = place_symmetric(grid, s, {symmetry}, by);
        ASSERT_EQ(placed.found.hits.size(), 4U) << name;
        for (const PlacedStructure& copy : copies) {
            double nearest_a = 1e9;
            for (const SearchHit& hit : placed.found.hits)
                nearest_a = std::min(nearest_a, rmsd_a(s, hit.T_model_body, copy.T_model_body));
            EXPECT_LT(nearest_a, 1.0) << name;
        }
        EXPECT_GT(placed.correlation, 0.95) << name;
    }
}

// From 8 A and 25 degrees away; the plain ascent from there ends elsewhere or lower.
TEST(Search, near_a_place_the_best_place_within_the_limits_is_found_and_never_a_worse_one) {
    const Structure& s = ring().subunits.front();
    SeededRandom random(8);
    for (int k = 0; k < 3; ++k) {
        SearchSettings by = settings();
        Pose start = s.home();
        start.p_m += 8.0 * kAngstromM * random.direction();
        start.q = quat_from_rotation_vector(25.0 * kDegreeRad * random.direction());
        by.near = SearchNear{start, 10.0 * kAngstromM, 30.0 * kDegreeRad};
        const SearchHit best = search(ring().grid, s, by).hits.at(0);
        EXPECT_LT(rmsd_a(s, best.T_model_body, s.home()), 1.0) << k;
        EXPECT_GE(best.score, place_score(ring().grid, s, by, start));
        EXPECT_NEAR(best.score, place_score(ring().grid, s, by, best.T_model_body), 1e-6);
        by.near = SearchNear{s.home(), 1.0 * kAngstromM, 1.0 * kDegreeRad};
        EXPECT_LT(rmsd_a(s, search(ring().grid, s, by).hits.at(0).T_model_body, s.home()), 1.0);
    }
}

// At a coarser resolution of the search, its optimum may be worse than a start that is already good.
TEST(Search, a_search_nearby_at_a_coarser_resolution_gives_nothing_worse_than_the_start) {
    const Structure& s = ring().subunits.front();
    SeededRandom random(9);
    SearchSettings by = settings();
    by.resolution_m = 0.5 * ring().resolution_m;  // searched twice as coarsely
    by.rotations_max = 500;
    for (int k = 0; k < 8; ++k) {
        Pose start = s.home();
        start.p_m += 15.0 * kAngstromM * random.direction();
        start.q = random.rotation();
        by.near = SearchNear{start, 0.5 * kAngstromM, 0.5 * kDegreeRad};
        EXPECT_GE(search(ring().grid, s, by).hits.at(0).score, place_score(ring().grid, s, by, start) - 1e-9)
            << k;
    }
}

// Against places drawn here and correlated by the metrics of a fit, which share no code with the search.
TEST(Search, the_right_place_stands_out_from_random_ones_scored_elsewhere_alike) {
    const Structure& s = ring().subunits.front();
    SearchSettings by = settings();
    by.laplacian = false;
    // A long subunit alone: its right orientation is better than others anywhere, so that all must be drawn.
    DensityGrid grid = ring().grid;
    const PlacedStructure alone{&s, s.home()};
    grid.values = simulated_map(grid, {&alone, 1}, by.resolution_m);
    const PlaceScorer scorer(grid, s, by, by.resolution_m);
    const RandomScores found = scorer.random_scores(200);
    EXPECT_EQ(found.places, 200U);
    const auto [mean, sigma] = [&] {
        double sum = 0.0, sum_2 = 0.0;
        for (const float v : grid.values)
            sum += static_cast<double>(v), sum_2 += std::pow(static_cast<double>(v), 2);
        const auto n = static_cast<double>(grid.values.size());
        return std::pair{sum / n, std::sqrt(sum_2 / n - sum * sum / (n * n))};
    }();
    SeededRandom random(77);
    double sum = 0.0, sum_2 = 0.0;
    int n = 0;
    while (n < 150) {
        const auto i = static_cast<std::size_t>(random.uniform() * static_cast<double>(grid.values.size()));
        if (static_cast<double>(grid.values[i]) < mean + sigma) continue;
        const std::size_t x = i % grid.size[0], y = i / grid.size[0] % grid.size[1],
                          z = i / grid.size[0] / grid.size[1];
        const Vec3 at = Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        const PlacedStructure placed{&s,
                                     {grid.origin_m + grid.spacing_m.cwiseProduct(at), random.rotation()}};
        const double cc = fit_metrics(grid, {&placed, 1}, {by.resolution_m, 1.0, by.background, 1.0}).cc_mean;
        sum += cc, sum_2 += cc * cc, ++n;
    }
    const double own_mean = sum / n, own_deviation = std::sqrt(sum_2 / n - own_mean * own_mean);
    EXPECT_NEAR(found.mean, own_mean, 0.07);
    EXPECT_NEAR(found.deviation / own_deviation, 1.0, 0.3);
    EXPECT_GT(found.z_of(scorer.score(s.home())), 3.0);
    EXPECT_LT(found.best, scorer.score(s.home()));
}

}  // namespace
}  // namespace tact::prep_search_places_test
