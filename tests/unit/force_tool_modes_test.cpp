// Three modes of surface query for a tool mesh give the same wrench, and the adaptive surface covers the tool's
// surroundings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "tests/unit/force_tool_scene.hpp"

namespace tact::force_tool_modes_test {
namespace {

constexpr double kStepS = 1e-3;
constexpr int kSlowUpdateEvery = 4, kSteps = 1500;  // cycles
constexpr SectionTag kForest{'F', 'R', 'S', 'T'};

const RoughSphereScene& scene() {
    static const RoughSphereScene made(true);
    return made;
}

struct Felt {
    std::vector<Wrench> wrench;
    double touching = 0.0, adaptive = 0.0, settled = 0.0;  // fractions of the cycles
};

// A path around the sphere, up and down and about the tool's axis; the tool presses in after 0.25 s.
Felt feel(SurfaceMode mode, double speed_m_s, bool has_slow_update = true, int steps = kSteps,
          double friction = 0.1) {
    const auto model = load_tool_model(
        *scene().file, {.damping_n_s_m = 0.0, .friction = friction, .shading = true, .mode = mode});
    const double ball_m = 0.05 * scene().meta.world_per_model;
    const Vec3 middle = scene().meta.to_world(Vec3::Zero());
    Felt felt;
    Vec3 before = middle;
    for (int i = 0; i < steps; ++i) {
        const double t = kStepS * i, angle = speed_m_s * t / ball_m, up = 0.4 * std::sin(2.0 * t);
        const Vec3 out(std::cos(up) * std::sin(angle), std::sin(up), std::cos(up) * std::cos(angle));
        ToolState tool;
        tool.T_world_tool.p_m = middle + (ball_m + std::max(0.0025, 0.03 - 0.1 * t)) * out;
        tool.T_world_tool.q =
            Quat::FromTwoVectors(Vec3::UnitY(), out) * Quat(Eigen::AngleAxisd(0.5 * t, Vec3::UnitY()));
        if (i > 0) tool.twist_world.linear_m_s = (tool.T_world_tool.p_m - before) / kStepS;
        before = tool.T_world_tool.p_m;
        if (i == 0) model->reset(tool);
        if (has_slow_update && i % kSlowUpdateEvery == 0) model->slow_update(tool, {});
        felt.wrench.push_back(model->step(tool, {}).wrench_world);
        felt.touching += (felt.wrench.back().force_n.norm() > 0.1 ? 1.0 : 0.0) / steps;
        felt.settled += (model->tool_touch().state == ContactState::settled ? 1.0 : 0.0) / steps;
        felt.adaptive += (model->regime() == TouchRegime::adaptive ? 1.0 : 0.0) / steps;
    }
    return felt;
}

std::size_t different(const Felt& a, const Felt& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(a.wrench.size(), b.wrench.size()); ++i) {
        const bool same =
            a.wrench[i].force_n == b.wrench[i].force_n && a.wrench[i].torque_n_m == b.wrench[i].torque_n_m;
        count += same ? 0 : 1;
    }
    return count;
}

TEST(ToolModes, the_adaptive_surface_gives_the_wrench_of_the_full_mesh_to_the_bit) {
    for (const double speed_m_s : {0.055, 0.22}) {
        const Felt chr = feel(SurfaceMode::chr, speed_m_s), tree = feel(SurfaceMode::off_tree, speed_m_s);
        EXPECT_EQ(different(chr, tree), 0U);
        EXPECT_GT(tree.touching, 0.7);
        EXPECT_GT(chr.adaptive, 0.99);
        EXPECT_EQ(tree.adaptive, 0.0);
    }
}

TEST(ToolModes, without_slow_updates_the_tree_is_used_and_reported) {
    const Felt chr = feel(SurfaceMode::chr, 0.055, false);
    EXPECT_EQ(chr.adaptive, 0.0);
    EXPECT_EQ(different(chr, feel(SurfaceMode::off_tree, 0.055)), 0U);
}

// Without friction: friction also depends on the proxy's path, which depends on the cached half-spaces.
TEST(ToolModes, all_triangles_give_the_force_of_the_tree) {
    constexpr int kFew = 600;
    const Felt brute = feel(SurfaceMode::off_brute, 0.055, false, kFew, 0.0),
               tree = feel(SurfaceMode::off_tree, 0.055, false, kFew, 0.0);
    double worst_n = 0.0;
    for (std::size_t i = 0; i < brute.wrench.size(); ++i)
        worst_n = std::max(worst_n, (brute.wrench[i].force_n - tree.wrench[i].force_n).norm());
    EXPECT_GT(brute.touching, 0.3);
    EXPECT_LT(worst_n, 1e-3);
}

TEST(ToolModes, a_moving_tool_is_at_rest_in_nearly_every_step) {
    for (const double friction : {0.0, 0.2}) {
        const Felt slow = feel(SurfaceMode::off_tree, 0.055, false, kSteps, friction),
                   fast = feel(SurfaceMode::off_tree, 0.22, false, kSteps, friction);
        EXPECT_GT(slow.touching, 0.7);
        EXPECT_GT(slow.settled, 0.97) << friction;
        EXPECT_GT(fast.settled, friction > 0.0 ? 0.94 : 0.98) << friction;
    }
}

TEST(ToolModes, chr_without_a_forest_is_refused) {
    const RoughSphereScene bare(false);
    ASSERT_EQ(bare.file->count(kForest), 0U);
    EXPECT_THROW((void)load_tool_model(*bare.file, {.mode = SurfaceMode::chr}), StartupError);
}

TEST(ToolModes, the_slow_update_is_reported) {
    const auto model = load_tool_model(*scene().file, {.mode = SurfaceMode::chr});
    ToolState tool;
    tool.T_world_tool.p_m = scene().meta.to_world(Vec3(0.0, 0.055, 0.0));
    model->reset(tool);
    for (int i = 0; i < 40; ++i) {
        model->slow_update(tool, {});
        (void)model->step(tool, {});
    }
    const SurfaceDetail detail = model->touch().detail;
    EXPECT_TRUE(model->has_slow_update());
    EXPECT_TRUE(detail.valid);
    EXPECT_TRUE(detail.full);
    // The refined region contains the whole tool in any orientation.
    EXPECT_GT(detail.radius_m, model->contact().points().reach_m());
    EXPECT_GT(model->slow_update_s(), 0.0);
}

}  // namespace
}  // namespace tact::force_tool_modes_test
