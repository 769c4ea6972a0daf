// Dust in the window equals the bone that the controller removed, to the level: servo loop, region, site effects.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <optional>

#include "gui/drilling/site_effects.hpp"
#include "hal/sim/sim_device.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/drill_publisher.hpp"
#include "tests/scenario/lockstep.hpp"
#include "tests/support/bone_block.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kEdge = 64;

SceneMeta meta_of_block() {
    SceneMeta m{};
    m.kind = SceneKind::drilling;
    m.world_per_model = 1.0;
    for (double& c : m.centre_model_m) c = 0.016;
    return m;
}

// A wall of bone in a region, as tact-rt has it, and a window that reads it.
struct WatchedDrill {
    BoneBlock block{kEdge, 5e-4, [](const Vec3& v) { return v.z() < 22.0 ? 1.0 : 0.0; }, 1};
    OwnedBoneRegion region{head()};
    std::optional<DrillBone> bone;
    std::optional<DrillModel> model;
    std::optional<Lockstep> loop;
    std::optional<DrillPublisher> publisher;
    MappedBoneRegion mapped;
    BoneVolumeView baked;
    std::optional<BoneFollower> follower;
    std::optional<SiteEffects> site;

    WatchedDrill() {
        std::copy(block.density.begin(), block.density.end(), region.densities().begin());
        region.mark_ready();
        bone.emplace(block.bricks, region.densities(), region.revisions());
        DrillSettings burr;
        burr.tool.radius_m = 2e-3;
        burr.tool.shaft_radius_m = 0.0;
        burr.burr_rad_s = 6283.0;
        model.emplace(meta_of_block(), *bone, burr);
        ServoSettings servo;
        servo.visual_paths = kBonePaths;
        SimSettings sim;
        sim.hand.script = "drill";
        sim.hand.press_m = 0.012;
        loop.emplace(servo, sim, nullptr, &*model, SecondHand{}, DriveInput{DriveSwitch::always});
        publisher.emplace(loop->region_->drill, loop->region_->touch, DrillRates{.irrigation_m3_s = 3e-7});
        model->publish_to(*publisher);
        std::string refusal;
        mapped = MappedBoneRegion::map(FileDescriptor(fcntl(region.fd(), F_DUPFD_CLOEXEC, 0)), refusal);
        baked.bricks = block.bricks;
        baked.density = block.density;
        follower.emplace(baked, 5);
        EXPECT_EQ(follower->attach(mapped), "") << refusal;
        site.emplace(follower->volume(), BoneLabelsView{}, 1.0);
    }
    BoneRegionHead head() const {
        BoneRegionHead h{};
        h.scene_checksum = 5;
        h.bricks = block.bricks.brick_count();
        h.brick_bytes = BoneBricks::kVoxels;
        for (std::uint32_t& n : h.size) n = kEdge;
        h.voxel_m = block.bricks.voxel_m;
        return h;
    }
    DrillTopic drill() const {
        DrillTopic t{};
        static_cast<void>(loop->region_->drill.read(t));
        return t;
    }
    // A frame of the given duration; reads few bricks, so that some wait.
    std::size_t frame(int ms) {
        loop->cycles(ms);
        const DrillTopic topic = drill();
        const auto changes = follower->follow(5);
        site->step({1e-3 * ms, &topic, changes, 1.0F, Vec3(0.016, 0.016, 0.2)});
        return changes.size();
    }
};

TEST(SiteScenario, all_bone_that_the_burr_removed_is_dust_or_accounted_for) {
    WatchedDrill watched;
    watched.loop->active();
    for (int i = 0; i < 150; ++i) watched.frame(17);
    watched.loop->order(CommandKind::disarm);
    watched.frame(17);
    for (int i = 0; i < 100 && watched.frame(1) > 0; ++i) {
    }
    const std::uint64_t removed = watched.drill().removed_levels;
    EXPECT_GT(removed, 255U * 100U);
    const Ledger& ledger = watched.site->particles().ledger();
    EXPECT_EQ(ledger.drilled, removed);
    EXPECT_TRUE(ledger.balances());
    EXPECT_GT(ledger.carried, 0U);
    EXPECT_LT(ledger.pooled, 50U * 255U);
    EXPECT_GT(watched.site->metrics().drilling_s, 1.0);
    EXPECT_LE(watched.site->metrics().seen_s, watched.site->metrics().drilling_s);
}

}  // namespace
}  // namespace tact
