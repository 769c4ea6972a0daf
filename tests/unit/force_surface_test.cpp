// The force on a tool that touches simple surfaces, its limits, and the scenes that are loaded.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"
#include "prep/surface/bake_surface.hpp"
#include "tests/unit/force_surface_fixture.hpp"

namespace tact::force_surface_test {
namespace {

using namespace surface_test;

TEST(Surface, a_plane_pushes_back_by_stiffness_times_depth) {
    for (const double radius_m : {0.0, 0.001, 0.003}) {
        Hand hand(plane(), plain(radius_m), Vec3(0.003, 0.01, 0.002));
        const Vec3 force = hand.lead(Vec3(0.013, -0.002, -0.004));
        EXPECT_LT((force - Vec3(0.0, kStiffness * (0.002 + radius_m), 0.0)).norm(), 0.006);
        EXPECT_NEAR(hand.lead(Vec3(0.013, 0.02, -0.004)).norm(), 0.0, 1e-9);
    }
}

TEST(Surface, the_touch_report_matches_the_force) {
    Hand hand(crossing(), plain(0.002), Vec3(0.01, 0.012, 0.014));
    const Vec3 goal(-0.002, -0.003, 0.02);  // past two sheets, on the free side of the third
    const Vec3 force = hand.lead(goal);
    const SurfaceTouch touch = hand.model->touch();
    EXPECT_LT((kWorldPerModel * touch.probe_m - goal).norm(), 1e-9);
    EXPECT_EQ(touch.proxy_m, hand.model->contact().proxy_m);
    EXPECT_NEAR(kWorldPerModel * touch.radius_m, 0.002, 1e-12);
    Vec3 pushed = Vec3::Zero();
    for (std::uint32_t i = 0; i < touch.planes; ++i) pushed += touch.push_n[i] * touch.normal[i];
    EXPECT_EQ(touch.planes, 2U);
    EXPECT_LT((pushed - force).norm(), 0.01);
    (void)hand.lead(Vec3(0.01, 0.012, 0.014));
    EXPECT_EQ(hand.model->touch().planes, 0U);
}

TEST(Surface, a_thin_sheet_pushes_to_the_side_where_the_tool_came_from) {
    for (const double side : {1.0, -1.0}) {
        for (const double radius_m : {0.0, 0.002}) {
            Hand hand(plane(), plain(radius_m), Vec3(0.0, 0.01 * side, 0.0));
            const Vec3 force = hand.lead(Vec3(0.01, -0.015 * side, 0.01));
            EXPECT_NEAR(side * force.y(), kStiffness * (0.015 + radius_m), 0.01);
            EXPECT_GT(side * hand.proxy().y(), 0.0);
        }
    }
}

TEST(Surface, the_tool_comes_free_around_the_border_of_a_sheet) {
    Hand hand(plane(), plain(0.001), Vec3(0.0, 0.01, 0.0));
    (void)hand.lead(Vec3(0.0, -0.002, 0.0));
    EXPECT_NEAR(hand.lead(Vec3(0.056, -0.002, 0.0)).norm(), 0.0, 1e-6);
}

TEST(Surface, a_concave_corner_pushes_with_all_its_planes) {
    for (const double radius_m : {0.0, 0.002}) {
        Hand hand(crossing(), plain(radius_m), Vec3(0.01, 0.012, 0.014));
        const Vec3 force = hand.lead(Vec3(-0.002, -0.003, -0.001));
        const Vec3 depth = Vec3(0.002, 0.003, 0.001) + Vec3::Constant(radius_m);
        EXPECT_LT((force - kStiffness * depth).norm(), 0.01);
    }
}

TEST(Surface, a_ball_over_a_convex_edge_is_pushed_along_the_line_from_the_edge) {
    Hand hand(box(), plain(0.003), Vec3(0.025, 0.025, 0.003));
    // Beside the edge, so that the centre is above both side planes.
    const Vec3 tool(0.0205, 0.021, 0.003), edge(0.02, 0.02, 0.003);
    const Vec3 expected = kStiffness * (0.003 - (tool - edge).norm()) * (tool - edge).normalized();
    EXPECT_LT((hand.lead(tool) - expected).norm(), 0.006);
    const Vec3 corner_tool(0.0206, 0.0209, 0.0208), corner = Vec3::Constant(0.02);
    const Vec3 at_corner =
        kStiffness * (0.003 - (corner_tool - corner).norm()) * (corner_tool - corner).normalized();
    EXPECT_LT((hand.lead(corner_tool) - at_corner).norm(), 0.01);
}

TEST(Surface, a_point_led_around_a_box_is_pushed_by_the_side_above_it) {
    Hand hand(box(), plain(), Vec3(0.01, 0.03, 0.003));
    EXPECT_LT((hand.lead(Vec3(0.012, 0.019, 0.003)) - Vec3(0, kStiffness * 0.001, 0)).norm(), 0.006);
    EXPECT_LT((hand.lead(Vec3(0.0190, 0.0185, 0.003)) - Vec3(0, kStiffness * 0.0015, 0)).norm(), 0.006);
    (void)hand.lead(Vec3(0.024, 0.0185, 0.003));  // off the edge and against the next side
    EXPECT_LT((hand.lead(Vec3(0.0190, 0.0100, 0.003)) - Vec3(kStiffness * 0.001, 0, 0)).norm(), 0.006);
}

TEST(Surface, friction_keeps_the_force_in_its_cone_and_sliding_keeps_it_on_the_rim) {
    for (const double friction : {0.1, 0.3, 0.8}) {
        Hand hand(plane(), plain(0.001, friction), Vec3(0.0, 0.01, 0.0));
        Vec3 force = hand.lead(Vec3(0.0, -0.001, 0.0));
        EXPECT_LT(std::hypot(force.x(), force.z()), 0.006);
        const double depth = 0.002;
        // In stick the force grows like that of a spring.
        force = hand.lead(Vec3(0.5 * friction * depth, -0.001, 0.0));
        EXPECT_NEAR(-force.x(), kStiffness * 0.5 * friction * depth, 0.006);
        force = hand.lead(Vec3(0.01, -0.001, 0.0));
        EXPECT_NEAR(-force.x(), friction * force.y(), 0.01);
        EXPECT_NEAR(force.y(), kStiffness * depth, 0.006);
        // On the way back the force reverses within the width of the cone.
        force = hand.lead(Vec3(0.01 - 2.5 * friction * depth, -0.001, 0.0));
        EXPECT_NEAR(force.x(), friction * force.y(), 0.01);
    }
}

TEST(Surface, shading_makes_a_smooth_surface_smooth_and_leaves_an_edge_sharp) {
    SurfaceSettings settings = plain();
    const auto worst_degrees = [&](bool shading) {
        settings.shading = shading;
        Hand hand(smooth(), settings, Vec3(0.0, 0.06, 0.0));
        (void)hand.lead(Vec3(0.0, 0.0485, 0.0));
        double worst = 0.0;
        for (int i = 0; i < 600; ++i) {
            const Vec3 n(std::sin(1e-3 * i), std::cos(1e-3 * i), 0.0);
            const Vec3 force = hand.step(0.0485 * n);
            if (i > 50) worst = std::max(worst, std::acos(std::min(1.0, force.normalized().dot(n))));
        }
        return worst * 180.0 / std::numbers::pi;
    };
    const double flat = worst_degrees(false), shaded = worst_degrees(true);
    EXPECT_LT(shaded, 0.5 * flat);
    EXPECT_LT(shaded, 1.0);
    settings.shading = true;
    Hand hand(box(), settings, Vec3(0.01, 0.03, 0.003));
    EXPECT_LT((hand.lead(Vec3(0.019, 0.019, 0.003)) - Vec3(0, kStiffness * 0.001, 0)).norm(), 0.006);
}

TEST(Surface, damping_opposes_inward_motion_and_never_pulls) {
    SurfaceSettings settings = plain(0.001);
    settings.damping_n_s_m = 2.0;
    Hand hand(plane(), settings, Vec3(0.0, 0.01, 0.0));
    const double at_rest = hand.lead(Vec3(0.0, -0.001, 0.0)).y();
    ToolState tool = at(Vec3(0.0, -0.001, 0.0));
    tool.twist_world.linear_m_s = {0.05, -0.1, 0.0};
    EXPECT_NEAR(hand.model->step(tool, {}).wrench_world.force_n.y(), at_rest + 0.2, 0.001);
    tool.twist_world.linear_m_s = {0.0, 50.0, 0.0};
    EXPECT_EQ(hand.model->step(tool, {}).wrench_world.force_n.norm(), 0.0);
    tool.twist_world.linear_m_s.setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_NEAR(hand.model->step(tool, {}).wrench_world.force_n.y(), at_rest, 0.001);
}

TEST(Surface, a_tool_too_deep_is_pushed_by_at_most_the_limit) {
    SurfaceSettings settings = plain();
    settings.force_n_max = 3.0;
    Hand hand(plane(), settings, Vec3(0.0, 0.01, 0.0));
    EXPECT_NEAR(hand.lead(Vec3(0.0, -0.01, 0.0)).norm(), 3.0, 1e-9);
    EXPECT_EQ(hand.model->released(), 0U);
}

TEST(Surface, a_tool_far_beyond_the_limit_is_released_without_a_force_step) {
    SurfaceSettings settings = plain();
    settings.force_n_max = 3.0;
    Hand hand(plane(), settings, Vec3(0.0, 0.01, 0.0));
    Vec3 before = hand.lead(Vec3(0.0, -0.01, 0.0));
    for (int i = 0; i < 400; ++i) {
        const Vec3 force = hand.step(Vec3(0.0, -0.01 - 4e-5 * i, 0.0));
        ASSERT_LT((force - before).norm(), 0.06);
        before = force;
    }
    EXPECT_EQ(hand.model->released(), 1U);
    EXPECT_EQ(before.norm(), 0.0);
    EXPECT_LT(hand.lead(Vec3(0.0, 0.002, 0.0)).y(), -0.9);  // from now on the force pushes from below
}

TEST(Surface, the_proxy_follows_a_jump_and_a_step_out_of_time_reports_it) {
    Hand hand(rough(), plain(0.001), slide(0.0, -0.005));
    (void)hand.lead(slide(0.0, 0.001));
    Budget hurried;
    hurried.deadline = instant_from_ns(0);
    StepResult result = hand.model->step(at(slide(1.0, 0.001)), hurried);
    EXPECT_EQ(result.status, StepStatus::out_of_time);
    EXPECT_GT(result.load.error, 0.0);
    (void)hand.lead(slide(1.0, -0.02));
    EXPECT_LT((hand.proxy() - hand.place).norm(), 1e-9);
}

TEST(Surface, a_reset_inside_a_closed_surface_seats_the_tool_outside) {
    Hand hand(box(), plain(0.002), Vec3(0.003, 0.016, 0.001));
    EXPECT_LT((hand.proxy() - Vec3(0.003, 0.022, 0.001)).norm(), 1e-5);
    EXPECT_NEAR(hand.step(hand.place).y(), kStiffness * 0.006, 0.006);
    Hand corner(box(), plain(0.002), Vec3(0.0195, 0.0196, 0.0197));
    (void)corner.lead(corner.place);
    EXPECT_GT(corner.proxy().maxCoeff(), 0.0219);
}

TEST(Surface, the_clutch_releases_the_tool_and_grips_it_at_its_new_position) {
    Hand hand(plane(), plain(0.001), Vec3(0.0, 0.01, 0.0));
    const double felt = hand.lead(Vec3(0.0, -0.002, 0.0)).norm();
    ToolState tool = at(hand.place);
    tool.buttons = 1;
    double before = felt;
    for (int i = 0; i < 600; ++i) {
        const double now = hand.model->step(tool, {}).wrench_world.force_n.norm();
        ASSERT_LT(std::abs(now - before), 0.05);
        before = now;
    }
    EXPECT_EQ(before, 0.0);
    // The tool is now on the other side.
    for (int i = 0; i < 300; ++i) (void)hand.model->step(at(Vec3(0.0, -0.01, 0.0)), {});
    EXPECT_LT(hand.lead(Vec3(0.0, 0.002, 0.0)).y(), -1.0);
}

TEST(Surface, a_baked_scene_loads_and_lies_below_the_hand) {
    SceneWriter out;
    SurfaceInput input;
    input.title = "rough";
    input.mesh = rough_sphere(10);
    const BakedSurface baked = bake_surface(std::move(input), out);
    EXPECT_TRUE(baked.closed);
    EXPECT_EQ(baked.triangles, 2000U);
    EXPECT_LT(baked.bytes_per_triangle, 100.0);
    ASSERT_TRUE(baked.shape.has_value());
    EXPECT_FALSE(baked.shape_without_locality.has_value());
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "baked.tact");
    EXPECT_EQ(file.count({'M', 'E', 'S', 'H'}), 1U);
    EXPECT_EQ(file.count({'F', 'R', 'S', 'T'}), 1U);
    const auto model = load_surface_model(file, {});
    const SurfaceMesh mesh = read_surface(file);
    const Vec3 low = model->meta().to_world(mesh.low_m()), high = model->meta().to_world(mesh.high_m());
    EXPECT_NEAR((high - low).norm(), 0.15, 1e-6);
    EXPECT_NEAR(high.y(), -SurfaceInput::kBelowM, 1e-6);
    EXPECT_NEAR((low + high).x(), 0.0, 1e-6);
    const VertexForest forest = read_forest(file, mesh.all_positions_m(), mesh.all_corners());
    EXPECT_EQ(forest.triangles(), 2000U);  // the reader would refuse a forest of another surface
    // Vertices were renumbered; the normals still point out of the sphere.
    for (std::uint32_t v = 0; v < mesh.vertices(); ++v)
        ASSERT_GT(mesh.normal(v).dot(mesh.position_m(v).normalized()), 0.5);
}

TEST(Surface, a_scene_without_forest_is_smaller_and_still_loads) {
    SceneWriter out;
    SurfaceInput input;
    input.mesh = rough_sphere(6);
    input.forest = input.picture = false;
    EXPECT_LT(bake_surface(std::move(input), out).bytes_per_triangle, 40.0);
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "baked.tact");
    EXPECT_EQ(file.count({'F', 'R', 'S', 'T'}), 0U);
    EXPECT_NE(load_surface_model(file, {}), nullptr);
}

TEST(Surface, a_wrong_scene_or_setting_is_refused) {
    SceneMeta meta = plane().meta;
    EXPECT_THROW(SurfaceModel(meta, plane().mesh, {.radius_m = -1.0}), StartupError);
    EXPECT_THROW(SurfaceModel(meta, plane().mesh, {.stiffness_n_m = 0.0}), StartupError);
    EXPECT_THROW(SurfaceModel(meta, plane().mesh, {.friction = std::nan("")}), StartupError);
}

}  // namespace
}  // namespace tact::force_surface_test
