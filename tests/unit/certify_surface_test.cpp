// The live surface model against its reference, on rough terrain, on triangles turned both ways and on a coarse sphere.
#include <gtest/gtest.h>

#include "ipc/scene/file/scene_meta.hpp"
#include "tests/reference/certify.hpp"
#include "tests/unit/force_surface_fixture.hpp"
#include "tests/unit/force_surface_meshes.hpp"

namespace tact {
namespace {

using namespace surface_test;

TEST(CertifySurface, keeps_every_promise) {
    const std::pair<const char*, TriangleMesh> meshes[] = {
        {"rough terrain", uneven_terrain(4)},
        {"terrain, flipped", with_flipped(uneven_terrain(4, 30, 0.03, 2e-4), 0.3, 5)},
        {"coarse sphere", smooth_sphere(8)}};
    for (const auto& [name, mesh] : meshes) {
        SceneMeta meta{};
        meta.kind = SceneKind::surface;
        meta.world_per_model = 1.0;
        meta.map_sigma = 1.0;
        SceneWriter out;
        write_meta(out, meta, "");
        write_surface(out, build_surface(mesh));
        const std::vector<std::byte> bytes = out.to_bytes();
        const SceneFile scene = SceneFile::from_bytes(bytes, name);
        const reference::Promises promises = certify(scene, {.poses = 60'000, .seed = 2, .progress = {}});
        ASSERT_EQ(promises.size(), 6U);
        for (const reference::Promise& p : promises) {
            EXPECT_GT(p.steps, 100U) << p.name;
            EXPECT_EQ(p.violations, 0U)
                << name << ", " << p.name << ": " << p.worst_ratio << " at " << p.worst_at;
        }
    }
}

}  // namespace
}  // namespace tact
