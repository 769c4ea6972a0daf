// Strokes of the burr: undone and redone to the bit, without a step of the force, and the numbers that are published.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "ipc/topics/command.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/drill_publisher.hpp"
#include "tests/support/bone_block.hpp"

namespace tact {
namespace strokes_test {
namespace {

constexpr double kVoxelM = 3e-4, kFullRadS = 6283.0, kStepS = 1e-3;
constexpr std::uint32_t kEdge = 56;

std::uint64_t mass_of(const std::vector<std::uint8_t>& density) {
    return std::accumulate(density.begin(), density.end(), std::uint64_t{0});
}
ModelOrder order_of(CommandKind command) {
    ModelOrder o;
    o.kind = ModelOrder::Kind::setting;
    o.command = static_cast<std::uint8_t>(command);
    return o;
}
ToolState at(const Vec3& p_m) {
    ToolState tool;
    tool.T_world_tool.p_m = p_m;
    return tool;
}
DrillSettings burr(bool cuts = true) {
    DrillSettings s;
    s.tool.radius_m = 2e-3;
    s.tool.cuts = cuts;
    return s;
}

// A burr and a suction tube over a block whose upper half is empty.
struct Site {
    BoneBlock bone{kEdge, kVoxelM, [](const Vec3& p) { return p.z() < 0.5 * kEdge - 0.5 ? 1.0 : 0.0; }, 1};
    SceneMeta meta{};
    std::unique_ptr<DrillBone> shared;
    std::unique_ptr<DrillModel> burr_model, tube_model;
    double largest_step_n = 0.0;  // of the forces of both
    float fidelity = 1.0F;
    Vec3 burr_n = Vec3::Zero(), tube_n = Vec3::Zero();

    Site() {
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        bone.bricks.origin_m = -kVoxelM * Vec3::Constant(0.5 * kEdge - 0.5);
        shared = std::make_unique<DrillBone>(bone.bricks, bone.density, bone.revision);
        burr_model = std::make_unique<DrillModel>(meta, *shared, burr());
        tube_model = std::make_unique<DrillModel>(meta, *shared, burr(false));
        burr_model->reset(at(above()));
        tube_model->reset(at(above()));
    }
    static Vec3 above() { return {0.0, 0.0, 5e-3}; }
    void step(const Vec3& burr_m, const Vec3& tube_m = above()) {
        burr_model->turn_burr({kFullRadS, kStepS});
        tube_model->turn_burr({0.0, kStepS});
        Budget budget;
        budget.fidelity = fidelity;
        budget.deadline = Deadline(Instant::max());
        const Vec3 b = burr_model->step(at(burr_m), budget).wrench_world.force_n,
                   t = tube_model->step(at(tube_m), budget).wrench_world.force_n;
        largest_step_n = std::max({largest_step_n, (b - burr_n).norm(), (t - tube_n).norm()});
        burr_n = b;
        tube_n = t;
    }
    // Down into the bone, across, and out; then a pause.
    void stroke(double x_m, double y_m) {
        for (int i = 0; i <= 60; ++i) step({x_m + 3e-5 * i, y_m, 1.7e-3});
        for (int i = 0; i < 320; ++i) step(above());
    }
    void wait() {
        for (int i = 0; i < 600; ++i) step(above());
        ASSERT_FALSE(shared->strokes.exchanging());
    }
    // The octree is that of the densities.
    void check_moments() const {
        const MomentOctree fresh(bone.bricks, bone.density);
        const BlockMoments a = fresh.total(), b = shared->octree.total();
        EXPECT_EQ(a.m0, b.m0);
        EXPECT_EQ(a.m1, b.m1);
        for (std::size_t i = 0; i < bone.bricks.brick_count(); ++i)
            ASSERT_EQ(fresh.brick(i).m1, shared->octree.brick(i).m1) << i;
    }
};

TEST(Strokes, fifty_are_undone_and_redone_to_the_bit) {
    Site s;
    std::vector<std::vector<std::uint8_t>> states{s.bone.density};
    for (int k = 0; k < 50; ++k) {
        s.stroke(-6e-3 + 1.7e-3 * (k % 7), -6e-3 + 1.9e-3 * (k / 7));
        ASSERT_NE(s.bone.density, states.back()) << k;
        states.push_back(s.bone.density);
        ASSERT_EQ(s.shared->strokes.strokes(), static_cast<std::uint32_t>(k + 1));
    }
    for (int k = 49; k >= 0; --k) {
        ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke))) << k;
        s.wait();
        ASSERT_EQ(s.bone.density, states[static_cast<std::size_t>(k)]) << k;
        ASSERT_EQ(s.shared->strokes.strokes(), static_cast<std::uint32_t>(k));
    }
    EXPECT_FALSE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    s.check_moments();
    EXPECT_EQ(s.shared->returned_levels, static_cast<std::int64_t>(s.burr_model->removed_levels()));
    for (std::size_t k = 1; k < states.size(); ++k) {
        ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::redo_stroke))) << k;
        s.wait();
        ASSERT_EQ(s.bone.density, states[k]) << k;
    }
    EXPECT_FALSE(s.burr_model->order(order_of(CommandKind::redo_stroke)));
    s.check_moments();
    EXPECT_EQ(s.shared->returned_levels, 0);
}

TEST(Strokes, a_changed_brick_has_a_new_revision) {
    Site s;
    s.stroke(0.0, 0.0);
    const auto before = s.bone.revision;
    const auto drilled = s.bone.density;
    ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    s.wait();
    for (std::size_t i = 0; i < before.size(); ++i) {
        const auto first = static_cast<std::ptrdiff_t>(i * BoneBricks::kVoxels);
        const bool same = std::equal(drilled.begin() + first, drilled.begin() + first + BoneBricks::kVoxels,
                                     s.bone.density.begin() + first);
        EXPECT_EQ(s.bone.revision[i] == before[i], same) << i;
    }
}

TEST(Strokes, a_new_stroke_forgets_what_was_undone) {
    Site s;
    s.stroke(-4e-3, 0.0);
    const auto first = s.bone.density;
    s.stroke(2e-3, 0.0);
    ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    s.wait();
    EXPECT_EQ(s.shared->strokes.redoable(), 1U);
    s.stroke(2e-3, 4e-3);
    EXPECT_EQ(s.shared->strokes.redoable(), 0U);
    EXPECT_FALSE(s.burr_model->order(order_of(CommandKind::redo_stroke)));
    ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    s.wait();
    EXPECT_EQ(s.bone.density, first);
}

// Bone comes back around a burr and under a tube that both press: the forces fade out and in again. Until then the burr
// takes nothing.
TEST(Strokes, the_forces_of_both_hands_make_no_step_and_nothing_is_cut) {
    Site s;
    const Vec3 in(1e-3, 0.0, 1.2e-3), tube(-4e-3, 0.0, 1.6e-3);
    for (int i = 0; i < 400; ++i) s.step(Vec3(1e-3, 0.0, 5e-3 - 1.5e-5 * std::min(i, 253)), tube);
    for (int i = 0; i < 800; ++i) s.step(in, tube);
    ASSERT_GT(s.burr_n.norm(), 0.1);
    ASSERT_GT(s.tube_n.norm(), 0.1);
    const std::uint64_t removed = s.burr_model->removed_levels();
    s.largest_step_n = 0.0;
    ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    EXPECT_FALSE(s.burr_model->order(order_of(CommandKind::undo_stroke)));  // one at a time
    int steps = 0;
    while (s.shared->strokes.exchanging() && steps < 1000) {
        s.step(in, tube);
        ++steps;
        ASSERT_EQ(s.burr_model->removed_levels(), removed);
    }
    EXPECT_EQ(mass_of(s.bone.density), std::uint64_t{255} * kEdge * kEdge * (kEdge / 2));
    EXPECT_LE(steps, 256 + 60);
    EXPECT_LT(s.burr_n.norm() + s.tube_n.norm(), 1e-3);  // one of them rises again
    for (int i = 0; i < 300; ++i) s.step(in, tube);
    EXPECT_GT(s.burr_n.norm(), 0.1);
    EXPECT_LT(s.largest_step_n, 0.06);                   // 3.3 N in 256 ms, at its steepest
    EXPECT_GT(s.burr_model->removed_levels(), removed);  // it cuts again
}

// At a low level groups of bricks wait to be cut. What waits when a stroke is undone is not cut any more.
TEST(Strokes, what_waits_to_be_cut_is_forgotten_with_the_stroke) {
    Site s;
    const auto whole = s.bone.density;
    s.fidelity = 0.0F;
    for (int i = 0; i < 300; ++i) s.step({0.0, 0.0, 5e-3});
    for (int i = 0; i < 301; ++i) s.step({0.0, 0.0, 1.7e-3});
    const std::uint64_t removed = s.burr_model->removed_levels();
    ASSERT_GT(removed, 1000U);
    ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    for (int i = 0; i < 320; ++i) s.step({0.0, 0.0, i < 200 ? 1.7e-3 : 5e-3});
    EXPECT_EQ(s.burr_model->removed_levels(), removed);
    EXPECT_EQ(s.bone.density, whole);
    EXPECT_EQ(s.shared->strokes.strokes(), 0U);
    EXPECT_EQ(s.shared->strokes.redoable(), 1U);
}

// While one tool is felt no brick is exchanged, whatever the other's fade.
TEST(Strokes, bone_does_not_come_back_under_a_tool_that_is_felt) {
    Site s;
    s.stroke(0.0, 0.0);
    const auto drilled = s.bone.density;
    const Vec3 tube(-4e-3, 0.0, 1.6e-3);
    for (int i = 0; i < 300; ++i) s.step(Site::above(), tube);
    ASSERT_GT(s.tube_n.norm(), 0.1);
    s.burr_model->reset(at(Site::above()));  // its force is zero at once
    ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    for (int i = 0; i < 200; ++i) s.step(Site::above(), tube);
    EXPECT_GT(s.tube_n.norm(), 0.0);
    EXPECT_EQ(s.bone.density, drilled);
    for (int i = 0; i < 200; ++i) s.step(Site::above(), tube);
    EXPECT_NE(s.bone.density, drilled);
}

TEST(Strokes, a_pause_ends_a_stroke_and_so_does_its_length) {
    StrokeHistory h(8, 64);
    std::array<std::uint8_t, BoneBricks::kVoxels> voxels{};
    const auto cut = [&](std::uint32_t brick) {
        h.look(brick, voxels.data());
        h.keep(brick);
    };
    cut(0);
    h.step(kStepS, true);
    for (int i = 0; i < 299; ++i) h.step(kStepS, false);
    cut(1);
    h.step(kStepS, true);
    EXPECT_EQ(h.strokes(), 1U);
    for (int i = 0; i < 301; ++i) h.step(kStepS, false);
    EXPECT_FALSE(h.under_way());
    cut(1);
    EXPECT_EQ(h.strokes(), 2U);
    for (int i = 0; i < 9990; ++i) h.step(kStepS, true);
    cut(2);
    EXPECT_EQ(h.strokes(), 2U);
    for (int i = 0; i < 20; ++i) h.step(kStepS, true);
    cut(2);
    EXPECT_EQ(h.strokes(), 3U);
}

// Each brick holds the number of times that it was cut. Strokes of random bricks, undone at random, against a list of
// whole copies.
TEST(Strokes, agree_with_copies_of_everything_until_the_room_is_full) {
    constexpr std::size_t kBricks = 12, kRoom = 40;
    StrokeHistory h(kBricks, kRoom);
    std::vector<std::uint8_t> density(kBricks * BoneBricks::kVoxels);
    std::vector<std::vector<std::uint8_t>> done{density}, undone;
    std::uint32_t seed = 7;
    const auto random = [&](std::uint32_t below) {
        seed = seed * 1664525U + 1013904223U;
        return (seed >> 8U) % below;
    };
    const auto exchange = [&] {
        while (h.exchanging()) h.exchange(density, [](std::uint32_t) {});
    };
    int undos = 0, forgotten = 0;
    for (int turn = 0; turn < 4000; ++turn) {
        const std::uint32_t what = random(5);
        if (what < 2) {
            const std::uint32_t cuts = 1 + random(9);
            for (std::uint32_t k = 0; k < cuts; ++k) {
                const std::uint32_t brick = random(kBricks);
                std::uint8_t* const voxels = density.data() + brick * BoneBricks::kVoxels;
                h.look(brick, voxels);
                if (random(4) == 0) continue;  // looked at, and not changed
                for (std::size_t v = 0; v < BoneBricks::kVoxels; ++v)
                    voxels[v] = static_cast<std::uint8_t>(voxels[v] + 1 + v % 3);
                h.keep(brick);
            }
            if (!h.under_way()) continue;
            h.end_stroke();
            done.push_back(density);
            undone.clear();
        } else if (what < 4 && h.undo()) {
            exchange();
            ASSERT_GT(done.size(), 1U);
            undone.push_back(std::move(done.back()));
            done.pop_back();
            ASSERT_EQ(density, done.back()) << turn;
            ++undos;
        } else if (what == 4 && h.redo()) {
            exchange();
            ASSERT_FALSE(undone.empty());
            done.push_back(std::move(undone.back()));
            undone.pop_back();
            ASSERT_EQ(density, done.back()) << turn;
        }
        ASSERT_EQ(h.strokes() + 1, done.size());
        ASSERT_EQ(h.redoable(), undone.size());
        ASSERT_LE(h.undoable(), done.size() - 1);
        if (h.undoable() + 1 < done.size()) ++forgotten;
    }
    EXPECT_GT(undos, 300);
    EXPECT_GT(forgotten, 300);
}

TEST(Strokes, the_oldest_of_very_many_are_forgotten) {
    constexpr std::uint32_t kMany = StrokeHistory::kStrokesMost + 100;
    StrokeHistory h(1, 2 * kMany);
    std::vector<std::uint8_t> density(BoneBricks::kVoxels);
    for (std::uint32_t k = 0; k < kMany; ++k) {
        h.look(0, density.data());
        ++density[k % 7];
        h.keep(0);
        h.end_stroke();
    }
    EXPECT_EQ(h.strokes(), kMany);
    EXPECT_EQ(h.undoable(), StrokeHistory::kStrokesMost);
    std::uint32_t undone = 0;
    for (; h.undo(); ++undone)
        while (h.exchanging()) h.exchange(density, [](std::uint32_t) {});
    EXPECT_EQ(undone, StrokeHistory::kStrokesMost);
    EXPECT_EQ(std::accumulate(density.begin(), density.end(), 0U), 100U);
}

TEST(Strokes, one_that_is_larger_than_the_room_cannot_be_undone_and_the_next_one_can) {
    StrokeHistory h(10, 4);
    std::vector<std::uint8_t> density(10 * BoneBricks::kVoxels, 9);
    const auto cut = [&](std::uint32_t brick) {
        h.look(brick, density.data() + brick * BoneBricks::kVoxels);
        density[brick * BoneBricks::kVoxels] = 1;
        h.keep(brick);
    };
    cut(0);
    h.end_stroke();
    for (std::uint32_t b = 1; b < 9; ++b) cut(b);
    EXPECT_EQ(h.undoable(), 0U);
    EXPECT_FALSE(h.undo());
    h.end_stroke();
    EXPECT_FALSE(h.undo());
    cut(9);
    h.end_stroke();
    EXPECT_EQ(h.undoable(), 1U);
    ASSERT_TRUE(h.undo());
    while (h.exchanging()) h.exchange(density, [](std::uint32_t brick) { EXPECT_EQ(brick, 9U); });
    EXPECT_EQ(density[9 * BoneBricks::kVoxels], 9);
    EXPECT_EQ(h.strokes(), 2U);
    EXPECT_FALSE(h.undo());
}

TEST(Strokes, are_published_with_what_is_missing_from_the_bone) {
    Site s;
    Latest<DrillTopic> drill;
    Latest<TouchTopic> touch;
    DrillPublisher publisher(drill, touch, {});
    s.burr_model->publish_to(publisher);
    s.tube_model->publish_to(publisher);
    const StepResult result;
    const auto told = [&] {
        for (std::uint32_t hand = 0; hand < 2; ++hand)
            (hand == 0 ? s.burr_model : s.tube_model)
                ->publish({.now = {}, .cycle = 1, .hand = hand, .step = result});
        DrillTopic t{};
        EXPECT_TRUE(drill.read(t));
        return t;
    };
    const std::uint64_t whole = mass_of(s.bone.density);
    for (int i = 0; i <= 60; ++i) s.step({3e-5 * i, 0.0, 1.7e-3});
    EXPECT_EQ(told().stroke_under_way, 1);
    s.stroke(0.0, 4e-3);
    EXPECT_EQ(told().strokes, 1U);  // no pause between
    s.stroke(0.0, -4e-3);
    DrillTopic t = told();
    EXPECT_EQ(t.stroke_under_way, 0);
    EXPECT_EQ(t.strokes, 2U);
    EXPECT_EQ(t.undoable, 2);
    EXPECT_EQ(t.redoable, 0);
    EXPECT_EQ(t.removed_levels, whole - mass_of(s.bone.density));
    ASSERT_TRUE(s.burr_model->order(order_of(CommandKind::undo_stroke)));
    EXPECT_EQ(told().exchanging, 1);
    s.wait();
    t = told();
    EXPECT_EQ(t.exchanging, 0);
    EXPECT_EQ(t.strokes, 1U);
    EXPECT_EQ(t.undoable, 1);
    EXPECT_EQ(t.redoable, 1);
    EXPECT_EQ(t.removed_levels, whole - mass_of(s.bone.density));
    EXPECT_GT(t.hand[0].removed_levels, t.removed_levels);
    EXPECT_FALSE(s.tube_model->order(order_of(CommandKind::undo_stroke)));
    EXPECT_FALSE(s.burr_model->order(order_of(CommandKind::set_clash)));
}

}  // namespace
}  // namespace strokes_test
}  // namespace tact
