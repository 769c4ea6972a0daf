// Undo, redo, acceptance and snapshots against a simple reference model.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "gui/docking/fit_history.hpp"
#include "ipc/base/units.hpp"

namespace tact::gui_history_test {
namespace {

using Move = FitHistory::Move;

// Bodies and a controller that applies moves, observed once per frame.
struct Scene {
    std::map<std::uint32_t, double> x_a{{1, 0.0}, {2, 0.0}};
    FitHistory::Boundary boundary{1, 0, 0};
    FitHistory history;

    Scene() { look(); }
    void look() {
        std::vector<Move> now;
        for (const auto& [id, x] : x_a) now.push_back({id, {Vec3(x * kAngstromM, 0, 0), Quat::Identity()}});
        history.observe(now, boundary);
    }
    void grip() {
        ++boundary.grips;
        look();
    }
    void drag(std::uint32_t id, double to_a) {
        x_a[id] = to_a;
        look();
    }
    // The hand moves on for a frame before the controller applies the commands one by one.
    void apply(const FitHistory::Places& moves) {
        const auto before = x_a;
        for (auto& [id, x] : x_a) x += 0.3;
        look();
        x_a = before;
        for (const Move& m : moves) {
            x_a[m.id] = m.T_model_body.p_m.x() / kAngstromM;
            ++boundary.placements;
            ++boundary.grips;
            look();
        }
        look();
    }
};

TEST(FitHistory, undo_reverts_one_gesture_and_redo_repeats_it) {
    Scene s;
    s.drag(1, 3.0);
    s.drag(1, 5.0);
    s.grip();
    s.drag(1, 9.0);  // in progress
    EXPECT_EQ(s.history.undoable(), 2U);
    s.apply(s.history.undo());
    EXPECT_NEAR(s.x_a[1], 5.0, 1e-9);
    s.apply(s.history.undo());
    EXPECT_NEAR(s.x_a[1], 0.0, 1e-9);
    EXPECT_EQ(s.history.undoable(), 0U);
    EXPECT_TRUE(s.history.undo().empty());
    s.apply(s.history.redo());
    s.apply(s.history.redo());
    EXPECT_NEAR(s.x_a[1], 9.0, 1e-9);
    EXPECT_EQ(s.history.redoable(), 0U);
}

TEST(FitHistory, two_undos_before_the_controller_applied_the_first_both_count) {
    Scene s;
    for (const double x : {3.0, 6.0}) {
        s.drag(1, x);
        s.grip();
    }
    FitHistory::Places moves = s.history.undo();
    for (const Move& m : s.history.undo()) moves.push_back(m);
    ASSERT_EQ(moves.size(), 2U);
    s.apply(moves);
    EXPECT_NEAR(s.x_a[1], 0.0, 1e-9);
    EXPECT_EQ(s.history.undoable(), 0U);
    EXPECT_EQ(s.history.redoable(), 2U);
}

TEST(FitHistory, a_grip_without_a_move_is_no_gesture) {
    Scene s;
    for (int i = 0; i < 5; ++i) s.grip();
    s.drag(1, 0.005);  // below the visible threshold
    s.grip();
    EXPECT_EQ(s.history.undoable(), 0U);
}

TEST(FitHistory, undo_and_redo_work_while_the_hand_holds_the_body) {
    Scene s;
    s.drag(1, 10.0);
    s.grip();
    s.drag(1, 20.0);
    s.apply(s.history.undo());
    s.drag(1, 10.3);  // a tremor
    s.apply(s.history.undo());
    EXPECT_NEAR(s.x_a[1], 0.0, 1e-9);
    s.drag(1, -0.4);
    EXPECT_EQ(s.history.redoable(), 2U);
    s.apply(s.history.redo());
    EXPECT_NEAR(s.x_a[1], 10.0, 1e-9);
    s.drag(1, 14.0);  // an intended move
    s.apply(s.history.undo());
    EXPECT_NEAR(s.x_a[1], 10.0, 1e-9);
}

TEST(FitHistory, another_gesture_clears_redo) {
    Scene s;
    s.drag(1, 3.0);
    s.grip();
    s.apply(s.history.undo());
    EXPECT_EQ(s.history.redoable(), 1U);
    s.drag(1, 7.0);
    s.grip();
    EXPECT_EQ(s.history.redoable(), 0U);
}

TEST(FitHistory, revert_restores_the_accepted_poses_and_can_be_undone) {
    Scene s;
    s.drag(1, 3.0);
    s.history.accept();
    EXPECT_EQ(s.history.undoable(), 0U);
    s.grip();
    s.drag(1, 5.0);
    s.grip();
    s.drag(2, 4.0);
    s.apply(s.history.revert());
    EXPECT_NEAR(s.x_a[1], 3.0, 1e-9);
    EXPECT_NEAR(s.x_a[2], 0.0, 1e-9);
    s.apply(s.history.undo());
    EXPECT_NEAR(s.x_a[1], 5.0, 1e-9);
    EXPECT_NEAR(s.x_a[2], 4.0, 1e-9);
}

TEST(FitHistory, snapshots_are_restored_by_name) {
    Scene s;
    s.drag(1, 3.0);
    EXPECT_TRUE(s.history.snapshot("a"));
    EXPECT_FALSE(s.history.snapshot("a"));
    s.drag(1, 8.0);
    EXPECT_TRUE(s.history.restore("b").empty());
    s.apply(s.history.restore("a"));
    EXPECT_NEAR(s.x_a[1], 3.0, 1e-9);
    EXPECT_EQ(s.history.snapshots(), std::vector<std::string>{"a"});
}

TEST(FitHistory, added_or_removed_bodies_are_not_moved) {
    Scene s;
    s.drag(1, 3.0);
    s.grip();
    s.x_a.erase(2);
    s.x_a[3] = 6.0;
    ++s.boundary.placements;
    s.look();
    const auto moves = s.history.undo();
    ASSERT_EQ(moves.size(), 1U);
    EXPECT_EQ(moves[0].id, 1U);
}

TEST(FitHistory, another_controller_clears_the_history) {
    Scene s;
    s.drag(1, 3.0);
    s.grip();
    s.boundary = {};
    s.look();
    EXPECT_EQ(s.history.undoable(), 0U);
    EXPECT_TRUE(s.history.revert().empty());
}

TEST(FitHistory, waiting_for_a_refused_move_is_bounded) {
    Scene s;
    s.drag(1, 3.0);
    s.grip();
    static_cast<void>(s.history.undo());  // the controller does not apply it
    for (int i = 0; i < FitHistory::kPatience; ++i) s.look();
    s.drag(1, 5.0);
    s.apply(s.history.undo());
    EXPECT_NEAR(s.x_a[1], 3.0, 1e-9);
}

TEST(FitHistory, memory_is_bounded) {
    Scene s;
    for (int i = 1; i < 1000; ++i) {
        s.drag(1, i);
        s.grip();
    }
    EXPECT_EQ(s.history.undoable(), FitHistory::kGesturesMax);
    for (int i = 0; i < 100; ++i) s.history.snapshot(std::to_string(i));
    EXPECT_EQ(s.history.snapshots().size(), FitHistory::kSnapshotsMax);
}

RC_GTEST_PROP(FitHistory, any_sequence_matches_a_list_of_states, ()) {
    Scene s;
    std::vector<double> done, undone;  // positions of body 1 before each gesture
    double at = 0.0;
    const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 3));
    int drags = 0;
    for (const int step : steps) {
        if (step == 0) {
            s.drag(1, drags += 3);  // more than a tremor
            s.grip();
            done.push_back(at);
            undone.clear();
            at = drags;
        } else if (step == 1) {
            s.apply(s.history.undo());
            if (!done.empty()) undone.push_back(at), at = done.back(), done.pop_back();
        } else {
            s.apply(s.history.redo());
            if (!undone.empty()) done.push_back(at), at = undone.back(), undone.pop_back();
        }
        RC_ASSERT(std::abs(s.x_a[1] - at) < 1e-9);
        RC_ASSERT(s.history.undoable() == done.size());
        RC_ASSERT(s.history.redoable() == undone.size());
    }
}

}  // namespace
}  // namespace tact::gui_history_test
