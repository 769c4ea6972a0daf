// The live model of a mesh tool against its reference, on rough ground, on a coarse sphere and on a scanned mesh.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "prep/mesh_file/import_mesh.hpp"
#include "prep/surface/bake_surface.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "tests/reference/certify.hpp"
#include "tests/unit/force_surface_meshes.hpp"

namespace tact::certify_tool_test {
namespace {

using namespace surface_test;

void expect_kept(const char* name, const TriangleMesh& mesh, const char* tool, std::uint32_t points,
                 const CertifySettings& settings = {.poses = 250'000, .seed = 3, .progress = {}}) {
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
    certify_tool(scene, settings, promises);
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

// A point that turned and slid sank by up to 12 margins, in one of 2000 excursions; and a tool beside an edge was called settled by
// the plane of a triangle that it did not touch.
TEST(CertifyTool, keeps_every_promise_on_a_scanned_mesh) {
    const char* const shared = std::getenv("TACT_SHARED");
    const std::filesystem::path file = std::filesystem::path(shared != nullptr ? shared : "../shared") /
                                       "data" / "meshes" / "beetle_alt_open.obj.gz";
    if (!std::filesystem::is_regular_file(file))
        GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    expect_kept("beetle_alt_open", import_mesh(file).mesh, "block", 1000,
                {.poses = 300'000, .seed = 41, .progress = {}});
}

}  // namespace
}  // namespace tact::certify_tool_test
