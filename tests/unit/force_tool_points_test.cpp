// The points that a move touches, and the share of it that they allow, against all points one by one.
#include "rt/force/surface/point_rows.hpp"
#include "rt/force/surface/tool_lists.hpp"
#include "rt/force/surface/tool_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/force_tool_fixture.hpp"

namespace tact::force_tool_points_test {
namespace {

using namespace tool_test;

TEST(ToolPoints, the_points_beyond_their_room_and_the_share_are_those_of_all_points_one_by_one) {
    const World& w = box_on_rough();
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    for (const std::uint32_t used : {40U, 333U, 1000U}) {
        ToolPoints points(w.mesh, w.tool, w.tool.ball_m);
        Pose at{Vec3(0.0, 0.054 / kWorldPerModel, 0.0), Quat::Identity()};
        at.p_m = points.seat(at);
        for (int i = 0; i < 1000 && !points.tried_all(); ++i) points.wake(at, used, {}, 500);
        points.begin_move(at);
        std::vector<std::uint32_t> listed(1000);
        int limited = 0;
        for (int i = 0; i < 400; ++i) {
            const double size_m = points.reach_m() * std::pow(10.0, -0.01 * i);
            const Vec3 v_m = size_m * vector(), w_rad = size_m / points.reach_m() * vector();
            double share = 1.0;
            std::vector<std::uint32_t> beyond;
            for (std::uint32_t p = 0; p < used; ++p) {
                if (!points.is_awake(p)) continue;
                const double way = points.way_m(p, v_m, w_rad), room = points.room_m(p);
                share = std::min(share, room / way);
                if (way > room * (1.0 + 1e-5)) beyond.push_back(p);
            }
            EXPECT_NEAR(points.share_in_room(v_m, w_rad), share, 1e-12) << used << ", " << i;
            limited += share < 1.0 && share > 0.0 ? 1 : 0;
            const auto end = listed.begin() + static_cast<std::ptrdiff_t>(points.beyond(v_m, w_rad, listed));
            EXPECT_TRUE(std::includes(listed.begin(), end, beyond.begin(), beyond.end()))
                << used << ", " << i;
            for (auto p = listed.begin(); p != end; ++p)
                EXPECT_GT(points.way_m(*p, v_m, w_rad), points.room_m(*p) * (1.0 - 1e-5))
                    << used << ", " << i;
        }
        EXPECT_GT(limited, 50) << used;
    }
}

TEST(PointRows, every_instruction_set_gives_the_same_rooms_and_points_to_the_bit) {
    constexpr std::size_t kCount = 5 * kPointBlock;
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<float> local[3], asked[3], bound(kCount);
    for (auto* rows : {local, asked})
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = 0; i < kCount; ++i) rows[axis].push_back(normal(random));
    for (float& b : bound) b = 2.0F * normal(random) + 2.0F;
    const Eigen::Matrix3f turn = Eigen::Quaternionf(0.5F, 0.1F, -0.7F, 0.4F).normalized().toRotationMatrix();
    std::vector<float> room_of[2], lever_of[2][3];
    std::vector<std::uint64_t> beyond_of[2];
    std::size_t compared = 0;
    for (std::size_t k = kPointKernelCount; k-- > 0;) {  // the generic one first
        const PointKernels& kernels = kPointKernels[k];
        if (!kernels.runs_here()) continue;
        const std::size_t at = k + 1 == kPointKernelCount ? 0 : 1;
        room_of[at].assign(kCount, -5.0F);
        beyond_of[at].clear();
        PointRooms rooms{};
        PointsBeyond beyond{{}, room_of[at].data(), {0.3F, 0.2F, -0.1F}, {0.5F, -0.4F, 0.2F}, 0.9F};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lever_of[at][axis].assign(kCount, -5.0F);
            rooms.local[axis] = local[axis].data();
            rooms.asked[axis] = asked[axis].data();
            rooms.lever[axis] = lever_of[at][axis].data();
            beyond.lever[axis] = lever_of[at][axis].data();
            rooms.hand[axis] = 0.1F * static_cast<float>(axis);
            for (std::size_t column = 0; column < 3; ++column)
                rooms.turn[axis][column] =
                    turn(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(column));
        }
        rooms.bound = bound.data();
        rooms.room = room_of[at].data();
        rooms.count = kCount;
        rooms.taken = 0.01F;
        kernels.rooms(rooms);
        for (std::size_t first = 0; first < kCount; first += kPointBlock)
            beyond_of[at].push_back(kernels.beyond(beyond, first));
        if (at == 0) {
            for (std::size_t i = 0; i < kCount; ++i) {
                const auto row = [i](const std::vector<float>* r) {
                    return Eigen::Vector3f(r[0][i], r[1][i], r[2][i]);
                };
                const Eigen::Vector3f lever = turn * row(local), v(0.3F, 0.2F, -0.1F), w(0.5F, -0.4F, 0.2F);
                const float gone = (lever + Eigen::Vector3f(0.0F, 0.1F, 0.2F) - row(asked)).norm(),
                            room = bound[i] < 0.0F ? 1e30F : std::max(bound[i] - gone - 0.01F, 0.0F),
                            way = (v + w.cross(lever)).norm(), least = std::sqrt(0.9F) * room;
                EXPECT_NEAR(room_of[0][i], room, 1e-5F * room + 1e-5F) << i;
                if (std::abs(way - least) < 1e-4F) continue;
                EXPECT_EQ(beyond_of[0][i / kPointBlock] >> (i % kPointBlock) & 1U, way > least ? 1U : 0U)
                    << i;
            }
            continue;
        }
        ++compared;
        EXPECT_EQ(beyond_of[1], beyond_of[0]) << kernels.name;
        EXPECT_EQ(room_of[1], room_of[0]) << kernels.name;
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_EQ(lever_of[1][axis], lever_of[0][axis]) << kernels.name;
    }
    RecordProperty("compared", static_cast<int>(compared));
}

// Along a path, with every way by which a bound is renewed: none promises more room than the nearest triangle leaves.
TEST(ToolPoints, what_is_remembered_of_other_places_never_promises_more_than_is_free) {
    const World& w = box_on_rough();
    ToolPoints points(w.mesh, w.tool, w.tool.ball_m);
    Pose at{Vec3(0.0, 0.054 / kWorldPerModel, 0.0), Quat::Identity()};
    at.p_m = points.seat(at);
    for (int i = 0; i < 1000 && !points.tried_all(); ++i) points.wake(at, 1000, {}, 500);
    const double step_m = 0.02 * points.reach_m();
    std::size_t recalled = 0, asked = 0;
    for (int i = 0; i < 200; ++i) {
        points.begin_move(at);
        for (std::uint32_t p = 0; p < 1000; ++p) {
            if (!points.is_awake(p) || points.room_m(p) >= step_m) continue;
            if (points.recall(p, step_m)) {
                ++recalled;
                ASSERT_GE(points.room_m(p), step_m) << p << ", step " << i;
            } else {
                points.ask(p, step_m);
                ++asked;
            }
            const double free_m = w.mesh.nearest(points.place_m(p), 1.0).distance_m - w.tool.ball_m;
            ASSERT_LE(points.room_m(p), std::max(free_m, 0.0) + 1e-9) << p << ", step " << i;
        }
        at.p_m += step_m * Vec3(std::cos(0.05 * i), 0.1 * std::sin(0.3 * i), std::sin(0.05 * i));
        at.q = (quat_from_rotation_vector(Vec3(0.0, 0.01, 0.002)) * at.q).normalized();
    }
    EXPECT_GT(recalled, asked);  // or they need not be remembered
}

// A point that was found to be free on its way is left out of this move's list as long as it ends near the end of that way.
TEST(ToolPoints, a_point_that_passed_is_listed_again_elsewhere_and_in_the_next_move) {
    const World& w = box_on_rough();
    ToolPoints points(w.mesh, w.tool, w.tool.ball_m);
    Pose at{Vec3(0.0, 0.054 / kWorldPerModel, 0.0), Quat::Identity()};
    at.p_m = points.seat(at);
    for (int i = 0; i < 1000 && !points.tried_all(); ++i) points.wake(at, 1000, {}, 500);
    points.begin_move(at);
    const Vec3 v_m = 3.0 * points.reach_m() * Vec3(0.6, 0.0, 0.8), w_rad(0.2, -0.1, 0.3);
    const double over_m = 0.05 * points.reach_m();
    std::vector<std::uint32_t> listed(1000);
    const auto is_listed = [&](std::uint32_t p, const Vec3& more_m) {
        const auto end =
            listed.begin() + static_cast<std::ptrdiff_t>(points.beyond(v_m + more_m, w_rad, listed));
        return std::find(listed.begin(), end, p) != end;
    };
    int tried = 0;
    for (std::uint32_t p = 0; p < 1000; p += 37) {
        if (!is_listed(p, Vec3::Zero())) continue;
        ++tried;
        points.passes(p, v_m + w_rad.cross(points.lever_m(p).cast<double>()), over_m);
        EXPECT_FALSE(is_listed(p, Vec3::Zero())) << p;
        EXPECT_FALSE(is_listed(p, Vec3(0.0, 0.98 * over_m, 0.0))) << p;
        EXPECT_TRUE(is_listed(p, Vec3(0.0, 1.02 * over_m, 0.0))) << p;
    }
    EXPECT_GT(tried, 10);
    const std::size_t now = points.beyond(v_m, w_rad, listed);
    points.begin_move(at);
    EXPECT_EQ(points.beyond(v_m, w_rad, listed), now + static_cast<std::size_t>(tried));
}

// From a place where a list of triangles was queried, to two others: neither at the first nor along the way between them is any
// triangle nearer than the bounds say.
TEST(ToolLists, what_was_seen_of_triangles_never_promises_more_than_is_free) {
    const World& w = box_on_rough();
    ToolLists lists(w.mesh, 1, false);
    lists.begin_step(nullptr);
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    const double ball_m = w.tool.ball_m;
    int known = 0, close = 0, tight = 0;
    for (int i = 0; i < 3000; ++i) {
        const SurfacePoint on = w.mesh.nearest(0.05 / kWorldPerModel * vector().normalized(), 1.0);
        const Vec3 place = on.point_m + ball_m * (1.0 + std::abs(normal(random))) * w.mesh.normal_at(on);
        const ToolLists::Near list = lists.near(0, place, 12.0 * ball_m);
        if (list.seen == nullptr) continue;
        QueryJob job = w.mesh.query_job(place);
        for (std::size_t first = 0; first < list.count; first += kLooks) {
            job.triangle = list.triangle + first;
            SeenTriangles& block = list.seen[first / kLooks];
            best_query_kernel().query(job, block.seen);
            block.place_m = place;
            block.least_m = static_cast<double>(
                *std::min_element(std::begin(block.seen.distance), std::end(block.seen.distance)));
        }
        const double size_m = ball_m * std::pow(10.0, -0.0005 * i);
        const Vec3 begin = place + size_m * vector(), end = begin + size_m * vector();
        const auto clear = lists.clearance_m(0, begin, end, i % 2 == 0 ? 0.0 : 4.0 * ball_m);
        if (clear.way_m < 0.0) continue;  // nothing promised: too far, or a triangle is in the way
        ++known;
        const double free_m = w.mesh.nearest(begin, 1.0).distance_m;
        ASSERT_LE(clear.begin_m, free_m + 1e-9) << i;
        tight += clear.begin_m > 0.9 * free_m ? 1 : 0;
        for (int k = 0; k <= 20; ++k) {
            const double there_m = w.mesh.nearest(begin + 0.05 * k * (end - begin), 1.0).distance_m;
            ASSERT_LE(clear.way_m, there_m + 1e-9) << i << ", " << k;
            close += clear.way_m > 0.8 * there_m ? 1 : 0;
        }
    }
    EXPECT_GT(known, 1000);
    EXPECT_GT(tight, known / 2);
    EXPECT_GT(close, 5 * known);
}

}  // namespace
}  // namespace tact::force_tool_points_test
