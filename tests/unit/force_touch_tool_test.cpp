// Points of a tool: sampling, section; the solver of their half-spaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "prep/surface/bake_surface.hpp"
#include "rt/force/surface/twist_half_spaces.hpp"
#include "tests/unit/force_tool_fixture.hpp"

namespace tact::force_touch_tool_test {
namespace {

using namespace tool_test;

TEST(TouchTool, every_prefix_of_the_points_is_an_even_sampling) {
    const TriangleMesh mesh = box_mesh({0.015, 0.005, 0.01});
    const TouchTool tool = sample_tool(mesh, {.points = 600});
    ASSERT_EQ(tool.points(), 600U);
    SeededRandom random(5);
    for (const std::size_t n : {8U, 40U, 200U, 600U}) {
        const double cover = tool.cover_m[n - 1], ball = tool.ball_m;
        double nearest = 1e9, farthest = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < i; ++k)
                nearest = std::min(nearest, (tool.at_m(i) - tool.at_m(k)).norm());
        for (int i = 0; i < 2000; ++i) {  // a point on the surface
            Vec3 p = random.direction();
            p = p.cwiseAbs().maxCoeff() > 0.0 ? Vec3(p / p.cwiseAbs().maxCoeff()) : p;
            p = p.cwiseProduct(Vec3(0.015, 0.005, 0.01));
            double least = 1e9;
            for (std::size_t k = 0; k < n; ++k) least = std::min(least, (tool.at_m(k) - p).norm());
            farthest = std::max(farthest, least);
        }
        EXPECT_LE(farthest, 1.15 * cover + 3.0 * ball) << n;
        EXPECT_GE(nearest, 0.66 * cover - 4.0 * ball) << n;
    }
    // The first points include all corners; every ball is inside and touches the surface.
    std::size_t corners = 0, stick_out = 0;
    for (std::size_t i = 0; i < tool.points(); ++i) {
        const Vec3 below = Vec3(0.015, 0.005, 0.01) - tool.at_m(i).cwiseAbs();
        if (i < 60 && below.maxCoeff() < 1.3 * tool.ball_m) ++corners;
        if (below.minCoeff() < 0.97 * tool.ball_m) ++stick_out;
        EXPECT_GT(below.minCoeff(), 0.0);
        EXPECT_LT(below.minCoeff(), 1.3 * tool.ball_m);
    }
    EXPECT_EQ(corners, 8U);
    EXPECT_LT(stick_out, 12U);
}

TEST(TouchTool, one_that_is_larger_than_the_mesh_is_reported) {
    for (const double size :
         {1.0, 1e3}) {  // a sphere of 0.1 m, in metres, and one in millimetres taken for metres
        SceneWriter out;
        SurfaceInput input;
        input.mesh = scaled(smooth_sphere(8), 1.0 / size);
        input.tool = made_tool("block");
        input.tool_sampling.points = 40;
        input.picture = input.forest = false;
        EXPECT_EQ(bake_surface(std::move(input), out).tool_too_large, size > 1.0);
    }
}

TEST(TouchTool, the_same_mesh_gives_the_same_tool_and_the_section_holds_it) {
    const TriangleMesh mesh = made_tool("scaler");
    SceneWriter out;
    const TouchTool a = sample_tool(mesh, {.points = 400, .grip_in_middle = false}),
                    b = sample_tool(mesh, {.points = 400, .grip_in_middle = false});
    EXPECT_EQ(a.point_m, b.point_m);
    write_touch_tool(out, a);
    const auto bytes = out.to_bytes();
    const TouchTool read = read_touch_tool(SceneFile::from_bytes(bytes, "t"));
    EXPECT_EQ(read.point_m, a.point_m);
    EXPECT_EQ(read.normal, a.normal);
    EXPECT_EQ(read.parent, a.parent);
    EXPECT_EQ(read.cover_m, a.cover_m);
    EXPECT_EQ(read.drawn, a.drawn);
    EXPECT_EQ(read.ball_m, a.ball_m);
}

TEST(TouchTool, a_wrong_section_is_refused) {
    const TouchTool good = sample_tool(box_mesh({0.01, 0.01, 0.01}), {.points = 20});
    const auto refused = [&](auto change) {
        TouchTool tool = good;
        change(tool);
        SceneWriter out;
        write_touch_tool(out, tool);
        const auto bytes = out.to_bytes();
        const SceneFile file = SceneFile::from_bytes(bytes, "t");
        EXPECT_THROW((void)read_touch_tool(file), StartupError);
    };
    refused([](TouchTool& t) { t.parent[3] = 3; });
    refused([](TouchTool& t) { t.parent[0] = 1; });
    refused([](TouchTool& t) { t.ball_m = 0.0; });
    refused([](TouchTool& t) { t.ball_m = std::nan(""); });
    refused([](TouchTool& t) { t.point_m[4] = std::nanf(""); });
    refused([](TouchTool& t) { t.cover_m[5] = 2.0F * t.cover_m[4] + 1.0F; });
    refused([](TouchTool& t) { t.drawn[2] = 8; });
    refused([](TouchTool& t) { t.point_m.pop_back(); });
    refused([](TouchTool& t) { t.parent.clear(); });
}

TEST(TouchTool, made_tools_are_closed_and_turned_outward) {
    for (const char* name : kMadeTools) {
        const TriangleMesh mesh = made_tool(name);
        EXPECT_TRUE(build_surface(mesh).closed) << name;
        double volume = 0.0;
        const auto at = [&](std::size_t i) {
            const float* p = mesh.position_m.data() + 3 * mesh.triangle[i];
            return Vec3(p[0], p[1], p[2]);
        };
        for (std::size_t t = 0; t < mesh.triangle.size(); t += 3)
            volume += at(t).dot(at(t + 1).cross(at(t + 2)));
        EXPECT_GT(volume, 0.0) << name;
    }
    EXPECT_EQ(made_tool("none").triangles(), 0U);
}

TEST(TwistHalfSpaces, the_solution_is_the_nearest_twist_inside_all_half_spaces) {
    SeededRandom random(11);
    const auto number = [&] { return 2.0 * random.uniform() - 1.0; };
    for (int trial = 0; trial < 60; ++trial) {
        TwistHalfSpaces half_spaces;
        const int count = 1 + static_cast<int>(random.below(40));
        std::vector<std::pair<Vec6, double>> plane;
        for (int i = 0; i < count; ++i) {
            const Vec3 n = random.direction(), lever(number(), number(), number());
            TriangleQueries look{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                look.away[axis][0] = static_cast<float>(n[static_cast<Eigen::Index>(axis)]);
            const auto slack = static_cast<float>(0.3 * random.uniform());
            ASSERT_TRUE(half_spaces.add(0, 0, lever.cast<float>(), look, 0, slack, slack, false));
            Vec6 normal;
            normal << n, lever.cross(n);
            plane.emplace_back(normal, static_cast<double>(slack));
        }
        Vec6 goal;
        for (double& x : goal) x = number();
        TwistHalfSpaces::Solution s = TwistHalfSpaces::fresh(goal);
        half_spaces.solve(goal, {1e-6}, s);
        ASSERT_TRUE(s.exact);
        Vec6 pushed = goal;
        for (std::size_t i = 0; i < s.active_count; ++i) {
            EXPECT_GE(s.active[i].weight_m, 0.0);
            EXPECT_NEAR(s.active[i].normal.dot(s.move_m) + s.active[i].slack_m, 0.0, 2e-6);
            pushed += s.active[i].weight_m * s.active[i].normal;
        }
        EXPECT_LT((pushed - s.move_m).norm(),
                  1e-9);  // with the weights above: the optimum (Karush-Kuhn-Tucker)
        for (const auto& [normal, slack] : plane) EXPECT_GT(normal.dot(s.move_m) + slack, -3e-6);
    }
}

}  // namespace
}  // namespace tact::force_touch_tool_test
