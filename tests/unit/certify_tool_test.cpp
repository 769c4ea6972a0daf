// The live model of a mesh tool against its reference, on rough ground and on a coarse sphere.
#include <gtest/gtest.h>

#include "prep/surface/bake_surface.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "tests/reference/certify.hpp"
#include "tests/unit/force_surface_meshes.hpp"

namespace tact::certify_tool_test {
namespace {

using namespace surface_test;

void expect_kept(const char* name, const TriangleMesh& mesh, const char* tool, std::uint32_t points) {
    SceneWriter out;
    SurfaceInput input;
    input.mesh = mesh;
    input.tool = made_tool(tool);
    input.tool_sampling.points = points;
    input.picture = input.forest = false;
    static_cast<void>(bake_surface(std::move(input), out));
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, name);
    reference::Promises promises;
    certify_tool(scene, {.poses = 250'000, .seed = 3, .progress = {}}, promises);
    ASSERT_EQ(promises.size(), 5U);
    for (const reference::Promise& p : promises) {
        EXPECT_GT(p.steps, 300U) << name << ", " << p.name;
        EXPECT_EQ(p.violations, 0U) << name << ", " << p.name << ": " << p.worst_ratio << " at "
                                    << p.worst_at;
    }
}

TEST(CertifyTool, keeps_every_promise) {
    expect_kept("rough terrain", uneven_terrain(4, 40, 0.05, 1e-3), "block", 300);
    expect_kept("rough sphere", rough_sphere(30), "scaler", 300);
    expect_kept("coarse sphere", smooth_sphere(8), "block", 200);
}

}  // namespace
}  // namespace tact::certify_tool_test
