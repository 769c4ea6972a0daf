// Tools given as meshes: contact, force and torque, levels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "ipc/base/random.hpp"
#include "tests/contract/force_model_contract.hpp"
#include "tests/unit/force_tool_fixture.hpp"

namespace tact {
namespace {

using namespace tool_test;

ForceModelCase tool_case(const char* name, const World& (*on)(), double grip_y_m, const Pose& touch) {
    ForceModelCase c;
    c.name = name;
    c.make = [on] { return on().model({}); };
    c.grip = pose({0.0, grip_y_m, 0.0});
    c.touch = touch;
    c.error_at_rest = 0.8;
    return c;
}
ForceModelCase sliding(ForceModelCase c) {
    c.path = [touch = c.touch](int i) {
        return Pose{Eigen::AngleAxisd(5e-4 * i, Vec3::UnitZ()) * touch.p_m, touch.q};
    };
    c.path_steps = 100;
    return c;
}
ForceModelCase without_error(ForceModelCase c, const char* why) {
    c.error_free = why;
    return c;
}

INSTANTIATE_TEST_SUITE_P(
    Tool, ForceModelContract,
    testing::Values(without_error(tool_case("box", &box_on_plane, 0.02,
                                            pose({0.01, 0.003, 0.005}, {0.05, 0.2, -0.1})),
                                  "a plane is held off by the corners, which are the first points"),
                    without_error(tool_case("scaler", &scaler_on_rough, 0.075,
                                            pose({0.004, 0.06, 0.003}, {0.1, 0.0, 0.1})),
                                  "its tip touches, which is among the first points"),
                    sliding(tool_case("flat_box", &box_on_rough, 0.075, pose({0.004, 0.053, 0.003})))),
    [](const auto& tested) { return tested.param.name; });

TEST(Tool, a_box_on_a_plane_pushes_along_the_normal_by_its_depth) {
    Hand hand(box_on_plane(), plain(), pose({0.003, 0.02, -0.002}));
    const Wrench& w = hand.lead(pose({0.013, 0.004, 0.004}));
    EXPECT_NEAR(w.force_n.y(), kStiffness * 0.001, 0.01);
    EXPECT_LT(std::hypot(w.force_n.x(), w.force_n.z()), 0.003);
    EXPECT_LT(w.torque_n_m.norm(), 3e-5);
    const Wrench clear = hand.lead(pose({0.013, 0.03, 0.004}));
    EXPECT_LT(clear.force_n.norm() + clear.torque_n_m.norm(), 1e-9);
}

TEST(Tool, a_tilted_box_is_held_by_its_lowest_corner_and_the_torque_is_lever_times_force) {
    Hand hand(box_on_plane(), plain(), pose({0.0, 0.03, 0.0}));
    (void)hand.lead(pose({0.0, 0.013, 0.0}, {0.3, 0.1, 0.5}));
    ASSERT_GT(hand.model->tool_touch().places, 0U);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (std::uint32_t i = 0; i < hand.model->tool_touch().places; ++i) {
        const TouchedPlace& p = hand.model->tool_touch().place[i];
        const Vec3 f = kStiffness * kWorldPerModel * p.weight_m * p.normal;
        force += f;
        torque += kWorldPerModel * p.lever_m.cross(f);
    }
    EXPECT_GT(hand.felt.force_n.y(), 0.1);
    EXPECT_LT((hand.felt.force_n - force).norm(), 0.01);
    EXPECT_LT((hand.felt.torque_n_m - torque).norm(), 2e-4);
    EXPECT_LT(std::hypot(hand.felt.force_n.x(), hand.felt.force_n.z()), 0.01);
}

// Two supports at a = 0.009 and b = 0.014 from the hand (inner edges of the blocks); the hand presses down by d without
// rotation. The proxy rotates by t and lies y above. With weights l1, l2: y = l1 + l2, g^2 t = b l2 - a l1, and contact
// requires y + t b = d, y - t a = d. The solution is t = 0, y = d, with forces b / (a + b) and a / (a + b).
TEST(Tool, a_bar_on_two_supports_splits_the_force_by_its_levers) {
    Hand hand(bar_on_blocks(), plain(), pose({0.0, 0.01, 0.0}));
    (void)hand.lead(pose({0.0, 0.0, 0.0}));
    EXPECT_NEAR(hand.felt.force_n.y(), kStiffness * 0.001, 0.01);
    EXPECT_LT(hand.felt.torque_n_m.norm(), 1e-4);
    // On one support only, to the right of the other: the bar tilts, and the torque is lever times force.
    Hand over(bar_on_blocks(), plain(), pose({-0.022, 0.01, 0.0}));
    (void)over.lead(pose({-0.022, 0.0, 0.0}));
    const double lever = over.felt.torque_n_m.z() / over.felt.force_n.y();
    EXPECT_GT(over.felt.force_n.y(), 0.02);
    EXPECT_GT(lever, 0.0105);
    EXPECT_LT(lever, 0.0135);
}

TEST(Tool, a_box_over_an_edge_tilts_and_the_force_follows_from_one_energy) {
    Hand hand(bar_on_blocks(), plain(), pose({-0.018, 0.01, 0.0}));
    SeededRandom random(2);
    const auto energy = [&](const Pose& goal) {
        (void)hand.lead(goal, 400);
        const Vec6 way =
            hand.model->contact().way_m({goal.p_m / kWorldPerModel, goal.q}, hand.model->contact().proxy());
        return 0.5 * kStiffness * kWorldPerModel * kWorldPerModel * way.squaredNorm();
    };
    const Pose middle = pose({-0.018, 0.0003, 0.0005}, {0.0, 0.03, 0.05});
    for (int i = 0; i < 4; ++i) {
        const Vec3 push = random.direction(), turn = random.direction();
        constexpr double kStep = 4e-5, kTurn = 4e-3;
        const auto moved = [&](double s) {
            return Pose{middle.p_m + s * kStep * push,
                        quat_from_rotation_vector(s * kTurn * turn) * middle.q};
        };
        (void)energy(middle);
        const double work = hand.felt.force_n.dot(kStep * push) + hand.felt.torque_n_m.dot(kTurn * turn);
        const double slope = 0.5 * (energy(moved(1.0)) - energy(moved(-1.0)));
        EXPECT_NEAR(-slope, work, 2e-6 + 0.03 * std::abs(work)) << i;
    }
}

TEST(Tool, a_mirrored_world_gives_a_mirrored_wrench) {
    // The mirror maps x to -x.
    Hand left(bar_on_blocks(), plain(), pose({0.003, 0.01, 0.0}));
    static const auto mirrored = [] {
        TriangleMesh blocks;
        append_box(blocks, {0.01, -0.01, 0.0}, {0.001, 0.01, 0.02});
        append_box(blocks, {-0.015, -0.01, 0.0}, {0.001, 0.01, 0.02});
        return world(blocks, box_mesh({0.02, 0.001, 0.001}), {.points = 2000});
    }();
    Hand right(*mirrored, plain(), pose({-0.003, 0.01, 0.0}));
    const Wrench a = left.lead(pose({0.003, 0.0002, 0.001}, {0.02, 0.1, 0.06})),
                 b = right.lead(pose({-0.003, 0.0002, 0.001}, {0.02, -0.1, -0.06}));
    EXPECT_GT(a.force_n.norm(), 0.1);
    EXPECT_LT((a.force_n - Vec3(-b.force_n.x(), b.force_n.y(), b.force_n.z())).norm(), 0.02);
    EXPECT_LT((a.torque_n_m - Vec3(b.torque_n_m.x(), -b.torque_n_m.y(), -b.torque_n_m.z())).norm(), 2e-4);
}

// As in Surface.on_a_plate_of_many_triangles_the_force_stays_in_the_friction_cone_and_reaches_its_rim.
TEST(Tool, a_box_that_slides_on_a_plate_stays_in_the_friction_cone) {
    for (const double friction : {0.2, 0.5}) {
        for (const double speed_m_s : {0.05, 0.2}) {
            Hand hand(box_on_plane(), plain(friction), pose({0.0, 0.02, 0.0}));
            (void)hand.lead(pose({0.0, 0.004, 0.0}));
            double most = 0.0;
            for (int i = 0; i < 1500; ++i) {
                const double angle = speed_m_s / 0.02 * 1e-3 * i;
                const Vec3 force_n =
                    hand.step(pose({0.02 * std::sin(angle), 0.0035 + 0.0004 * std::sin(0.06 * i),
                                    0.015 * std::sin(1.3 * angle)}))
                        .force_n;
                if (force_n.y() < 0.02) continue;
                const double share = std::hypot(force_n.x(), force_n.z()) / force_n.y();
                ASSERT_LE(share, 1.02 * friction) << "at " << speed_m_s << " m/s, step " << i;
                most = std::max(most, share);
            }
            EXPECT_GE(most, 0.9 * friction);
        }
    }
}

TEST(Tool, friction_holds_a_box_inside_the_cone_and_lets_it_slide_at_the_rim) {
    constexpr double kFriction = 0.4, kDepth = 0.001;
    Hand hand(box_on_plane(), plain(kFriction), pose({0.0, 0.02, 0.0}));
    (void)hand.lead(pose({0.0, 0.005 - kDepth, 0.0}));
    const Wrench held = hand.lead(pose({0.5 * kFriction * kDepth, 0.005 - kDepth, 0.0}));
    EXPECT_NEAR(-held.force_n.x(), kStiffness * 0.5 * kFriction * kDepth, 0.01);
    const Wrench slides = hand.lead(pose({0.01, 0.005 - kDepth, 0.0}));
    EXPECT_NEAR(-slides.force_n.x(), kFriction * slides.force_n.y(), 0.02);
}

TEST(Tool, a_box_holds_up_to_the_static_coefficient_and_slides_with_the_dynamic_one) {
    constexpr double kDepth = 0.001, kStep = 2e-5;
    SurfaceSettings settings = plain(0.5);
    settings.dynamic_friction = 0.2;
    Hand hand(box_on_plane(), settings, pose({-0.02, 0.02, 0.0}));
    (void)hand.lead(pose({-0.02, 0.005 - kDepth, 0.0}));
    const auto drag = [&](double to_m) {
        const Vec3 force_n = hand.step(pose({-0.02 + to_m, 0.005 - kDepth, 0.0})).force_n;
        return std::hypot(force_n.x(), force_n.z()) / force_n.y();
    };
    double way_m = 0.0, share = 0.0;
    for (; way_m < 0.48 * kDepth; way_m += kStep) share = drag(way_m);
    EXPECT_FALSE(hand.model->slides());
    EXPECT_GT(share, 0.44);
    for (; way_m < 2.0 * kDepth; way_m += kStep) share = drag(way_m);
    for (; way_m < 0.03; way_m += kStep) {
        share = drag(way_m);
        ASSERT_NEAR(share, 0.2, 0.01) << "after " << way_m << " m";
    }
    EXPECT_TRUE(hand.model->slides());
    for (int i = 0; i < 25; ++i) (void)drag(way_m);
    EXPECT_FALSE(hand.model->slides());
    const double most_m = way_m + 0.25 * kDepth;
    for (; way_m < most_m; way_m += kStep) share = drag(way_m);
    EXPECT_GT(share, 0.4);
}

// Pose over the rough sphere with the tip about `depth` deep.
Pose slide(double t, double depth) {
    const double around = 1.1 * t, up = 0.9 * std::sin(0.61 * t);
    const Vec3 d(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
    const Quat q = Quat::FromTwoVectors(Vec3::UnitY(), d) * quat_from_rotation_vector(Vec3(0.0, t, 0.0));
    return {(rough_radius_m(d) + 0.0137 - depth) * d, q};
}

TEST(Tool, the_proxy_never_jams_and_no_point_gets_behind_the_surface) {
    for (const double speed : {1.0, 3.0}) {
        Hand hand(scaler_on_rough(), plain(speed > 2.0 ? 0.2 : 0.0), slide(0.0, -0.01));
        const ToolPoints& points = hand.model->contact().points();
        EXPECT_EQ(points.awake(), points.size());
        (void)hand.lead(slide(0.0, 0.001));
        Wrench before = hand.felt;
        for (int i = 0; i < 1500; ++i) {
            const Pose last = hand.place;
            const Wrench now = hand.step(slide(1e-3 * speed * i, 0.001));
            const double gyration = kWorldPerModel * points.gyration_m();
            const double moved =
                (hand.place.p_m - last.p_m).norm() + gyration * last.q.angularDistance(hand.place.q);
            // A jammed proxy falls behind by 60 mm/s and more.
            ASSERT_LT((hand.proxy().p_m - hand.place.p_m).norm(), 0.012) << i;
            ASSERT_LT((now.force_n - before.force_n).norm(), 2.5 * kStiffness * moved + 0.1);
            ASSERT_LT((now.torque_n_m - before.torque_n_m).norm(),
                      gyration * (2.5 * kStiffness * moved + 0.1));
            before = now;
            if (i % 250 != 249) continue;
            EXPECT_EQ(points.awake(), points.size());
            for (std::uint32_t k = 0; k < points.size(); ++k) {
                const Pose proxy = hand.model->contact().proxy();
                const Vec3 p = proxy * scaler_on_rough().tool.at_m(k);
                const SurfacePoint s = scaler_on_rough().mesh.nearest(p, 10.0);
                ASSERT_GT(s.distance_m, 0.85 * scaler_on_rough().tool.ball_m) << k;
                // The point is outside: well above the surface, it lies on the outer side of the nearest facet.
                if (s.distance_m > 20.0 * scaler_on_rough().tool.ball_m) {
                    ASSERT_GT(scaler_on_rough().mesh.normal_at(s).dot(p - s.point_m), 0.0) << k;
                }
            }
        }
        EXPECT_EQ(hand.model->released(), 0U);
    }
}

TEST(Tool, a_settled_proxy_is_the_nearest_free_pose_that_small_moves_find) {
    Hand hand(scaler_on_rough(), plain(), slide(0.0, -0.01));
    SeededRandom random(4);
    const World& w = scaler_on_rough();
    for (int place = 0; place < 4; ++place) {
        const Pose goal = slide(0.3 * place, 0.0015);
        (void)hand.lead(slide(0.3 * place, -0.01));
        (void)hand.lead(goal, 600);
        EXPECT_EQ(hand.model->tool_touch().state, ContactState::settled);
        const ToolContact& contact = hand.model->contact();
        const Pose model_goal{goal.p_m / kWorldPerModel, goal.q}, proxy = contact.proxy();
        const double way = contact.way_m(model_goal, proxy).norm();
        for (int i = 0; i < 60; ++i) {
            const Vec3 v = 1e-5 * random.direction(),
                       turn = 1e-5 / contact.points().gyration_m() * random.direction();
            const Pose other{proxy.p_m + v, quat_from_rotation_vector(turn) * proxy.q};
            if (contact.way_m(model_goal, other).norm() > way - 4e-6) continue;
            double least = 1.0;
            for (std::size_t k = 0; k < w.tool.points(); ++k)
                least =
                    std::min(least, w.mesh.nearest(other * w.tool.at_m(k), 10.0 * w.tool.ball_m).distance_m);
            EXPECT_LT(least, w.tool.ball_m);
        }
    }
}

TEST(Tool, a_tool_that_starts_in_the_surface_comes_to_rest_on_it_without_a_force_step) {
    for (const double y : {0.001, 0.004, 0.0051, 0.02}) {
        const auto model = box_on_plane().model(plain());
        const ToolState tool = at({0.0, y, 0.0});
        model->reset(tool);
        Wrench before;
        for (int i = 0; i < 800; ++i) {
            const Wrench now = model->step(tool, {}).wrench_world;
            ASSERT_LT((now.force_n - before.force_n).norm(), 0.03);
            before = now;
        }
        EXPECT_EQ(model->contact().points().awake(), model->contact().points().size());
        EXPECT_NEAR(before.force_n.y(), kStiffness * std::max(0.0, 0.005 - y), 0.01) << y;
    }
}

// A pin that stands on a sphere of 2000 triangles (facets 8.7 degrees apart) and slides over it.
struct OnFacets {
    double off_rad = 0.0;         // 99th percentile of the angle between force and sphere normal
    double beyond_n = 0.0;        // largest force change per step beyond the hand's motion
    double twist_beyond_n = 0.0;  // the same for torque over the radius of gyration
};
const World& pin_on_facets() {
    static const auto made = world(smooth_sphere(10), box_mesh({5e-5, 0.004, 5e-5}), {.points = 200});
    return *made;
}
Pose on_facets(int step, double depth_m) {
    const double around = 1.1e-3 * step, up = 0.9 * std::sin(0.61e-3 * step);
    const Vec3 d(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
    return Pose{(kRoughSphereM + 0.004 - depth_m) * d, Quat::FromTwoVectors(Vec3::UnitY(), d)};
}
OnFacets slide_on_facets(bool shading) {
    constexpr double kDepth = 0.0012;
    SurfaceSettings settings = plain();
    settings.shading = shading;
    Hand hand(pin_on_facets(), settings, on_facets(0, -0.01));
    Wrench before = hand.lead(on_facets(0, kDepth));
    const double gyration = kWorldPerModel * hand.model->contact().points().gyration_m();
    OnFacets felt;
    std::vector<double> off;
    for (int i = 0; i < 1500; ++i) {
        const Pose last = hand.place;
        const Wrench now = hand.step(on_facets(i, kDepth));
        const double moved =
            std::hypot((hand.place.p_m - last.p_m).norm(), gyration * last.q.angularDistance(hand.place.q));
        const Vec3 out = hand.place.p_m;
        off.push_back(std::atan2(now.force_n.cross(out).norm(), now.force_n.dot(out)));
        const double allowed = 2.5 * kStiffness * moved;
        felt.beyond_n = std::max(felt.beyond_n, (now.force_n - before.force_n).norm() - allowed);
        felt.twist_beyond_n =
            std::max(felt.twist_beyond_n, (now.torque_n_m - before.torque_n_m).norm() / gyration - allowed);
        before = now;
    }
    std::sort(off.begin(), off.end());
    felt.off_rad = off[off.size() * 99 / 100];
    return felt;
}

TEST(Tool, shading_turns_force_and_torque_to_the_smooth_normal_without_steps) {
    const OnFacets flat = slide_on_facets(false), shaded = slide_on_facets(true);
    constexpr double kDegree = std::numbers::pi / 180.0;
    EXPECT_GT(flat.off_rad, 3.5 * kDegree);
    EXPECT_LT(shaded.off_rad, 2.0 * kDegree);
    EXPECT_LT(shaded.beyond_n, 2.0 * SurfaceModel::kLagN + 1e-3);
    EXPECT_LT(shaded.twist_beyond_n, 2.0 * SurfaceModel::kLagN + 1e-3);
}

// At rest each contact pushes along the smooth normal at its position, with unchanged magnitude and lever.
TEST(Tool, the_shaded_torque_is_lever_times_shaded_force) {
    const World& w = pin_on_facets();
    SurfaceSettings settings = plain();
    settings.shading = true;
    Hand hand(w, settings, on_facets(0, -0.01));
    double flat_n = 0.0, torque_n_m = 0.0;
    for (int i = 0; i < 12; ++i) {
        (void)hand.lead(on_facets(60 * i, 0.0012));
        const ToolTouch& touch = hand.model->tool_touch();
        ASSERT_GT(touch.places, 0U);
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero(), flat = Vec3::Zero();
        for (std::uint32_t k = 0; k < touch.places; ++k) {
            const TouchedPlace& p = touch.place[k];
            const double newton = kStiffness * kWorldPerModel * p.weight_m;
            const Vec3 smooth =
                w.mesh.normal_at(w.mesh.point_of(p.triangle, touch.T_model_proxy.p_m + p.lever_m));
            force += newton * smooth;
            torque += kWorldPerModel * p.lever_m.cross(newton * smooth);
            flat += newton * p.normal;
        }
        EXPECT_LT((hand.felt.force_n - force).norm(), 0.01) << i;
        EXPECT_LT((hand.felt.torque_n_m - torque).norm(), 4e-5) << i;
        flat_n = std::max(flat_n, (hand.felt.force_n - flat).norm());
        torque_n_m = std::max(torque_n_m, torque.norm());
    }
    EXPECT_GT(flat_n, 0.02);
    EXPECT_GT(torque_n_m, 1e-4);
}

TEST(Tool, shading_leaves_a_plane_and_an_edge_as_they_are) {
    SurfaceSettings settings = plain();
    settings.shading = true;
    Hand hand(box_on_plane(), settings, pose({0.003, 0.02, -0.002}));
    const Wrench& w = hand.lead(pose({0.013, 0.004, 0.004}));
    EXPECT_LT((w.force_n - Vec3(0.0, kStiffness * 0.001, 0.0)).norm(), 0.01);
    EXPECT_LT(w.torque_n_m.norm(), 3e-5);
    // The blocks' corner normals are 45 degrees and more from the face normals.
    Hand over(bar_on_blocks(), settings, pose({-0.022, 0.01, 0.0})),
        plainly(bar_on_blocks(), plain(), pose({-0.022, 0.01, 0.0}));
    const Wrench a = over.lead(pose({-0.022, 0.0, 0.0})), b = plainly.lead(pose({-0.022, 0.0, 0.0}));
    EXPECT_GT(b.force_n.norm(), 0.02);
    EXPECT_LT((a.force_n - b.force_n).norm(), 1e-9);
    EXPECT_LT((a.torque_n_m - b.torque_n_m).norm(), 1e-9);
}

// On its flat side and fast, a box needs many queries in a step.
TEST(Tool, a_level_limits_the_points_and_the_queries_of_a_step) {
    std::uint32_t most = 0;
    double costliest_us = 0.0;
    for (const float fidelity : {0.05F, 0.5F, 0.75F, 1.0F}) {
        const std::uint32_t queries = ToolModel::queries(fidelity);
        EXPECT_GT(to_us(box_on_rough().model({})->predict(fidelity).cost_predicted), costliest_us);
        costliest_us = to_us(box_on_rough().model({})->predict(fidelity).cost_predicted);
        Hand hand(box_on_rough(), {}, pose({0.004, 0.075, 0.003}));
        (void)hand.lead(pose({0.004, 0.053, 0.003}));
        most = 0;
        for (int i = 0; i < 400; ++i) {
            const Vec3 p = Eigen::AngleAxisd(2e-3 * i, Vec3::UnitZ()) * Vec3(0.004, 0.053, 0.003);
            Budget budget;
            budget.fidelity = fidelity;
            (void)hand.model->step(at(p), budget);
            most = std::max({most, hand.model->tool_touch().looked, hand.model->tool_touch().asked});
            // A query that finds too many triangles is repeated with a smaller reach.
            ASSERT_LE(hand.model->tool_touch().looked, queries + 6) << fidelity << ", step " << i;
            ASSERT_LE(hand.model->tool_touch().asked, queries + 1) << fidelity << ", step " << i;
        }
        EXPECT_GE(most, std::min(queries, 150U)) << fidelity;
        // Points that touch stay until they are free.
        const std::uint32_t used = hand.model->contact().points().awake();
        EXPECT_GE(used, hand.model->items(fidelity)) << fidelity;
        EXPECT_LE(used, hand.model->items(fidelity) + 6) << fidelity;
    }
    EXPECT_EQ(ToolModel::queries(0.0F), ToolModel::kQueriesLeast);
    EXPECT_EQ(ToolModel::queries(1.0F), ToolContact::kQueriesMost);
    // All points before more queries.
    const auto model = box_on_rough().model({});
    EXPECT_EQ(model->items(ToolModel::kAllPointsAt), model->contact().points().size());
    EXPECT_EQ(ToolModel::queries(ToolModel::kAllPointsAt), ToolModel::kQueriesLeast);
}

TEST(Tool, out_of_time_the_proxy_stays_in_free_space) {
    Hand hand(scaler_on_rough(), plain(), slide(0.0, -0.004));
    Budget hurried;
    hurried.deadline = instant_from_ns(0);
    const World& w = scaler_on_rough();
    for (int i = 0; i < 400; ++i) {
        const Pose p = slide(2e-3 * i, 0.001);
        const StepResult result = hand.model->step(at(p.p_m, p.q), hurried);
        EXPECT_EQ(result.status, StepStatus::out_of_time);
        if (i % 100 != 99) continue;
        for (std::size_t k = 0; k < w.tool.points(); ++k)
            ASSERT_GT(w.mesh.nearest(hand.model->contact().proxy() * w.tool.at_m(k), 10.0).distance_m,
                      0.85 * w.tool.ball_m);
    }
    (void)hand.lead(slide(0.8, -0.02));
    EXPECT_LT((hand.proxy().p_m - hand.place.p_m).norm(), 1e-8);
}

}  // namespace
}  // namespace tact
