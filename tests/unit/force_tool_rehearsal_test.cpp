// Costs of a mesh tool's strokes, tried before the loop starts.
#include "rt/force/surface/tool_rehearsal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rt/force/surface/tool_model.hpp"
#include "tests/unit/force_tool_scene.hpp"

namespace tact::force_tool_rehearsal_test {
namespace {

constexpr double kPatienceS = 300.0;  // a machine that is busy, or a sanitizer, tries no less

struct Scene : RoughSphereScene {
    SurfaceMesh mesh = read_surface(*file);
    TouchTool tool = read_touch_tool(*file);
    Scene() : RoughSphereScene(false) {}
    [[nodiscard]] ToolRehearsal tried(double step_s, const SurfaceSettings& settings = {}) const {
        return rehearse_tool(meta, mesh, tool, settings, step_s, kPatienceS);
    }
};
const Scene& scene() {
    static const Scene made;
    return made;
}

// Works of a hand that strokes around the sphere and up and down in it, in other ways than the trial.
std::vector<double> works_us(float level, double step_s, int steps) {
    const Scene& s = scene();
    ToolModel model(s.meta, s.mesh, s.tool, {});
    const double ball_m = 0.05 * s.meta.world_per_model;
    std::vector<double> works;
    for (int i = 0; i < steps; ++i) {
        const double t = step_s * i, angle = 0.1 * t / ball_m, up = 0.4 * std::sin(2.0 * t);
        const Vec3 out(std::cos(up) * std::sin(angle), std::sin(up), std::cos(up) * std::cos(angle));
        ToolState hand;
        hand.T_world_tool.p_m =
            s.meta.to_world(Vec3::Zero()) + (ball_m + std::max(0.0025, 0.03 - 0.1 * t)) * out;
        hand.T_world_tool.q =
            Quat::FromTwoVectors(Vec3::UnitY(), out) * Quat(Eigen::AngleAxisd(0.5 * t, Vec3::UnitY()));
        if (i == 0) model.reset(hand);
        const StepResult result = model.step(hand, {.fidelity = level});
        const ToolTouch& touch = model.tool_touch();
        if (touch.places > 0)
            works.push_back(tool_work_us(touch.moves, result.load.items, touch.looked, touch.asked));
    }
    return works;
}

TEST(ToolRehearsal, few_steps_of_other_strokes_take_more_work_than_was_tried) {
    constexpr double kStepS = 1e-3;
    const ToolRehearsal tried = scene().tried(kStepS);
    ASSERT_TRUE(tried.tried());
    for (std::size_t i = 0; i < tried.kLevels.size(); ++i) {
        const std::vector<double> works = works_us(tried.kLevels[i], kStepS, 4000);
        ASSERT_GT(works.size(), 2000U);
        const auto more =
            std::count_if(works.begin(), works.end(), [&](double w) { return w > tried.work_us[i]; });
        EXPECT_LT(static_cast<double>(more), 0.005 * static_cast<double>(works.size())) << tried.kLevels[i];
        EXPECT_LT(tried.work_us[i], 2.5 * *std::max_element(works.begin(), works.end())) << tried.kLevels[i];
    }
}

TEST(ToolRehearsal, a_short_time_sees_all_levels_at_the_first_place) {
    const Scene& s = scene();
    EXPECT_TRUE(rehearse_tool(s.meta, s.mesh, s.tool, {}, 1e-3, 0.0).tried());
}

TEST(ToolRehearsal, a_slower_loop_moves_the_tool_farther_in_each_step_and_costs_more) {
    const ToolRehearsal slow = scene().tried(4e-3), quick = scene().tried(0.25e-3);
    EXPECT_GT(slow.work_us.back(), 1.3 * quick.work_us.back());
}

TEST(ToolRehearsal, the_cost_is_the_work_at_this_machines_speed_and_rises_with_the_level) {
    ToolRehearsal r;
    r.work_us = {10.0, 20.0, 40.0, 40.0, 160.0, 320.0};
    r.speed = 3.0;
    EXPECT_EQ(r.cost(0.05F), Duration(30'000));
    EXPECT_EQ(r.cost(0.75F), Duration(480'000));
    EXPECT_EQ(r.cost(1.0F), Duration(960'000));
    EXPECT_NEAR(to_us(r.cost(0.675F)), 240.0, 0.1);  // half-way in the logarithm
    EXPECT_EQ(r.cost(0.0F), r.cost(0.05F));
}

TEST(ToolRehearsal, the_model_predicts_what_was_tried) {
    const Scene& s = scene();
    ToolModel model(s.meta, s.mesh, s.tool, {});
    const Duration by_constants = model.predict(0.8F).cost_predicted;
    ToolRehearsal r;
    r.work_us = {10.0, 20.0, 40.0, 40.0, 160.0, 320.0};
    r.speed = 3.0;
    model.foresee(r);
    EXPECT_NE(model.predict(0.8F).cost_predicted, by_constants);
    EXPECT_EQ(model.predict(0.8F).cost_predicted, r.cost(0.8F));
    const auto loaded = load_tool_model(*s.file, {}, 1e-3);
    EXPECT_NE(loaded->predict(0.8F).cost_predicted, by_constants);
}

TEST(ToolRehearsal, a_tool_that_reaches_no_surface_tries_nothing) {
    const Scene& s = scene();
    TouchTool aside = s.tool;
    for (std::size_t i = 0; i < aside.point_m.size(); i += 3) aside.point_m[i] += 10.0F;
    EXPECT_FALSE(rehearse_tool(s.meta, s.mesh, aside, {}, 1e-3, kPatienceS).tried());
    EXPECT_FALSE(s.tried(1e-3, {.mode = SurfaceMode::off_brute}).tried());
}

}  // namespace
}  // namespace tact::force_tool_rehearsal_test
