// The live surface model against its reference, on rough terrain, on triangles turned both ways and on a coarse sphere.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>

#include "ipc/scene/file/scene_meta.hpp"
#include "prep/surface/clean_mesh.hpp"
#include "tests/reference/certify.hpp"
#include "tests/unit/force_surface_fixture.hpp"
#include "tests/unit/force_surface_meshes.hpp"

namespace tact::certify_surface_test {
namespace {

using namespace surface_test;

void expect_kept(const std::string& name, const TriangleMesh& mesh, double world_per_model,
                 std::uint64_t poses) {
    SceneWriter out;
    write_surface(out, build_surface(mesh));
    SceneMeta meta{};
    meta.kind = SceneKind::surface;
    meta.world_per_model = world_per_model;
    meta.map_sigma = 1.0;
    write_meta(out, meta, "");
    const std::vector<std::byte> bytes = out.to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, name);
    const reference::Promises promises = certify(scene, {.poses = poses, .seed = 6, .progress = {}});
    ASSERT_EQ(promises.size(), 6U);
    for (const reference::Promise& p : promises) {
        EXPECT_GT(p.steps, 100U) << name << ", " << p.name;
        EXPECT_EQ(p.violations, 0U) << name << ", " << p.name << ": " << p.worst_ratio << " at "
                                    << p.worst_at;
    }
}

TEST(CertifySurface, keeps_every_promise) {
    const std::pair<const char*, TriangleMesh> meshes[] = {
        {"rough terrain", uneven_terrain(4)},
        {"terrain, flipped", with_flipped(uneven_terrain(4, 30, 0.03, 2e-4), 0.3, 5)},
        {"coarse sphere", smooth_sphere(8)}};
    for (const auto& [name, mesh] : meshes) {
        expect_kept(name, mesh, 1.0, 60'000);
    }
}

// Gears: a ball that starts inside of one, beside a gap that is too narrow for it.
TEST(CertifySurface, keeps_every_promise_on_scanned_meshes) {
    const char* const shared = std::getenv("TACT_SHARED");
    const std::filesystem::path folder =
        std::filesystem::path(shared != nullptr ? shared : "../shared") / "data" / "meshes";
    if (!std::filesystem::is_directory(folder))
        GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    for (const char* name : {"gears_ascii.stl.gz", "fandisk.obj", "stanford_bunny.obj", "dragon_100k.ply"}) {
        TriangleMesh mesh = import_mesh(folder / name).mesh;
        static_cast<void>(clean_mesh(mesh));  // as in every baked scene
        Eigen::AlignedBox3d box;
        for (std::size_t i = 0; i < mesh.position_m.size(); i += 3)
            box.extend(Vec3(static_cast<double>(mesh.position_m[i]),
                            static_cast<double>(mesh.position_m[i + 1]),
                            static_cast<double>(mesh.position_m[i + 2])));
        expect_kept(name, mesh, 0.15 / box.diagonal().norm(), 300'000);
    }
}

}  // namespace
}  // namespace tact::certify_surface_test
