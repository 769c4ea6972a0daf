// A tool over triangles much smaller than a step: the half-spaces of a full step's path do not fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prep/surface/build_surface.hpp"
#include "prep/surface/sample_tool.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "rt/force/surface/tool_model.hpp"

namespace tact::force_tool_dense_test {
namespace {

// A bumpy patch of 10 x 6 mm, y up, with edges of 0.025 mm.
TriangleMesh dense_patch() {
    constexpr std::uint32_t kX = 400, kZ = 240;
    constexpr double kEdgeM = 2.5e-5;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i <= kX; ++i)
        for (std::uint32_t k = 0; k <= kZ; ++k) {
            const double x = kEdgeM * (i - 0.5 * kX), z = kEdgeM * (k - 0.5 * kZ);
            const double y = 5e-5 * std::sin(4e3 * x) * std::cos(5e3 * z);
            for (const double c : {x, y, z}) mesh.position_m.push_back(static_cast<float>(c));
        }
    for (std::uint32_t i = 0; i < kX; ++i)
        for (std::uint32_t k = 0; k < kZ; ++k) {
            const std::uint32_t a = i * (kZ + 1) + k, b = a + kZ + 1;
            mesh.triangle.insert(mesh.triangle.end(), {a, b + 1, b, a, a + 1, b + 1});
        }
    return mesh;
}

TEST(DenseSurface, does_not_hold_the_tool_back) {
    TriangleMesh block = made_tool("block");  // 16 mm wide
    for (float& x : block.position_m) x *= 0.2F;
    SceneWriter out;
    write_surface(out, build_surface(dense_patch()));
    write_touch_tool(out, sample_tool(block, {.points = 1000}));
    const auto bytes = out.to_bytes();
    const SceneFile file = SceneFile::from_bytes(bytes, "dense.tact");
    const SurfaceMesh mesh = read_surface(file);
    SceneMeta meta{};
    meta.kind = SceneKind::surface;
    meta.world_per_model = 1.0;
    ToolModel model(meta, mesh, read_touch_tool(file),
                    {.damping_n_s_m = 0.0, .friction = 0.1, .force_n_max = 100.0});
    ToolState hand;
    const auto behind_m = [&] { return (model.contact().proxy().p_m - hand.T_world_tool.p_m).norm(); };
    hand.T_world_tool.p_m = {-0.0025, 0.004, 0.0};
    model.reset(hand);
    for (int i = 0; i < 600; ++i) {
        hand.T_world_tool.p_m.y() = std::max(5e-4, 4e-3 - 1e-5 * i);
        (void)model.step(hand, {});
    }
    const double deep_m = behind_m();
    EXPECT_GT(deep_m, 3e-4);
    double farthest_m = 0.0;
    for (int i = 0; i < 125; ++i) {  // 5 mm at 40 mm/s
        hand.T_world_tool.p_m.x() += 4e-5;
        (void)model.step(hand, {});
        farthest_m = std::max(farthest_m, behind_m());
    }
    // A stuck proxy would be 5 mm behind.
    EXPECT_LT(farthest_m, deep_m + 1e-3);
}

}  // namespace
}  // namespace tact::force_tool_dense_test
