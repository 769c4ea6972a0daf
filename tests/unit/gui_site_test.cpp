// Dust, water, blood and suction around a burr, and whether the burr is visible.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "gui/drilling/bench_particles.hpp"
#include "gui/drilling/burr_sight.hpp"
#include "gui/drilling/dust_state.hpp"
#include "gui/drilling/site_effects.hpp"

namespace tact::gui_site_test {
namespace {

constexpr std::size_t kVoxels = BoneBricks::kVoxels;

// A block of bone, empty above z = 24, with a vessel of label 1 ("Sigmoid Sinus") at x < 8.
struct Block {
    BoneVolumeView view;
    BoneLabelsView labels;
    std::vector<std::uint8_t> density, label;
    std::vector<std::uint8_t> before, after;
    std::vector<BrickChange> changes;
    DrillTopic drill{};

    Block() {
        view.bricks.size = {48, 48, 48};
        view.bricks.voxel_m = 3e-4;
        density.assign(view.bricks.bytes(), 0);
        label.assign(view.bricks.bytes(), 0);
        for (std::uint32_t z = 0; z < 24; ++z)
            for (std::uint32_t y = 0; y < 48; ++y)
                for (std::uint32_t x = 0; x < 48; ++x) {
                    density[view.bricks.voxel(x, y, z)] = 240;
                    label[view.bricks.voxel(x, y, z)] = x < 8 ? 1 : 0;
                }
        view.density = density;
        labels.structure.push_back({"Sigmoid Sinus", {}, true});
        labels.label = label;
        DrillHand& burr = drill.hand[0];
        burr.kind = DrillKind::burr;
        burr.radius_m = 1.5e-3F;
        burr.quat_model_tool_xyzw[3] = 1.0;
        drill.hand[1].quat_model_tool_xyzw[3] = 1.0;
        drill.irrigation_m3_s_most = 3e-7F;
        place(24, 24, 26);
    }
    void place(double x, double y, double z) {
        const Vec3 at = view.bricks.to_model(Vec3(x, y, z));
        std::copy(at.begin(), at.end(), drill.hand[0].pos_model_m);
    }
    // Removes up to so many levels from the voxels of a layer within 3 voxels of (x0, y0). Returns the levels removed.
    std::uint64_t cut(std::uint32_t x0, std::uint32_t y0, std::uint32_t z, std::uint8_t levels,
                      bool now = true) {
        before = density;
        std::uint64_t lost = 0;
        for (std::uint32_t y = y0 - 3; y <= y0 + 3; ++y)
            for (std::uint32_t x = x0 - 3; x <= x0 + 3; ++x) {
                std::uint8_t& v = density[view.bricks.voxel(x, y, z)];
                const std::uint8_t off = std::min(v, levels);
                v = static_cast<std::uint8_t>(v - off);
                lost += off;
            }
        tell(now);
        return lost;
    }
    // Bone comes back.
    void restore(const std::vector<std::uint8_t>& whole) {
        before = density;
        density = whole;
        tell(true);
    }
    void tell(bool now) {
        after = density;
        changes.clear();
        for (std::size_t i = 0; i < view.bricks.brick_count(); ++i)
            changes.push_back({static_cast<std::uint32_t>(i),
                               std::span<const std::uint8_t>(before).subspan(i * kVoxels, kVoxels),
                               std::span<const std::uint8_t>(after).subspan(i * kVoxels, kVoxels), now});
    }
    SiteEffects::Frame frame() const {
        return {0.02, &drill, changes, 1.0F, view.bricks.to_model(Vec3(24, 24, 200))};
    }
};

std::size_t count(const SiteEffects& site, Matter matter) {
    const auto all = site.particles().all();
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [matter](const Particle& p) { return p.matter == matter; }));
}

TEST(SiteEffects, the_dust_equals_the_bone_removed) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    std::uint64_t lost = 0;
    for (std::uint32_t z = 23; z > 15; --z) {
        lost += bone.cut(24, 24, z, 130);
        site.step(bone.frame());
    }
    EXPECT_EQ(site.particles().ledger().drilled, lost);
    EXPECT_TRUE(site.particles().ledger().balances());
    EXPECT_GT(count(site, Matter::dust), 30U);
    // Bone that was drilled before the window opened makes no dust.
    static_cast<void>(bone.cut(24, 24, 12, 200, false));
    site.step(bone.frame());
    EXPECT_EQ(site.particles().ledger().drilled, lost);
}

// What the panel shows adds up to what was removed, while grains are given up, sucked, washed away and buried.
TEST(SiteEffects, dust_that_is_shown_is_all_of_the_bone_that_was_removed) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    constexpr double kLevelM3 = 1e-13;
    bone.drill.hand[1].kind = DrillKind::suction_tube;
    bone.drill.hand[1].radius_m = 1e-3F;
    const Vec3 tip = bone.view.bricks.to_model(Vec3(24, 24, 25));
    std::copy(tip.begin(), tip.end(), bone.drill.hand[1].pos_model_m);
    const std::vector<std::uint8_t> whole = bone.density;
    std::uint64_t lost = 0;
    const auto sum_m3 = [&] {
        const DrillingState::Dust d = dust_of(site.particles().ledger(), kLevelM3);
        return d.here_m3 + d.sucked_m3 + d.flown_m3 + d.buried_m3;
    };
    for (int i = 0; i < 60; ++i) {
        lost += bone.cut(14 + static_cast<std::uint32_t>(i % 20), 24, 23 - static_cast<std::uint32_t>(i / 10),
                         200);
        bone.drill.hand[1].suction = i > 30 ? 1.0F : 0.0F;
        SiteEffects::Frame frame = bone.frame();
        frame.level = i % 3 == 0 ? 1e-4F : 1.0F;  // hardly any particle may stay
        site.step(frame);
        ASSERT_NEAR(sum_m3(), kLevelM3 * static_cast<double>(lost), 1e-9 * kLevelM3) << i;
    }
    bone.restore(whole);
    site.step(bone.frame());
    EXPECT_NEAR(sum_m3(), kLevelM3 * static_cast<double>(lost), 1e-9 * kLevelM3);
    const DrillingState::Dust d = dust_of(site.particles().ledger(), kLevelM3);
    EXPECT_GT(d.sucked_m3, 0.0);
    EXPECT_GT(d.here_m3, 0.0);
}

// A cut is undone: no particle is left in bone, none is lost from the ledger, and the wound there bleeds no more.
TEST(SiteEffects, where_bone_comes_back_are_no_particles_and_no_wounds) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    const std::vector<std::uint8_t> whole = bone.density;
    for (std::uint32_t z = 23; z > 19; --z) {  // a vessel
        static_cast<void>(bone.cut(5, 24, z, 255));
        site.step(bone.frame());
    }
    bone.changes.clear();
    for (int i = 0; i < 20; ++i) site.step(bone.frame());
    ASSERT_GT(count(site, Matter::blood), 20U);
    const auto in_bone = [&] {
        const auto all = site.particles().all();
        return std::count_if(all.begin(), all.end(), [&](const Particle& p) {
            return site.particles().cells().bone(
                {static_cast<int>(p.at[0]), static_cast<int>(p.at[1]), static_cast<int>(p.at[2])});
        });
    };
    bone.restore(whole);
    ASSERT_GT(in_bone(), 20);
    site.step(bone.frame());
    EXPECT_EQ(in_bone(), 0);
    EXPECT_GT(site.particles().ledger().buried, 0U);
    EXPECT_TRUE(site.particles().ledger().balances());
    bone.changes.clear();
    const std::size_t blood = count(site, Matter::blood);
    for (int i = 0; i < 20; ++i) site.step(bone.frame());
    EXPECT_LE(count(site, Matter::blood), blood);
}

TEST(SiteEffects, water_flows_during_irrigation_within_the_limit_of_the_particles) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    for (int i = 0; i < 25; ++i) site.step(bone.frame());
    EXPECT_EQ(count(site, Matter::water), 0U);
    bone.drill.hand[0].irrigation = 1.0F;
    for (int i = 0; i < 25; ++i) site.step(bone.frame());
    const std::size_t half_a_second = count(site, Matter::water);
    EXPECT_GT(half_a_second, 500U);
    EXPECT_LE(half_a_second, 5600U);  // 3e-7 m3/s in drops of 2.7e-11 m3
    bone.drill.irrigation_m3_s_most = 1.0F;
    SiteEffects flooded(bone.view, bone.labels, 1.0);
    for (int i = 0; i < 25; ++i) flooded.step(bone.frame());
    EXPECT_LE(count(flooded, Matter::water), 7500U);
}

TEST(SiteEffects, an_opened_vessel_bleeds_and_distant_bone_does_not) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    static_cast<void>(bone.cut(30, 24, 23, 240));
    site.step(bone.frame());
    bone.changes.clear();
    for (int i = 0; i < 50; ++i) site.step(bone.frame());
    EXPECT_EQ(count(site, Matter::blood), 0U);
    static_cast<void>(bone.cut(4, 24, 23, 240));
    site.step(bone.frame());
    bone.changes.clear();
    for (int i = 0; i < 50; ++i) site.step(bone.frame());
    EXPECT_GT(count(site, Matter::blood), 100U);
}

TEST(SiteEffects, marrow_bleeds_until_paste_seals_it) {
    Block bone;
    for (auto& v : bone.density) v = v > 0 ? 120 : 0;
    Bleeding bleeding(bone.view.bricks, {}, {}, 1);
    Particles particles(bone.view.bricks, bone.density,
                        {.most = 5000, .gravity_m_s2 = Vec3(0.0, 0.0, -9.81)});
    for (std::uint32_t x = 0; x < 48; ++x)
        for (std::uint32_t y = 0; y < 48; ++y) {
            bone.density[bone.view.bricks.voxel(x, y, 23)] = 0;
            bleeding.cut(x, y, 23, 120);
        }
    const std::size_t wounds = bleeding.wounds();
    EXPECT_GT(wounds, 10U);
    EXPECT_LT(wounds, 200U);
    for (std::uint32_t x = 0; x < 48; ++x)
        for (std::uint32_t y = 0; y < 48; ++y)
            ASSERT_TRUE(
                particles.emit(Matter::paste, bone.view.bricks.to_model(Vec3(x, y, 23)), Vec3::Zero()));
    for (int i = 0; i < 20; ++i) bleeding.step(0.1, 1000, particles);
    EXPECT_EQ(bleeding.wounds(), 0U);
    EXPECT_EQ(bleeding.drops(), 0U);
    bleeding.cut(99999, 0, 0, 120);  // outside the volume
    EXPECT_EQ(bleeding.wounds(), 0U);
}

TEST(SiteEffects, the_suction_tube_removes_particles_at_its_tip) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    bone.drill.hand[0].irrigation = 1.0F;
    for (int i = 0; i < 25; ++i) site.step(bone.frame());
    bone.drill.hand[0].irrigation = 0.0F;
    const std::size_t there = count(site, Matter::water);
    DrillHand& suction_tube = bone.drill.hand[1];
    suction_tube.kind = DrillKind::suction_tube;
    suction_tube.radius_m = 3e-3F;
    const Vec3 tip = bone.view.bricks.to_model(Vec3(24, 24, 27));
    std::copy(tip.begin(), tip.end(), suction_tube.pos_model_m);
    SiteEffects::Frame frame = bone.frame();
    for (int i = 0; i < 25; ++i) site.step(frame);
    const std::size_t without = count(site, Matter::water);
    suction_tube.suction = 1.0F;
    for (int i = 0; i < 25; ++i) site.step(bone.frame());
    EXPECT_LT(count(site, Matter::water), without / 2);
    EXPECT_GT(without, there / 4);
    EXPECT_FALSE(site.metrics().suction_blocked);
    suction_tube.pos_model_m[2] = bone.view.bricks.to_model(Vec3(24, 24, 8)).z();
    site.step(bone.frame());
    EXPECT_TRUE(site.metrics().suction_blocked);
}

TEST(SiteEffects, the_level_bounds_the_number_of_particles) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    bone.drill.hand[0].irrigation = 1.0F;
    SiteEffects::Frame frame = bone.frame();
    for (int i = 0; i < 60; ++i) site.step(frame);
    EXPECT_GT(site.metrics().alive, 3000U);
    frame.level = 0.02F;
    // Surplus particles are removed within the time of a step: how many steps that takes depends on the machine.
    for (int i = 0; i < 2000 && site.metrics().alive > 2000; ++i) site.step(frame);
    EXPECT_LE(site.metrics().alive, 2000U);
    EXPECT_EQ(site.metrics().most, SiteEffects::kMost);
    EXPECT_TRUE(site.particles().ledger().balances());
}

TEST(SiteEffects, a_lower_level_takes_effect_on_the_first_frame) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    site.keep(30000);
    SiteEffects::Frame frame = bone.frame();
    site.step(frame);
    const std::size_t before = site.particles().shown().size();
    ASSERT_GT(before, 20000U);
    EXPECT_EQ(before, site.particles().all().size());
    frame.level = 0.01F;
    site.step(frame);
    EXPECT_LE(site.particles().shown().size(), SiteEffects::kMost / 100);
    EXPECT_EQ(site.metrics().shown, site.particles().shown().size());
    EXPECT_GT(site.particles().all().size(), before / 2);  // one frame has no time to remove them all
    EXPECT_TRUE(site.particles().ledger().balances());
    frame.level = 1.0F;
    site.step(frame);
    EXPECT_EQ(site.particles().shown().size(), site.particles().all().size());
}

TEST(SiteEffects, keeps_the_number_asked_for_by_a_measurement) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    bone.drill.hand[1].suction = 1.0F;
    std::uint64_t gone = 0;
    for (int i = 0; i < 100; ++i) {
        site.keep(2000);
        site.step(bone.frame());
        gone += 2000 - std::min<std::uint64_t>(site.particles().all().size(), 2000);
        EXPECT_GE(site.particles().all().size(), 1800U) << i;
    }
    EXPECT_GT(gone, 0U);  // and were replaced
    EXPECT_GT(count(site, Matter::paste), 300U);
    SiteEffects::Frame half = bone.frame();
    half.level = 0.01F;
    for (int i = 0; i < 20; ++i) site.step(half);
    EXPECT_LE(site.particles().all().size(), SiteEffects::kMost / 100);  // no more than the level allows
    site.keep(1000000);
    site.step(bone.frame());
    EXPECT_LE(site.particles().all().size(), SiteEffects::kMost);
}

TEST(SiteEffects, survives_extreme_records_of_a_controller) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    SiteEffects::Frame frame = bone.frame();
    frame.drill = nullptr;
    frame.dt_s = 1e9;
    site.step(frame);
    frame = bone.frame();
    DrillHand& burr = bone.drill.hand[0];
    burr.irrigation = 1.0F;
    burr.burr_rad_s = 1e6F;
    burr.depth = 2.0F;
    burr.radius_m = 1.0F;
    burr.pos_model_m[0] = 999.0;
    bone.drill.irrigation_m3_s_most = 1.0F;
    for (int i = 0; i < 5; ++i) site.step(frame);
    burr.pos_model_m[0] = 0.0;
    burr.radius_m = std::numeric_limits<float>::min();
    for (int i = 0; i < 5; ++i) site.step(frame);
    frame.level = std::numeric_limits<float>::quiet_NaN();
    site.step(frame);
    EXPECT_TRUE(site.particles().ledger().balances());
}

TEST(BurrSight, blood_dust_and_bone_hide_the_head_and_water_does_not) {
    const Block bone;
    const auto seen = [&](Matter matter, int layers) {
        Particles particles(bone.view.bricks, bone.density,
                            {.most = 20000, .gravity_m_s2 = Vec3(0.0, 0.0, -9.81)});
        for (int z = 0; z < layers; ++z)
            for (int y = 10; y < 38; ++y)
                for (int x = 10; x < 38; ++x)
                    EXPECT_TRUE(
                        particles.emit(matter, bone.view.bricks.to_model(Vec3(x, y, 34 + z)), Vec3::Zero()));
        return share_seen(particles, bone.view.bricks.to_model(Vec3(24, 24, 26)), 1.5e-3,
                          bone.view.bricks.to_model(Vec3(24, 24, 300)));
    };
    EXPECT_EQ(seen(Matter::blood, 0), 1.0);
    EXPECT_LT(seen(Matter::blood, 2), 0.1);
    EXPECT_LT(seen(Matter::dust, 2), 0.1);
    EXPECT_GT(seen(Matter::water, 2), 0.7);
    Particles none(bone.view.bricks, bone.density, {.most = 10});
    const Vec3 head = bone.view.bricks.to_model(Vec3(24, 24, 30));
    EXPECT_EQ(share_seen(none, head, 1.5e-3, bone.view.bricks.to_model(Vec3(24, 24, -300))),
              0.0);  // hidden by bone
    EXPECT_EQ(share_seen(none, head, 1.5e-3, Vec3::Constant(std::nan(""))), 0.0);
}

TEST(ParticlesBench, reports_the_cost_of_a_move_and_the_budget_error) {
    EXPECT_EQ(ParticlesBenchSettings{}.counts, (std::vector<std::uint32_t>{1000, 10000, 100000, 200000}));
    const auto all = bench_particles({.counts = {1000, 10000, 100000}, .steps = 8, .budget_s = 1e-5});
    for (const char* const key : {"particle_ns_each", "particle_budget_error", "particle_budget_error_p99",
                                  "particle_ns_each_1000", "particle_moves_10000", "particles_alive_100000",
                                  "particle_step_us_p50", "particle_step_us_p999_1000"}) {
        ASSERT_TRUE(all.contains(key)) << key;
        EXPECT_TRUE(std::isfinite(all[key].get<double>())) << key;
    }
    EXPECT_GT(all["particle_ns_each"], 0.0);
    EXPECT_LE(all["particle_moves_1000"], 1000.0);
    EXPECT_LE(all["particle_step_us_p50_1000"], all["particle_step_us_max_1000"]);
    EXPECT_EQ(all["particle_budget_error"], all["particle_budget_error_100000"]);
}

TEST(SiteEffects, counts_the_time_the_burr_was_visible_while_drilling) {
    Block bone;
    SiteEffects site(bone.view, bone.labels, 1.0);
    DrillHand& burr = bone.drill.hand[0];
    for (int i = 0; i < 10; ++i) site.step(bone.frame());
    EXPECT_EQ(site.metrics().drilling_s, 0.0);  // the burr stands still
    burr.burr_rad_s = 3000.0F;
    burr.depth = 0.3F;
    for (int i = 0; i < 50; ++i) site.step(bone.frame());
    EXPECT_NEAR(site.metrics().drilling_s, 1.0, 1e-9);
    EXPECT_NEAR(site.metrics().seen_s, 1.0, 1e-9);
    SiteEffects::Frame from_below = bone.frame();
    from_below.eye_model_m = bone.view.bricks.to_model(Vec3(24, 24, -200));
    bone.place(24, 24, 20);
    for (int i = 0; i < 50; ++i) site.step(from_below);
    EXPECT_NEAR(site.metrics().drilling_s, 2.0, 1e-9);
    EXPECT_LT(site.metrics().seen_s, 1.1);
}

}  // namespace
}  // namespace tact::gui_site_test
