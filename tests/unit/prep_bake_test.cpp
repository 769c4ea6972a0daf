// The bake: contents of the scene, default choices, and cancellation.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "ipc/base/error.hpp"
#include "ipc/scene/mesh/progressive_mesh.hpp"
#include "prep/docking/bake_docking.hpp"
#include "prep/map/low_pass.hpp"
#include "prep/synthetic/ring.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::prep_bake_test {
namespace {

const DockingInput& ring_input() {
    static const DockingInput input = [] {
        SyntheticRing ring = make_ring();
        DockingInput in;
        in.title = "ring";
        in.grid = std::move(ring.grid);
        in.structures = {ring.subunits[0], ring.subunits[3]};
        in.note = {"map: ring"};
        in.resolution_m = ring.resolution_m;
        return in;
    }();
    return input;
}

// The unmodified ring, baked once for all tests.
struct BakedRing {
    BakedDocking told;
    std::vector<std::byte> bytes;
};
const BakedRing& baked_ring() {
    static const BakedRing ring = [] {
        SceneWriter out;
        BakedRing r;
        r.told = bake_docking(ring_input(), out);
        r.bytes = out.to_bytes();
        return r;
    }();
    return ring;
}

bool has_line(const std::string& note, const std::string& begin) {
    return note.starts_with(begin) || note.find("\n" + begin) != std::string::npos;
}

TEST(Bake, scene_contains_everything_that_other_programs_read) {
    const BakedDocking& baked = baked_ring().told;
    const SceneFile file = SceneFile::from_bytes(baked_ring().bytes, "ring");
    const SceneMeta meta = read_meta(file);
    EXPECT_EQ(meta.kind, SceneKind::docking);
    EXPECT_EQ(meta.body_count, 2U);
    EXPECT_STREQ(meta.title, "ring");
    EXPECT_EQ(meta.resolution_m, 12e-10);
    EXPECT_GT(meta.energy_j_per_sigma, 0.0);
    const DensityGrid grid = read_grid(file);
    EXPECT_EQ(grid.values, ring_input().grid.values);
    const ProgressiveMesh mesh = read_mesh(file, 0);
    EXPECT_GT(mesh.vertices(), 1000U);
    EXPECT_LT(mesh.vertices_min(), 200U);
    EXPECT_EQ(mesh.vertices(), baked.vertices);
    for (std::uint32_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read_structure(file, i).size(), ring_input().structures[i].size());
        const Codebook codebook = read_codebook(file, i);
        ASSERT_GE(codebook.levels.size(), 3U);
        EXPECT_LT(codebook.levels.back().size(), ring_input().structures[i].size());
        EXPECT_GT(baked.bodies[i].inside_home, 0.95);
        EXPECT_GT(baked.bodies[i].density_home_sigma, 3.0);
    }
    const std::string note = read_note(file);
    for (const char* key :
         {"map: ring", "map values: ", "map background: ", "contour: ", "resolution: 12 Å, as given",
          "world per model: ", "centre: ", "surface: ", "body 0: ring subunit A", "body 1: ring subunit D",
          "gain: "}) {
        EXPECT_TRUE(has_line(note, key)) << key << "\n" << note;
    }
}

TEST(Bake, the_same_input_gives_the_same_scene) {
    SceneWriter again;
    bake_docking(ring_input(), again);
    EXPECT_EQ(again.to_bytes(), baked_ring().bytes);
}

TEST(Bake, the_map_is_about_as_wide_as_the_reach_of_the_hand) {
    for (double extent_m = 1e-9; extent_m < 1e-6; extent_m *= 1.07) {
        const double scale = world_per_model_for(extent_m);
        EXPECT_NEAR(std::log(scale * extent_m / 0.16), 0.0, 0.25) << extent_m;
        const double digits = scale / std::pow(10.0, std::floor(std::log10(scale) + 1e-9));
        const std::set<double> nice{1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0};
        EXPECT_TRUE(nice.count(std::round(digits * 1e6) / 1e6) == 1) << scale;
    }
    EXPECT_EQ(world_per_model_for(2.67e-8), 6e6);
}

TEST(Bake, the_scene_is_centred_on_the_density_and_long_titles_are_cut_between_characters) {
    DockingInput input = ring_input();
    input.structures.resize(1);
    input.title = "ab";
    for (int i = 0; i < 100; ++i) input.title += "Å";
    SceneWriter out;
    const SceneMeta meta = bake_docking(input, out).meta;
    EXPECT_EQ(std::string(meta.title), input.title.substr(0, 126));
    // The axis of the ring is z.
    EXPECT_LT(std::hypot(meta.centre_model_m[0], meta.centre_model_m[1]), 1e-10);
    const double top_m =
        ring_input().grid.origin_m.z() + ring_input().grid.size[2] * ring_input().grid.spacing_m.z();
    EXPECT_GT(meta.centre_model_m[2], ring_input().grid.origin_m.z());
    EXPECT_LT(meta.centre_model_m[2], top_m);
}

TEST(Bake, given_contour_and_vertex_limit_are_applied) {
    DockingInput input = ring_input();
    input.structures.resize(1);
    input.contour = 60.0;
    input.vertices_max = 1500;
    SceneWriter out;
    const BakedDocking baked = bake_docking(input, out);
    EXPECT_EQ(baked.meta.contour, 60.0);
    EXPECT_LE(baked.vertices, 1500U);
    EXPECT_GT(baked.vertices, 1000U);
    EXPECT_TRUE(has_line(baked.note, "contour: 60, as given")) << baked.note;
}

TEST(Bake, the_force_map_is_smoothed_on_request_and_the_displayed_map_is_not) {
    DockingInput input = ring_input();
    input.structures.resize(1);
    input.force_map_resolution_m = 18e-10;
    SceneWriter out;
    const BakedDocking baked = bake_docking(input, out);
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "smoothed");
    EXPECT_EQ(read_grid(file).values, input.grid.values);
    EXPECT_EQ(read_force_map_grid(file).values,
              low_pass(input.grid, baked.meta.map_background, 18e-10).values);
    EXPECT_TRUE(has_line(baked.note, "force map: smoothed")) << baked.note;

    EXPECT_TRUE(has_line(baked_ring().told.note, "force map: not smoothed"));
    EXPECT_EQ(read_force_map_grid(SceneFile::from_bytes(baked_ring().bytes, "plain")).values,
              input.grid.values);
}

// One bright voxel becomes a Gaussian of the given width: values, sum and background.
TEST(LowPass, spreads_a_voxel_as_a_gaussian_of_the_given_width) {
    DensityGrid grid;
    grid.size = {33, 35, 37};
    grid.spacing_m = Vec3(1e-10, 1.2e-10, 0.9e-10);
    grid.values.assign(grid.count(), 2.0F);
    const auto index = [&](std::size_t x, std::size_t y, std::size_t z) { return (z * 35 + y) * 33 + x; };
    grid.values[index(16, 17, 18)] = 1002.0F;
    const double resolution_m = 10e-10, sigma_m = 2.25e-10;
    const DensityGrid out = low_pass(grid, 2.0, resolution_m);
    double sum = 0.0;
    for (const float v : out.values) sum += static_cast<double>(v) - 2.0;
    EXPECT_NEAR(sum, 1000.0, 0.5);
    const double top = static_cast<double>(out.values[index(16, 17, 18)]) - 2.0;
    for (const std::array<int, 3> d : {std::array{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {2, 1, 1}}) {
        const Vec3 r_m(d[0] * 1e-10, d[1] * 1.2e-10, d[2] * 0.9e-10);
        const double expected = top * std::exp(-0.5 * r_m.squaredNorm() / (sigma_m * sigma_m));
        const auto x = static_cast<std::size_t>(16 + d[0]), y = static_cast<std::size_t>(17 + d[1]),
                   z = static_cast<std::size_t>(18 + d[2]);
        EXPECT_NEAR(static_cast<double>(out.values[index(x, y, z)]) - 2.0, expected, 1e-3 * top);
    }
    DensityGrid flat = grid;
    flat.values.assign(flat.count(), 2.0F);
    for (const float v : low_pass(flat, 2.0, resolution_m).values) EXPECT_NEAR(v, 2.0F, 1e-5F);
}

TEST(Bake, impossible_requests_are_refused) {
    const auto error = [](auto&& change) {
        DockingInput input = ring_input();
        change(input);
        SceneWriter out;
        return sample::error_of([&] { bake_docking(input, out); });
    };
    EXPECT_NE(error([](DockingInput& in) { in.structures.clear(); }).find("no structure"), std::string::npos);
    EXPECT_NE(error([](DockingInput& in) {
                  in.structures.resize(17, in.structures[0]);
              }).find("17 structures are more than 16"),
              std::string::npos);
    EXPECT_NE(error([](DockingInput& in) { in.contour = 1e6; }).find("outside the map's values"),
              std::string::npos);
    EXPECT_NE(error([](DockingInput& in) { in.contour = std::nan(""); }).find("outside the map's values"),
              std::string::npos);
    for (const double no_resolution_m : {0.0, 0.4e-10, 1.0, std::nan("")})
        EXPECT_NE(error([&](DockingInput& in) { in.resolution_m = no_resolution_m; }).find("resolution"),
                  std::string::npos);
    const std::string far = error([](DockingInput& in) { in.structures[1].home_com_model_m.x() += 1e-6; });
    EXPECT_NE(far.find("ring subunit D lies 99"), std::string::npos) << far;
}

TEST(Bake, stops_at_any_report_that_cancels_it) {
    DockingInput input = ring_input();
    input.structures.resize(1);
    std::set<std::string> stages;
    double last = 0.0;
    SceneWriter out;
    bake_docking(input, out, [&](double fraction, const char* what) {
        EXPECT_GE(fraction, last - 1e-9) << what;
        EXPECT_LE(fraction, 1.0);
        last = fraction;
        stages.insert(what);
        return true;
    });
    EXPECT_GE(stages.size(), 5U);
    for (const std::string& stage : stages) {
        SceneWriter unused;
        EXPECT_THROW(bake_docking(input, unused, [&](double, const char* what) { return stage != what; }),
                     Cancelled)
            << stage;
    }
}

}  // namespace
}  // namespace tact::prep_bake_test
