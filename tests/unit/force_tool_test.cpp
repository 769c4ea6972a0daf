// Tools given as meshes: sampling, section, contact, force and torque.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "prep/surface/build_surface.hpp"
#include "prep/surface/sample_tool.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "tests/contract/force_model_contract.hpp"

namespace tact {
namespace {

constexpr double kStiffness = 500.0, kWorldPerModel = 10.0;

TriangleMesh box_mesh(const Vec3& half_m) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis)
            mesh.position_m.push_back(
                static_cast<float>((i >> axis & 1) != 0 ? half_m[axis] : -half_m[axis]));
    mesh.triangle = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

void append_box(TriangleMesh& to, const Vec3& middle_m, const Vec3& half_m) {
    const auto first = static_cast<std::uint32_t>(to.vertices());
    const TriangleMesh box = box_mesh(half_m);
    for (std::size_t i = 0; i < box.position_m.size(); ++i)
        to.position_m.push_back(box.position_m[i] +
                                static_cast<float>(middle_m[static_cast<Eigen::Index>(i % 3)]));
    for (const std::uint32_t c : box.triangle) to.triangle.push_back(first + c);
}

// A square of 0.2 m, y up, of 2 * parts^2 triangles.
TriangleMesh plane_mesh(std::uint32_t parts = 40) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i <= parts; ++i)
        for (std::uint32_t k = 0; k <= parts; ++k)
            for (const double x : {0.2 * i / parts - 0.1, 0.0, 0.2 * k / parts - 0.1})
                mesh.position_m.push_back(static_cast<float>(x));
    for (std::uint32_t i = 0; i < parts; ++i) {
        for (std::uint32_t k = 0; k < parts; ++k) {
            const std::uint32_t a = i * (parts + 1) + k, b = a + parts + 1;
            mesh.triangle.insert(mesh.triangle.end(), {a, b + 1, b, a, a + 1, b + 1});
        }
    }
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double by) {
    for (float& x : mesh.position_m) x *= static_cast<float>(by);
    return mesh;
}

// A scene in memory; sizes are in world metres.
struct World {
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> file;
    SurfaceMesh mesh;
    TouchTool tool;
    SceneMeta meta{};
    std::unique_ptr<ToolModel> model(const SurfaceSettings& settings) const {
        return std::make_unique<ToolModel>(meta, mesh, tool, settings);
    }
    [[nodiscard]] double ball_world_m() const { return kWorldPerModel * tool.ball_m; }
};

std::unique_ptr<World> world(const TriangleMesh& surface, const TriangleMesh& tool,
                             ToolSampling sampling = {}) {
    auto w = std::make_unique<World>();
    SceneWriter out;
    write_surface(out, build_surface(scaled(surface, 1.0 / kWorldPerModel)));
    write_touch_tool(out, sample_tool(scaled(tool, 1.0 / kWorldPerModel), sampling));
    w->bytes = out.to_bytes();
    w->file = std::make_unique<SceneFile>(SceneFile::from_bytes(w->bytes, "test.tact"));
    w->mesh = read_surface(*w->file);
    w->tool = read_touch_tool(*w->file);
    w->meta.kind = SceneKind::surface;
    w->meta.world_per_model = kWorldPerModel;
    return w;
}

// A box of 0.03 x 0.01 x 0.02 m over a plane. Few points are enough, because its corners decide.
const World& box_on_plane() {
    static const auto made =
        world(plane_mesh(), box_mesh({0.015, 0.005, 0.01}), {.points = 300, .grip_in_middle = true});
    return *made;
}

// A thin bar of 0.04 m along x over two blocks at x = -0.01 and x = 0.015.
const World& bar_on_blocks() {
    static const auto made = [] {
        TriangleMesh blocks;
        append_box(blocks, {-0.01, -0.01, 0.0}, {0.001, 0.01, 0.02});
        append_box(blocks, {0.015, -0.01, 0.0}, {0.001, 0.01, 0.02});
        return world(blocks, box_mesh({0.02, 0.001, 0.001}), {.points = 2000});
    }();
    return *made;
}

const World& scaler_on_rough() {
    static const auto made = world(rough_sphere(60), made_tool("scaler"), {.grip_in_middle = false});
    return *made;
}

SurfaceSettings plain(double friction = 0.0) {
    return {.stiffness_n_m = kStiffness, .damping_n_s_m = 0.0, .friction = friction, .shading = false};
}

ToolState at(const Vec3& p, const Quat& q = Quat::Identity()) {
    ToolState tool;
    tool.T_world_tool = {p, q};
    return tool;
}

struct Hand {
    std::unique_ptr<ToolModel> model;
    Pose place;
    Wrench felt;
    Hand(const World& w, const SurfaceSettings& settings, const Pose& start)
        : model(w.model(settings)), place(start) {
        model->reset(at(start.p_m, start.q));
        for (int i = 0; i < ForceFade::ramp_steps(1e-3) + 8; ++i) (void)step(start);
    }
    const Wrench& step(const Pose& pose) {
        place = pose;
        felt = model->step(at(pose.p_m, pose.q), {}).wrench_world;
        return felt;
    }
    // Moves in steps of 0.1 mm or 0.01 rad, then rests.
    const Wrench& lead(const Pose& to, int rest = 300) {
        const Pose from = place;
        const int steps = 1 + static_cast<int>(std::max((to.p_m - from.p_m).norm() / 1e-4,
                                                        from.q.angularDistance(to.q) / 1e-2));
        for (int i = 1; i <= steps; ++i) {
            const double s = static_cast<double>(i) / steps;
            (void)step({from.p_m + s * (to.p_m - from.p_m), from.q.slerp(s, to.q)});
        }
        for (int i = 0; i < rest; ++i) (void)step(to);
        return felt;
    }
    [[nodiscard]] Pose proxy() const {
        Pose p = model->contact().proxy();
        p.p_m *= kWorldPerModel;
        return p;
    }
};

Pose pose(const Vec3& p, const Vec3& turn_rad = Vec3::Zero()) {
    return {p, quat_from_rotation_vector(turn_rad)};
}

TEST(TouchTool, every_prefix_of_the_points_is_an_even_sampling) {
    const TriangleMesh mesh = box_mesh({0.015, 0.005, 0.01});
    const TouchTool tool = sample_tool(mesh, {.points = 600});
    ASSERT_EQ(tool.points(), 600U);
    SeededRandom random(5);
    for (const std::size_t n : {8U, 40U, 200U, 600U}) {
        const double cover = tool.cover_m[n - 1], ball = tool.ball_m;
        double nearest = 1e9, farthest = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < i; ++k)
                nearest = std::min(nearest, (tool.at_m(i) - tool.at_m(k)).norm());
        for (int i = 0; i < 2000; ++i) {  // a point on the surface
            Vec3 p = random.direction();
            p = p.cwiseAbs().maxCoeff() > 0.0 ? Vec3(p / p.cwiseAbs().maxCoeff()) : p;
            p = p.cwiseProduct(Vec3(0.015, 0.005, 0.01));
            double least = 1e9;
            for (std::size_t k = 0; k < n; ++k) least = std::min(least, (tool.at_m(k) - p).norm());
            farthest = std::max(farthest, least);
        }
        EXPECT_LE(farthest, 1.15 * cover + 3.0 * ball) << n;
        EXPECT_GE(nearest, 0.66 * cover - 4.0 * ball) << n;
    }
    // The first points include all corners; every ball is inside and touches the surface.
    std::size_t corners = 0, stick_out = 0;
    for (std::size_t i = 0; i < tool.points(); ++i) {
        const Vec3 below = Vec3(0.015, 0.005, 0.01) - tool.at_m(i).cwiseAbs();
        if (i < 60 && below.maxCoeff() < 1.3 * tool.ball_m) ++corners;
        if (below.minCoeff() < 0.97 * tool.ball_m) ++stick_out;
        EXPECT_GT(below.minCoeff(), 0.0);
        EXPECT_LT(below.minCoeff(), 1.3 * tool.ball_m);
    }
    EXPECT_EQ(corners, 8U);
    EXPECT_LT(stick_out, 12U);
}

TEST(TouchTool, the_same_mesh_gives_the_same_tool_and_the_section_holds_it) {
    const TriangleMesh mesh = made_tool("scaler");
    SceneWriter out;
    const TouchTool a = sample_tool(mesh, {.points = 400, .grip_in_middle = false}),
                    b = sample_tool(mesh, {.points = 400, .grip_in_middle = false});
    EXPECT_EQ(a.point_m, b.point_m);
    write_touch_tool(out, a);
    const auto bytes = out.to_bytes();
    const TouchTool read = read_touch_tool(SceneFile::from_bytes(bytes, "t"));
    EXPECT_EQ(read.point_m, a.point_m);
    EXPECT_EQ(read.normal, a.normal);
    EXPECT_EQ(read.parent, a.parent);
    EXPECT_EQ(read.cover_m, a.cover_m);
    EXPECT_EQ(read.drawn, a.drawn);
    EXPECT_EQ(read.ball_m, a.ball_m);
}

TEST(TouchTool, a_wrong_section_is_refused) {
    const TouchTool good = sample_tool(box_mesh({0.01, 0.01, 0.01}), {.points = 20});
    const auto refused = [&](auto change) {
        TouchTool tool = good;
        change(tool);
        SceneWriter out;
        write_touch_tool(out, tool);
        const auto bytes = out.to_bytes();
        const SceneFile file = SceneFile::from_bytes(bytes, "t");
        EXPECT_THROW((void)read_touch_tool(file), StartupError);
    };
    refused([](TouchTool& t) { t.parent[3] = 3; });
    refused([](TouchTool& t) { t.parent[0] = 1; });
    refused([](TouchTool& t) { t.ball_m = 0.0; });
    refused([](TouchTool& t) { t.ball_m = std::nan(""); });
    refused([](TouchTool& t) { t.point_m[4] = std::nanf(""); });
    refused([](TouchTool& t) { t.cover_m[5] = 2.0F * t.cover_m[4] + 1.0F; });
    refused([](TouchTool& t) { t.drawn[2] = 8; });
    refused([](TouchTool& t) { t.point_m.pop_back(); });
    refused([](TouchTool& t) { t.parent.clear(); });
}

TEST(TouchTool, made_tools_are_closed_and_turned_outward) {
    for (const char* name : kMadeTools) {
        const TriangleMesh mesh = made_tool(name);
        EXPECT_TRUE(build_surface(mesh).closed) << name;
        double volume = 0.0;
        const auto at = [&](std::size_t i) {
            const float* p = mesh.position_m.data() + 3 * mesh.triangle[i];
            return Vec3(p[0], p[1], p[2]);
        };
        for (std::size_t t = 0; t < mesh.triangle.size(); t += 3)
            volume += at(t).dot(at(t + 1).cross(at(t + 2)));
        EXPECT_GT(volume, 0.0) << name;
    }
    EXPECT_EQ(made_tool("none").triangles(), 0U);
}

TEST(TwistHalfSpaces, the_solution_is_the_nearest_twist_inside_all_half_spaces) {
    SeededRandom random(11);
    const auto number = [&] { return 2.0 * random.uniform() - 1.0; };
    for (int trial = 0; trial < 60; ++trial) {
        TwistHalfSpaces half_spaces;
        const int count = 1 + static_cast<int>(random.below(40));
        std::vector<std::pair<Vec6, double>> plane;
        for (int i = 0; i < count; ++i) {
            const Vec3 n = random.direction(), lever(number(), number(), number());
            TriangleQueries look{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                look.away[axis][0] = static_cast<float>(n[static_cast<Eigen::Index>(axis)]);
            const auto slack = static_cast<float>(0.3 * random.uniform());
            ASSERT_TRUE(half_spaces.add(0, 0, lever.cast<float>(), look, 0, slack, slack, false));
            Vec6 normal;
            normal << n, lever.cross(n);
            plane.emplace_back(normal, static_cast<double>(slack));
        }
        Vec6 goal;
        for (double& x : goal) x = number();
        TwistHalfSpaces::Solution s = TwistHalfSpaces::fresh(goal);
        half_spaces.solve(goal, 1e-6, s);
        ASSERT_TRUE(s.exact);
        Vec6 pushed = goal;
        for (std::size_t i = 0; i < s.active_count; ++i) {
            EXPECT_GE(s.active[i].weight_m, 0.0);
            EXPECT_NEAR(s.active[i].normal.dot(s.move_m) + s.active[i].slack_m, 0.0, 2e-6);
            pushed += s.active[i].weight_m * s.active[i].normal;
        }
        EXPECT_LT((pushed - s.move_m).norm(),
                  1e-9);  // with the weights above: the optimum (Karush-Kuhn-Tucker)
        for (const auto& [normal, slack] : plane) EXPECT_GT(normal.dot(s.move_m) + slack, -3e-6);
    }
}

// Flat on a ball that pokes between the points: here they matter.
const World& box_on_rough() {
    static const auto made = world(rough_sphere(40), box_mesh({0.015, 0.005, 0.01}), {.points = 1000});
    return *made;
}
ForceModelCase tool_case(const char* name, const World& (*on)(), double grip_y_m, const Pose& touch) {
    ForceModelCase c;
    c.name = name;
    c.make = [on] { return on().model({}); };
    c.grip = pose({0.0, grip_y_m, 0.0});
    c.touch = touch;
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

TEST(Tool, friction_holds_a_box_inside_the_cone_and_lets_it_slide_at_the_rim) {
    constexpr double kFriction = 0.4, kDepth = 0.001;
    Hand hand(box_on_plane(), plain(kFriction), pose({0.0, 0.02, 0.0}));
    (void)hand.lead(pose({0.0, 0.005 - kDepth, 0.0}));
    const Wrench held = hand.lead(pose({0.5 * kFriction * kDepth, 0.005 - kDepth, 0.0}));
    EXPECT_NEAR(-held.force_n.x(), kStiffness * 0.5 * kFriction * kDepth, 0.01);
    const Wrench slides = hand.lead(pose({0.01, 0.005 - kDepth, 0.0}));
    EXPECT_NEAR(-slides.force_n.x(), kFriction * slides.force_n.y(), 0.02);
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
