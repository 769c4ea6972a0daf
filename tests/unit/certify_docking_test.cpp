// The live docking model against its reference, on a helix in its map.
#include <gtest/gtest.h>

#include "tests/reference/certify.hpp"
#include "tests/support/small_scene.hpp"

namespace tact::certify_docking_test {
namespace {

TEST(CertifyDocking, keeps_every_promise) {
    const std::vector<std::byte> bytes = small_scene().to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "helix");
    const reference::Promises promises = certify(scene, {.poses = 2000, .seed = 3, .progress = {}});
    ASSERT_EQ(promises.size(), 5U);
    for (const reference::Promise& p : promises) {
        EXPECT_GT(p.steps, 5U) << p.name;
        EXPECT_EQ(p.violations, 0U) << p.name << ": " << p.worst_ratio << " at " << p.worst_at;
    }
}

}  // namespace
}  // namespace tact::certify_docking_test
