// A tool that slides over curved and rough surfaces: contract of the model, levels, smoothness, energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "ipc/base/random.hpp"
#include "tests/contract/force_model_contract.hpp"
#include "tests/unit/force_surface_fixture.hpp"

namespace tact {
namespace {

using namespace surface_test;

// Around the sphere's axis at 0.5 m/s: at rest a step needs one move, so the knob matters only while the proxy moves.
ForceModelCase moving(const char* name, std::function<std::unique_ptr<ForceModel>()> make, double grip_y_m,
                      const Vec3& touch_m) {
    ForceModelCase c;
    c.name = name;
    c.make = std::move(make);
    c.grip = {Vec3(0.0, grip_y_m, 0.0), Quat::Identity()};
    c.touch = {touch_m, Quat::Identity()};
    c.path = [touch_m](int i) {
        return Pose{Eigen::AngleAxisd(0.01 * i, Vec3::UnitZ()) * touch_m, Quat::Identity()};
    };
    c.path_steps = 200;
    c.items_tolerance = 0.2;
    return c;
}

INSTANTIATE_TEST_SUITE_P(Surface, ForceModelContract,
                         testing::Values(moving("point", [] { return smooth().model({}); }, 0.056,
                                                {0.004, 0.048, 0.003}),
                                         moving("ball", [] { return rough().model({.radius_m = 0.003}); },
                                                0.066, {0.004, 0.05, 0.003})),
                         [](const auto& tested) { return tested.param.name; });

TEST(Surface, a_step_with_few_moves_that_is_settled_ends_where_more_moves_would) {
    const double radius_m = 1e-4 / kWorldPerModel, margin_m = 1e-3 * radius_m;
    int settled = 0, lagging = 0;
    for (const std::uint32_t moves : {4U, 6U, 9U}) {
        SurfaceContact contact(rough().mesh, {radius_m, margin_m, 0.0, 1e-4 / kWorldPerModel});
        const auto goal = [](double angle_rad) {
            return Vec3(0.048 / kWorldPerModel *
                        Vec3(std::sin(angle_rad), std::cos(angle_rad), 0.1 * std::sin(3.0 * angle_rad)));
        };
        contact.seat(1.4 * goal(0.0));
        for (int i = 0; i < 200; ++i) (void)contact.follow((1.4 - 0.002 * i) * goal(0.0), 24);
        for (int i = 0; i < 600; ++i) {
            const Contact few = contact.follow(goal(0.01 * i), moves);
            lagging += few.state == ContactState::lagging ? 1 : 0;
            if (few.state != ContactState::settled) continue;
            ++settled;
            SurfaceContact more = contact;
            const Contact all = more.follow(goal(0.01 * i), SurfaceContact::kMovesMost);
            EXPECT_LT((all.proxy_m - few.proxy_m).norm(), 20.0 * margin_m) << moves << " moves, step " << i;
        }
    }
    EXPECT_GT(settled, 100);
    EXPECT_GT(lagging, 100);
}

// The reference is Coulomb's law on a plane. Edges between triangles of one plane hold nothing back.
TEST(Surface, on_a_plate_of_many_triangles_the_force_stays_in_the_friction_cone_and_reaches_its_rim) {
    for (const double friction : {0.1, 0.3, 0.8}) {
        for (const double radius_m : {0.0, 0.003}) {
            for (const bool shading : {false, true}) {
                for (const double speed_m_s : {0.05, 0.2, 0.5}) {
                    const auto place = [&](double t_s) {
                        const double angle = speed_m_s / 0.02 * t_s;
                        return Vec3(
                            0.02 * std::sin(angle),
                            radius_m - 0.002 * std::min(t_s / 0.05, 1.0) + 0.0008 * std::sin(60.0 * t_s),
                            0.015 * std::sin(1.3 * angle));
                    };
                    Hand hand(plane(), {.radius_m = radius_m, .friction = friction, .shading = shading},
                              place(0.0) + Vec3(0.0, 0.004, 0.0));
                    (void)hand.lead(place(0.0));
                    double most = 0.0;
                    for (int i = 0; i < 1500; ++i) {
                        ToolState tool = at(place(1e-3 * i));
                        tool.twist_world.linear_m_s = (place(1e-3 * (i + 1)) - place(1e-3 * i)) / 1e-3;
                        const Vec3 force_n = hand.model->step(tool, {}).wrench_world.force_n;
                        if (force_n.y() < 0.02) continue;
                        const double share = std::hypot(force_n.x(), force_n.z()) / force_n.y();
                        ASSERT_LE(share, 1.01 * friction) << "radius " << radius_m << ", step " << i;
                        most = std::max(most, share);
                    }
                    EXPECT_GE(most, 0.99 * friction);
                }
            }
        }
    }
}

// Where rounding puts the ball a little below its plane, the edge of the next triangle must not hold it.
TEST(Surface, on_a_tilted_plate_no_edge_holds_the_ball) {
    const Vec3 up = tilt() * Vec3::UnitY();
    for (const double radius_m : {0.0, 0.003}) {
        const auto place = [&](double t_s) {
            const double angle = 10.0 * t_s;
            return Vec3(tilt() *
                        Vec3(0.02 * std::sin(angle), radius_m - 0.002, 0.015 * std::sin(1.3 * angle)));
        };
        Hand hand(tilted_plane(), plain(radius_m), place(0.0) + 0.006 * up);
        (void)hand.lead(place(0.0));
        std::uint64_t moves = 0;
        for (int i = 0; i < 3000; ++i) {
            const Vec3 force_n = hand.step(place(1e-3 * i));
            moves += hand.model->contact().moves;

            const double along_n = (force_n - force_n.dot(up) * up).norm();
            ASSERT_LE(along_n, 0.002 * force_n.dot(up)) << "radius " << radius_m << ", step " << i;
        }
        EXPECT_LE(moves, 3010U) << "a step takes one move, because no edge stands in its way";
    }
}

// Friction may hold a proxy that lagged once where it is: the bound may not fade with the way of the tool.
TEST(Surface, after_a_lag_the_error_bounds_the_difference_for_as_long_as_the_tool_touches) {
    int late_differences = 0;
    for (int variant = 0; variant < 20; ++variant) {
        const Vec3 touch(0.004 + 1e-5 * variant, 0.048, 0.003 - 1e-5 * variant);
        const auto led = [&](float fidelity) {
            Hand hand(rough(), {}, {0.0, 0.066, 0.0});
            (void)hand.lead(touch);
            std::vector<StepResult> steps;
            Budget budget;
            budget.fidelity = fidelity;
            for (int i = 0; i < 200; ++i) {
                const Vec3 goal = Eigen::AngleAxisd(0.01 * i, Vec3::UnitZ()) * touch;
                steps.push_back(hand.model->step(at(goal), budget));
            }
            return steps;
        };
        const std::vector<StepResult> full = led(1.0F);
        for (const float fidelity : {0.0F, 0.25F, 0.5F, 0.75F}) {
            const std::vector<StepResult> few = led(fidelity);
            std::size_t last_lag = few.size();
            for (std::size_t i = 0; i < few.size(); ++i) {
                if (few[i].status != StepStatus::ok || full[i].status != StepStatus::ok) last_lag = i;
                const double off_n = (few[i].wrench_world.force_n - full[i].wrench_world.force_n).norm();
                EXPECT_LE(off_n, few[i].load.error + full[i].load.error + 1e-9)
                    << "variant " << variant << " at " << fidelity << ", step " << i;
                late_differences += i > last_lag + 30 && off_n > 0.1 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(late_differences, 0);
}

// The reference is the sphere's normal through the tool. Remaining error with shading: a facet normal is off by a
// at the proxy, r + d from the tool, which moves the interpolation point by a (r + d) / R; the vertex normals add
// their own error.
TEST(Surface, on_a_smooth_sphere_the_shaded_force_is_along_the_sphere_normal) {
    const SurfaceMesh& mesh = smooth().mesh;
    const auto between = [](const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); };
    double facet = 0.0, vertex = 0.0;
    for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
        for (const std::uint32_t v : mesh.corners(t)) {
            facet = std::max(facet, between(mesh.facet_normal(t), mesh.position_m(v)));
            vertex = std::max(vertex, between(mesh.normal(v), mesh.position_m(v)));
        }
    }
    for (const double radius_m : {0.0, 0.001, 0.003}) {
        for (const double speed : {1.0, 4.0}) {
            SurfaceSettings settings = plain(radius_m);
            settings.shading = true;
            const double depth_m = 0.0015;
            const auto place = [&](int i) {
                const Vec3 p = slide(1e-3 * speed * i, 0.0);
                return Vec3((kRoughSphereM + radius_m - depth_m) * p.normalized());
            };
            Hand hand(smooth(), settings, 1.2 * place(0));
            (void)hand.lead(place(0));
            double most = 0.0;
            for (int i = 0; i < 2000; ++i) most = std::max(most, between(hand.step(place(i)), hand.place));
            EXPECT_LT(most, vertex + facet * (radius_m + depth_m) / kRoughSphereM);
        }
    }
}

// Facets are 8.7 degrees apart, 40 per second: shading must turn the force as fast as the facets change.
TEST(Surface, on_a_coarse_sphere_shading_follows_a_fast_hand_without_force_steps) {
    static const auto coarse = scene(smooth_sphere(10));
    for (const double radius_m : {0.0, 0.001, 0.003}) {
        SurfaceSettings settings = plain(radius_m);
        settings.shading = true;
        const auto place = [&](int i) {
            const Vec3 p = slide(4e-3 * i, 0.0);
            return Vec3((kRoughSphereM + radius_m - 0.0015) * p.normalized());
        };
        Hand hand(*coarse, settings, 1.2 * place(0));
        Vec3 before = hand.lead(place(0));
        std::vector<double> off;
        for (int i = 0; i < 3000; ++i) {
            const Vec3 last = hand.place, force = hand.step(place(i));
            off.push_back(std::atan2(force.cross(hand.place).norm(), force.dot(hand.place)));
            ASSERT_LT((force - before).norm(),
                      2.5 * kStiffness * (hand.place - last).norm() + 2.0 * SurfaceModel::kLagN + 1e-3);
            before = force;
        }
        std::sort(off.begin(), off.end());
        EXPECT_LT(off[off.size() * 99 / 100] * 180.0 / std::numbers::pi, 1.5) << radius_m;
    }
}

// The proxy is free, and no free position near it on this side of the surface is nearer to the goal.
void expect_settled(const Hand& hand, double radius_m, SeededRandom& random) {
    const auto clearance_m = [](const Vec3& world_m) {
        return kWorldPerModel * rough().mesh.nearest(world_m / kWorldPerModel, 1.0).distance_m;
    };
    const double margin_m = std::max(1e-3 * radius_m, 2e-6);
    EXPECT_GT(clearance_m(hand.proxy()), radius_m - 1.1 * margin_m);
    const double way_m = (hand.proxy() - hand.place).norm();
    for (int i = 0; i < 500; ++i) {
        const Vec3 to = 1e-4 * random.direction();
        if ((hand.proxy() + to - hand.place).norm() > way_m - 2e-5) continue;
        double least = 1.0;
        for (int k = 1; k <= 20; ++k) least = std::min(least, clearance_m(hand.proxy() + 0.05 * k * to));
        EXPECT_LT(least, std::max(radius_m, 4e-6) + margin_m);
    }
}

TEST(Surface, the_proxy_never_jams_on_a_rough_surface) {
    SeededRandom random(7);
    int unproven = 0;
    for (const double radius_m : {0.0, 0.003}) {
        for (const double speed : {1.0, 4.0}) {
            Hand hand(rough(), plain(radius_m), slide(0.0, -0.008));
            (void)hand.lead(slide(0.0, 0.0015 - radius_m));
            for (int i = 0; i < 2500; ++i) {
                (void)hand.step(slide(1e-3 * speed * i, 0.0015 - radius_m));
                // A jammed proxy falls behind by 60 mm/s and more.
                ASSERT_LT((hand.proxy() - hand.place).norm(), 0.009) << "sample " << i;
                if (i % 500 == 499) {
                    (void)hand.lead(hand.place);
                    if (hand.model->contact().state == ContactState::settled)
                        expect_settled(hand, radius_m, random);
                    else
                        ++unproven;
                }
            }
        }
    }
    // Of 20. Which of them depends on the rounding of the compiler: none with g++ 12, one with g++ 14.
    EXPECT_LE(unproven, 1);
}

TEST(Surface, most_steps_of_a_slide_settle_in_one_move) {
    SeededRandom random(9);
    for (const double radius_m : {0.0, 0.001}) {
        Hand hand(rough(), plain(radius_m), slide(0.0, -0.008));
        (void)hand.lead(slide(0.0, 0.0015 - radius_m));
        int one = 0;
        constexpr int kSteps = 1500;
        for (int i = 0; i < kSteps; ++i) {
            const Vec3 before = hand.proxy();
            (void)hand.step(slide(1e-3 * i, 0.0015 - radius_m));
            const Contact& contact = hand.model->contact();
            if (contact.moves > 1 || contact.state != ContactState::settled) continue;
            if ((hand.proxy() - before).norm() < 2e-5) continue;  // it was at rest before
            if (++one % 40 == 0) expect_settled(hand, radius_m, random);
        }
        EXPECT_GT(one, kSteps / 3) << radius_m;
    }
}

// In hollows of a dense rough surface that just fit the ball, all directions are level within rounding: moves in a circle
// must not use up the step. At these two places of a slide, ten and seven steps in a row once did.
TEST(Surface, a_ball_in_a_hollow_that_it_fits_comes_to_rest) {
    const auto toward = [](double t_s) {
        const double around = 1.1 * t_s + 0.3 * std::sin(0.7 * t_s),
                     up = 0.9 * std::sin(0.61 * t_s) + 0.2 * std::sin(3.1 * t_s);
        return Vec3(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
    };
    for (const double middle_s : {1.140, 3.180}) {
        const Vec3 out = toward(middle_s), right = out.unitOrthogonal(), up = out.cross(right);
        constexpr std::uint32_t kParts = 150;  // across 9 mm
        TriangleMesh mesh;
        for (std::uint32_t i = 0; i <= kParts; ++i) {
            for (std::uint32_t k = 0; k <= kParts; ++k) {
                const Vec3 d =
                    (out + 0.09 * ((2.0 * i / kParts - 1.0) * right + (2.0 * k / kParts - 1.0) * up))
                        .normalized();
                for (const double x : {d.x(), d.y(), d.z()})
                    mesh.position_m.push_back(static_cast<float>(rough_radius_m(d) * x));
            }
        }
        for (std::uint32_t i = 0; i < kParts; ++i) {
            for (std::uint32_t k = 0; k < kParts; ++k) {
                const std::uint32_t a = i * (kParts + 1) + k, b = a + kParts + 1;
                mesh.triangle.insert(mesh.triangle.end(), {a, b, b + 1, a, b + 1, a + 1});
            }
        }
        const auto patch = scene(std::move(mesh));
        const auto place = [&](double t_s) {
            const Vec3 d = toward(t_s);
            return Vec3((rough_radius_m(d) - 0.0015 - 0.0005 * std::sin(8.2 * t_s)) * d);
        };
        Hand hand(*patch, plain(0.003), 0.06 * out);
        (void)hand.lead(place(middle_s - 0.04));
        int row = 0, longest = 0;
        for (int i = -40; i < 40; ++i) {
            (void)hand.step(place(middle_s + 1e-3 * i));
            row = hand.model->contact().state == ContactState::lagging ? row + 1 : 0;
            longest = std::max(longest, row);
        }
        EXPECT_LT(longest, 4) << middle_s;
    }
}

TEST(Surface, force_change_per_step_is_bounded_by_the_hand_motion) {
    for (const double friction : {0.0, 0.4}) {
        for (const double speed : {1.0, 4.0}) {
            SurfaceSettings settings = plain(0.001, friction);
            settings.shading = true;
            Hand hand(rough(), settings, slide(0.0, -0.005));
            Vec3 before = hand.lead(slide(0.0, 0.001));
            for (int i = 0; i < 2000; ++i) {
                const Vec3 last = hand.place;
                const Vec3 force = hand.step(slide(1e-3 * speed * i, 0.001));
                const double moved = (hand.place - last).norm();
                ASSERT_LT((force - before).norm(),
                          2.5 * kStiffness * moved + 2.0 * SurfaceModel::kLagN + 1e-3);
                before = force;
            }
        }
    }
}

TEST(Surface, a_closed_path_gains_no_energy) {
    SeededRandom random(3);
    for (const double friction : {0.0, 0.3}) {
        for (int path = 0; path < 6; ++path) {
            const Vec3 centre = slide(1.3 * path, 0.0005), a = 0.002 * random.direction(),
                       b = 0.002 * random.direction();
            const auto place = [&](double s) {
                return Vec3(centre + std::sin(2.0 * std::numbers::pi * s) * a +
                            std::sin(4.0 * std::numbers::pi * s) * b);
            };
            Hand hand(rough(), plain(0.001, friction), 1.2 * centre);
            (void)hand.lead(place(0.0));
            constexpr int kSteps = 1500;
            // The first round finds the hollows in which the proxy stays.
            for (int i = 0; i < kSteps; ++i) (void)hand.step(place(static_cast<double>(i) / kSteps));
            const double held_j = 0.5 * kStiffness * (hand.proxy() - hand.place).squaredNorm();
            double gained_j = 0.0;
            Vec3 before = hand.step(place(0.0));
            for (int i = 1; i <= kSteps; ++i) {
                const Vec3 last = hand.place;
                const Vec3 force = hand.step(place(static_cast<double>(i) / kSteps));
                gained_j += 0.5 * (force + before).dot(hand.place - last);
                before = force;
            }
            const double left_j = 0.5 * kStiffness * (hand.proxy() - hand.place).squaredNorm();
            EXPECT_LT(gained_j, held_j - left_j + 2e-5) << "path " << path << ", friction " << friction;
        }
    }
}

}  // namespace
}  // namespace tact
