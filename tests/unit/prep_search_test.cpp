// Parts of the search for places: orientations, the score at every position, a search nearby, and the report.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "prep/docking/bake_docking.hpp"
#include "prep/search/fit_input.hpp"
#include "prep/search/place_together.hpp"
#include "prep/search/rotation_set.hpp"
#include "prep/search/search_report.hpp"
#include "prep/search/translation_search.hpp"
#include "tests/support/error_of.hpp"
#include "tests/unit/prep_samples.hpp"
#include "tests/unit/prep_search_fixture.hpp"

namespace tact::prep_search_test {
namespace {

using namespace search_test;

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

// In any orientation, the five other places of the ring fit as well.
TEST(Search, near_a_place_only_positions_within_the_limit_are_searched) {
    const Structure& s = ring().subunits.front();
    SearchSettings by = settings();
    by.rotations_max = 500;
    by.near = SearchNear{s.home(), 5.0 * kAngstromM, std::numbers::pi};
    const double apart_m = (place_in_ring(s, 1).p_m - s.home().p_m).norm();
    for (const SearchHit& hit : search(ring().grid, s, by).hits)
        EXPECT_LT((hit.T_model_body.p_m - s.home().p_m).norm(), 0.6 * apart_m);
}

TEST(FitInput, a_map_without_a_resolution_is_refused_with_a_range_from_its_voxels) {
    const std::filesystem::path map =
        std::filesystem::temp_directory_path() / ("tact-fit-" + std::to_string(::getpid()) + ".mrc");
    const std::vector<char> bytes = sample::Mrc{}.bytes();  // voxels of 2, 3 and 4 angstrom
    std::ofstream(map, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    const std::string error = sample::error_of([&] {
        FitInput input;
        input.map.path = map.string();
        input.models = {"none.pdb"};
        (void)read_fit_input(input);
    });
    std::filesystem::remove(map);
    EXPECT_NE(error.find("--resolution-a A; with voxels of 4.00 Å it is probably between 8.0 and 20.0"),
              std::string::npos)
        << error;
}

TEST(PlaceTogether, a_structure_without_a_place_is_named) {
    DensityGrid empty = ring().grid;
    SearchSettings by = settings();
    by.rotations_max = 500;
    by.background = 0.0;
    std::fill(empty.values.begin(), empty.values.end(), 0.0F);
    const std::string error =
        sample::error_of([&] { (void)place_together(empty, {ring().subunits.front()}, by); });
    EXPECT_NE(error.find(ring().subunits.front().name), std::string::npos) << error;
}

// A body frame has its origin at the centre of mass; files and matrices do not.
TEST(SearchReport, the_matrix_leads_from_the_file_to_the_map_and_names_are_quoted) {
    SearchReport report{"a,\"b\".mrc", "laplacian", 12.0, {}, {}, {}};
    SearchedModel& m = report.models.emplace_back();
    m.model = "x.pdb";
    m.structure = ring().subunits[1];
    SeededRandom random(5);
    const Pose at{1e-9 * random.direction(), random.rotation()};
    m.found.hits.push_back({at, 0.5, 4.0});
    m.cc_about_mean = {0.25};
    m.clashes = {3};
    const nlohmann::ordered_json hit = as_json(report)["hits"][0];
    EXPECT_EQ(hit["rank"], 1);
    EXPECT_EQ(hit["clashes"], 3);
    for (const std::size_t i : {std::size_t{0}, m.structure.size() / 2}) {
        const Vec3 body(static_cast<double>(m.structure.x_m[i]), static_cast<double>(m.structure.y_m[i]),
                        static_cast<double>(m.structure.z_m[i]));
        const Vec3 file_a = (body + m.structure.home_com_model_m) / kAngstromM,
                   right_a = (at.p_m + at.q * body) / kAngstromM;
        for (int row = 0; row < 3; ++row) {
            double sum_a = hit["matrix"][static_cast<std::size_t>(4 * row + 3)];
            for (int k = 0; k < 3; ++k)
                sum_a +=
                    static_cast<double>(hit["matrix"][static_cast<std::size_t>(4 * row + k)]) * file_a[k];
            EXPECT_NEAR(sum_a, right_a[row], 1e-6);
        }
    }
    const std::string csv = as_csv(report);
    EXPECT_NE(csv.find("\n\"a,\"\"b\"\".mrc\",x.pdb,12,laplacian,0.5"), std::string::npos) << csv;
    const std::string header = csv.substr(0, csv.find('\n'));
    EXPECT_EQ(std::count(header.begin(), header.end(), ','), 20);
    m.found.hits.clear();
    const std::string none = as_csv(report);
    EXPECT_EQ(std::count(none.begin(), none.end(), ','), 20 + 21);  // a comma in the name of the map
}

TEST(SearchReport, copies_name_their_symmetry_its_axis_and_a_point_of_it_in_the_map) {
    SearchReport report{"a.mrc", "laplacian", 12.0, {}, {}, {}};
    SearchedModel& m = report.models.emplace_back();
    m.structure = ring().subunits[1];
    m.copies.emplace();
    m.copies->symmetry = symmetry_of("C6");
    m.copies->place.T_model_frame = {Vec3(1.0, 2.0, 3.0) * kAngstromM,
                                     Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX())};
    m.copies->correlation = 0.75;
    const nlohmann::ordered_json said = as_json(report)["searches"][0]["symmetry"];
    EXPECT_EQ(said["name"], "C6");
    EXPECT_NEAR(said["axis"][0].get<double>(), 1.0, 1e-12);
    EXPECT_NEAR(said["through_a"][1].get<double>(), 2.0, 1e-9);
    EXPECT_EQ(said["correlation"], 0.75);
    EXPECT_NE(as_table(report).find("copies by C6"), std::string::npos);
    m.copies.reset();
    EXPECT_FALSE(as_json(report)["searches"][0].contains("symmetry"));
}

class FitInScene : public testing::Test {
protected:
    FitInScene() {
        char name[] = "/tmp/tact-fit-scene-XXXXXX";
        folder_ = mkdtemp(name);
        std::filesystem::remove(scene());
        DockingInput baked;
        baked.title = "two";
        baked.grid = ring().grid;
        baked.structures = ring().subunits;
        baked.structures.resize(2);
        baked.resolution_m = ring().resolution_m;
        baked.vertices_max = 2000;
        SceneWriter out;
        bake_docking(baked, out);
        out.write(scene());
    }
    ~FitInScene() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::string scene() const { return folder_ + "/two.tact"; }
    [[nodiscard]] FitInput with_poses(const std::string& fixed) const {
        const std::string path = folder_ + "/poses.json";
        std::ofstream(path) << R"({"bodies": [
            {"id": 1, "structure": 0, "pos_model_a": [1, 2, 3], "quat_model_body_xyzw": [0, 0, 0, 1], "fixed": )"
                            << fixed << R"(},
            {"id": 7, "structure": 1, "pos_model_a": [4, 5, 6], "quat_model_body_xyzw": [1, 0, 0, 0]}]})";
        FitInput input;
        input.map.path = scene();
        input.poses = path;
        return input;
    }
    std::string folder_;
};

TEST_F(FitInScene, a_scene_gives_its_bodies_and_subtracts_the_fixed_ones) {
    FitInput input;
    input.map.path = scene();
    const FitData as_baked = read_fit_input(input);
    ASSERT_EQ(as_baked.models.size(), 2U);
    EXPECT_EQ(as_baked.rest.values, as_baked.grid.values);
    EXPECT_EQ(as_baked.models[1].T_model_body.p_m, ring().subunits[1].home_com_model_m);

    input = with_poses("true");
    input.map.resolution_a = 12.0;
    const FitData posed = read_fit_input(input);
    ASSERT_EQ(posed.models.size(), 1U);
    EXPECT_NEAR(posed.models[0].T_model_body.p_m.z(), 6e-10, 1e-20);
    EXPECT_EQ(posed.models[0].T_model_body.q.x(), 1.0);
    ASSERT_EQ(posed.fixed.size(), 1U);
    EXPECT_NEAR(posed.placed()[0].T_model_body.p_m.y(), 2e-10, 1e-20);
    EXPECT_NE(posed.rest.values, posed.grid.values);
    EXPECT_NEAR(posed.metrics.resolution_m, 12e-10, 1e-20);
}

TEST_F(FitInScene, one_body_is_taken_by_its_id_even_if_it_is_fixed) {
    FitInput input = with_poses("true");
    input.body = 1;
    const FitData data = read_fit_input(input);
    ASSERT_EQ(data.models.size(), 1U);
    EXPECT_NEAR(data.models[0].T_model_body.p_m.x(), 1e-10, 1e-20);
    EXPECT_TRUE(data.fixed.empty());  // the other one is free
}

TEST_F(FitInScene, what_does_not_fit_is_refused_with_a_reason) {
    const auto error = [](const FitInput& input) {
        return sample::error_of([&] { (void)read_fit_input(input); });
    };
    FitInput input = with_poses("true");
    input.body = 3;
    EXPECT_NE(error(input).find("no body 3"), std::string::npos);
    input = with_poses("3");
    EXPECT_NE(error(input).find("neither true nor false"), std::string::npos);
    input = with_poses("true");
    input.models = {"a.pdb"};
    EXPECT_NE(error(input).find("a scene holds its structures"), std::string::npos);
    input = {};
    input.map.path = "/dev/null";
    EXPECT_NE(error(input).find("no structure is given"), std::string::npos);
    input.models = {"a.pdb"};
    input.poses = "x";
    EXPECT_NE(error(input).find("need a baked docking scene"), std::string::npos);
}

}  // namespace
}  // namespace tact::prep_search_test
