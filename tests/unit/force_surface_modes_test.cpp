// Three modes of surface query give the same force, and the adaptive surface covers the tool's surroundings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/topics/command.hpp"
#include "prep/surface/bake_surface.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "rt/force/surface/near_surface.hpp"
#include "rt/force/surface/surface_model.hpp"

namespace tact::force_surface_modes_test {
namespace {

constexpr double kStepS = 1e-3;
constexpr int kSlowUpdateEvery = 4;  // cycles

struct Baked {
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> file;
    double world_per_model = 0.0;
    explicit Baked(bool forest) {
        SceneWriter out;
        SurfaceInput input;
        input.mesh = rough_sphere(30);
        input.picture = false;
        input.forest = forest;
        world_per_model = bake_surface(std::move(input), out).meta.world_per_model;
        bytes = out.to_bytes();
        file = std::make_unique<SceneFile>(SceneFile::from_bytes(bytes, "sphere.tact"));
    }
};
const Baked& sphere() {
    static const Baked baked(true);
    return baked;
}

struct Felt {
    std::vector<Vec3> force_n;
    double adaptive = 0.0;  // fraction of the cycles
};

// One round around the sphere with an up-and-down motion; the speed is in the world frame.
Felt feel(SurfaceMode mode, double radius_m, double speed_m_s, bool has_slow_update = true) {
    const auto model = load_surface_model(
        *sphere().file, {.radius_m = radius_m, .damping_n_s_m = 0.0, .friction = 0.1, .mode = mode});
    const double scale = sphere().world_per_model, ball_m = 0.05 * scale;
    const Vec3 middle = model->meta().to_world(Vec3::Zero());
    Felt felt;
    double angle = 0.0;
    Vec3 before = middle + Vec3(0.0, 0.0, 1.2 * ball_m);
    for (int i = 0; i < 1200; ++i) {
        const double t = kStepS * i;
        angle += speed_m_s * kStepS / ball_m;
        const double up = 0.4 * std::sin(5.0 * t);
        const Vec3 out(std::cos(up) * std::sin(angle), std::sin(up), std::cos(up) * std::cos(angle));
        const double from = ball_m + radius_m + std::max(0.0, 0.01 - 0.05 * t);
        ToolState tool;
        tool.T_world_tool.p_m = middle + (from - 1e-3 * (1.0 + 0.5 * std::sin(9.0 * t))) * out;
        tool.twist_world.linear_m_s =
            i == 0 ? Vec3(Vec3::Zero()) : Vec3((tool.T_world_tool.p_m - before) / kStepS);
        before = tool.T_world_tool.p_m;
        if (i == 0) model->reset(tool);
        if (has_slow_update && i % kSlowUpdateEvery == 0) model->slow_update(tool, {});
        felt.force_n.push_back(model->step(tool, {}).wrench_world.force_n);
        felt.adaptive += model->regime() == TouchRegime::adaptive ? 1.0 / 1200.0 : 0.0;
    }
    return felt;
}

// Bit by bit: each mode tests the same triangles in the same order.
void expect_same_force(const Felt& a, const Felt& b) {
    double force_sum_n = 0.0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.force_n.size(); ++i) {
        different += a.force_n[i] == b.force_n[i] ? 0 : 1;
        force_sum_n += b.force_n[i].norm();
    }
    EXPECT_GT(force_sum_n / static_cast<double>(b.force_n.size()), 0.3);
    EXPECT_EQ(different, 0U);
}

TEST(SurfaceModes, all_triangles_and_the_tree_give_the_same_force) {
    for (const double radius_m : {0.0, 1e-3})
        expect_same_force(feel(SurfaceMode::off_brute, radius_m, 0.05),
                          feel(SurfaceMode::off_tree, radius_m, 0.05));
}

TEST(SurfaceModes, the_adaptive_surface_gives_the_force_of_the_full_mesh) {
    for (const double radius_m : {0.0, 1e-3, 3e-3}) {
        const Felt chr = feel(SurfaceMode::chr, radius_m, 0.05);
        expect_same_force(chr, feel(SurfaceMode::off_tree, radius_m, 0.05));
        EXPECT_GT(chr.adaptive, 0.99);
    }
}

TEST(SurfaceModes, the_adaptive_surface_keeps_up_with_a_fast_hand) {
    const Felt chr = feel(SurfaceMode::chr, 1e-3, 0.5);
    expect_same_force(chr, feel(SurfaceMode::off_tree, 1e-3, 0.5));
    EXPECT_GT(chr.adaptive, 0.99);
}

TEST(SurfaceModes, without_slow_updates_the_tree_is_used_and_reported) {
    const Felt chr = feel(SurfaceMode::chr, 1e-3, 0.05, false);
    EXPECT_EQ(chr.adaptive, 0.0);
    expect_same_force(chr, feel(SurfaceMode::off_tree, 1e-3, 0.05));
}

TEST(SurfaceModes, adaptive_mode_without_a_forest_is_refused_and_brute_force_is_not) {
    const Baked plain(false);
    EXPECT_THROW((void)load_surface_model(*plain.file, {.mode = SurfaceMode::chr}), StartupError);
    EXPECT_NE(load_surface_model(*plain.file, {.mode = SurfaceMode::off_brute}), nullptr);
}

std::vector<std::uint32_t> leaves_in(const SurfaceMesh& mesh, const Vec3& centre_m, double radius_m) {
    std::vector<std::uint32_t> leaf(mesh.triangles());
    std::size_t count = 0;
    EXPECT_TRUE(mesh.leaves_near(centre_m, radius_m, leaf, count));
    leaf.resize(count);
    std::sort(leaf.begin(), leaf.end());
    return leaf;
}

TEST(NearSurface, finds_the_same_leaves_as_the_whole_tree_in_its_box) {
    const SurfaceMesh full = read_surface(*sphere().file);
    NearSurface near(4096);
    SeededRandom random(5);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    const double size_m = (full.high_m() - full.low_m()).maxCoeff();
    std::size_t found = 0, nothing = 0;
    for (std::uint64_t build = 1; build <= 200; ++build) {
        std::array<float, 3> low_m{}, high_m{};
        double least_m = size_m;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto axis = static_cast<Eigen::Index>(i);
            const double half_m = size_m * (build % 4 == 0 ? 1e-4 : between(0.002, 0.15));
            const double middle_m = between(full.low_m()[axis], full.high_m()[axis]);
            low_m[i] = static_cast<float>(middle_m - half_m);
            high_m[i] = static_cast<float>(middle_m + half_m);
            least_m = std::min(least_m, half_m);
        }
        ASSERT_TRUE(near.build(full, low_m, high_m, build));
        EXPECT_EQ(near.version(), build);
        for (int ball = 0; ball < 10; ++ball) {
            Vec3 centre_m;
            const double radius_m = 0.3 * least_m;
            for (std::size_t i = 0; i < 3; ++i)
                centre_m[static_cast<Eigen::Index>(i)] =
                    between(static_cast<double>(low_m[i]) + 1.01 * radius_m,
                            static_cast<double>(high_m[i]) - 1.01 * radius_m);
            ASSERT_TRUE(near.holds(centre_m, radius_m));
            const auto leaves = leaves_in(full, centre_m, 0.999 * radius_m);
            EXPECT_EQ(leaves_in(near.mesh(), centre_m, 0.999 * radius_m), leaves);
            found += leaves.size();
            nothing += leaves.empty() ? 1 : 0;
        }
        EXPECT_FALSE(near.holds(Vec3::Constant(2.0 * size_m), 0.0));
    }
    EXPECT_GT(found, 1000U);
    EXPECT_GT(nothing, 100U);
}

TEST(NearSurface, a_box_that_does_not_fit_is_not_held) {
    const SurfaceMesh full = read_surface(*sphere().file);
    NearSurface near(16);
    std::array<float, 3> low_m{}, high_m{};
    for (std::size_t i = 0; i < 3; ++i) {
        low_m[i] = static_cast<float>(full.low_m()[static_cast<Eigen::Index>(i)]);
        high_m[i] = static_cast<float>(full.high_m()[static_cast<Eigen::Index>(i)]);
    }
    EXPECT_FALSE(near.build(full, low_m, high_m, 1));
    EXPECT_FALSE(near.holds(Vec3::Zero(), 0.0));
    EXPECT_FALSE(NearSurface().build(full, low_m, high_m, 1));
    EXPECT_TRUE(near.build(full, low_m, low_m, 2));
    EXPECT_TRUE(near.holds(full.low_m().cast<float>().cast<double>(), 0.0));
}

TEST(SurfaceModes, more_fidelity_gives_a_wider_radius_and_more_triangles) {
    const auto model = load_surface_model(*sphere().file, {.radius_m = 1e-3, .mode = SurfaceMode::chr});
    double radius = 0.0, triangles = 0.0;
    for (const float fidelity : {0.0F, 0.3F, 1.0F}) {
        EXPECT_GT(model->adaptive()->radius_m(fidelity), radius);
        EXPECT_GT(model->adaptive()->predicted_triangles(fidelity), triangles);
        radius = model->adaptive()->radius_m(fidelity);
        triangles = model->adaptive()->predicted_triangles(fidelity);
    }
}

// A model with the hand over the sphere after `turns` slow updates.
std::unique_ptr<SurfaceModel> rested(float fidelity, int turns, const ModelOrder& order = {}) {
    auto model = load_surface_model(*sphere().file, {.radius_m = 1e-3, .mode = SurfaceMode::chr});
    static_cast<void>(model->order(order));
    ToolState tool;
    const double ball_m = 0.05 * sphere().world_per_model;
    tool.T_world_tool.p_m = model->meta().to_world(Vec3::Zero()) + Vec3(0.0, 0.0, 1.2 * ball_m);
    model->reset(tool);
    for (int i = 0; i < turns; ++i) {
        tool.T_world_tool.p_m.x() += 1e-3;  // each slow update gets something to build
        static_cast<void>(model->step(tool, {.fidelity = fidelity}));
        model->slow_update(tool, {});
    }
    static_cast<void>(model->step(tool, {.fidelity = fidelity}));
    return model;
}

TEST(SurfaceModes, the_detail_report_gives_radius_bound_and_cost) {
    const SurfaceDetail d = rested(1.0F, 40)->touch().detail;
    ASSERT_TRUE(d.valid);
    EXPECT_TRUE(d.full);
    EXPECT_GT(d.radius_m, 0.0);
    EXPECT_GT(d.triangles, 0U);
    EXPECT_GT(d.turn_s, 0.0);
    EXPECT_GT(d.turn_predicted_s, 0.0);
    // Far away the filter allows half of the radius, and the bound includes distances along the surface.
    EXPECT_GT(d.deviation_m, 0.0);
    EXPECT_FALSE(load_surface_model(*sphere().file, {})->touch().detail.valid);
}

TEST(SurfaceModes, the_cost_of_the_knob_is_that_of_the_surface_around_the_tool) {
    const auto model = rested(0.5F, 10);
    EXPECT_EQ(model->items(0.5F), model->touch().detail.near_triangles);
    EXPECT_GT(model->items(1.0F), model->items(0.2F));
    // One rate for all levels: cost grows with the number of triangles.
    const AdaptiveSurface& surface = *model->adaptive();
    EXPECT_NEAR(surface.predicted_s(1.0F) / surface.predicted_s(0.2F),
                surface.predicted_triangles(1.0F) / surface.predicted_triangles(0.2F), 1e-6);
    EXPECT_GT(model->slow_update_s(), 0.0);
    EXPECT_EQ(load_surface_model(*sphere().file, {})->slow_update_s(), 0.0);
}

TEST(SurfaceModes, a_new_filter_shape_changes_the_cut) {
    ModelOrder order;
    order.kind = ModelOrder::Kind::setting;
    order.command = static_cast<std::uint8_t>(CommandKind::set_detail_filter);
    double& error_far = order.T_model_body.p_m.x();
    order.value = 0.2;
    error_far = 4.0;
    order.body = static_cast<std::uint32_t>(DetailShape::multiple_frustum);
    const SurfaceDetail steep = rested(0.2F, 40, order)->touch().detail;
    EXPECT_EQ(steep.shape, DetailShape::multiple_frustum);
    EXPECT_EQ(steep.width, 0.2F);
    EXPECT_TRUE(steep.full);
    order.value = 6.0;
    error_far = 0.1;
    EXPECT_GT(rested(0.2F, 40, order)->touch().detail.triangles, steep.triangles);
    const auto model = rested(0.2F, 1);
    order.value = 1e9;
    EXPECT_FALSE(model->order(order));
    order.value = 1.0;
    order.body = 9;
    EXPECT_FALSE(model->order(order));
    order.body = 0;
    order.command = static_cast<std::uint8_t>(CommandKind::set_clash);  // belongs to another system
    EXPECT_FALSE(model->order(order));
    EXPECT_FALSE(load_surface_model(*sphere().file, {})->order(order));
}

}  // namespace
}  // namespace tact::force_surface_modes_test
