// Energy of closed excursions of tools: from free, along a path of position and rotation in contact, back to free.
#include <gtest/gtest.h>

#include <cmath>

#include "ipc/base/random.hpp"
#include "tests/unit/force_tool_fixture.hpp"

namespace tact::force_tool_energy_test {
namespace {

using namespace tool_test;

constexpr double kStepS = 1e-3;

// A tool beside a sphere, which it enters, strays over and leaves. The middle of the tool's sides faces the sphere.
struct Path {
    Pose from;  // the tool just touches
    Vec3 out, a_m, b_m, turn_rad, roll_rad;
    double depth_m;
    // s from 0 to 1; free at both ends.
    [[nodiscard]] Pose at(double s) const {
        const double round = 2.0 * std::numbers::pi * s, in = std::sin(std::numbers::pi * s);
        const double press = in < 0.6 ? 0.5 - 0.5 * std::cos(std::numbers::pi * in / 0.6) : 1.0;
        Pose p = from;
        p.p_m +=
            std::sin(round) * a_m + std::sin(2.0 * round) * b_m + (0.004 - (0.004 + depth_m) * press) * out;
        p.q = quat_from_rotation_vector(std::sin(round) * turn_rad + std::sin(2.0 * round) * roll_rad) * p.q;
        return p;
    }
};

Path random_path(double half_height_m, SeededRandom& random) {
    const Vec3 out = random.direction();
    Path path{{(kRoughSphereM + half_height_m) * out, Quat::FromTwoVectors(Vec3::UnitY(), out)},
              out,
              random.within(0.004),
              random.within(0.002),
              random.within(0.15),
              random.within(0.1),
              0.002 * random.uniform()};
    path.a_m -= path.a_m.dot(out) * out;
    path.b_m -= 0.8 * path.b_m.dot(out) * out;
    return path;
}

struct Excursion {
    double gained_j = 0.0;  // by the hand: trapezoids of force and torque
    double jump_n = 0.0;    // largest change of (force, torque / g) beyond what the hand's motion explains
    double most_n = 0.0;
    bool closed = false;  // began and ended free, and was never released as too deep
};

Excursion run(const World& w, const SurfaceSettings& settings, const Path& path, double speed_m_s) {
    Hand hand(w, settings, path.at(0.0));
    const double g_m = kWorldPerModel * hand.model->contact().points().gyration_m();
    const auto moved = [&](const Pose& from, const Pose& to) {
        Vec6 way;
        way << to.p_m - from.p_m, g_m * rotation_vector_rad(to.q * from.q.conjugate());
        return way;
    };
    double most_m = 0.0;  // speed_m_s is the highest speed on the path
    for (int i = 0; i < 1000; ++i)
        most_m = std::max(most_m, moved(path.at(1e-3 * i), path.at(1e-3 * (i + 1))).norm());
    const int steps = static_cast<int>(1e3 * most_m / (kStepS * speed_m_s));
    const auto shown = [&] {
        Vec6 n;
        n << hand.felt.force_n, hand.felt.torque_n_m / g_m;
        return n;
    };
    Excursion e;
    Vec6 before = shown();
    e.closed = before.norm() == 0.0;
    for (int i = 1; i <= steps + 200; ++i) {
        const Vec6 way = moved(hand.place, path.at(std::min(static_cast<double>(i) / steps, 1.0)));
        (void)hand.step(path.at(std::min(static_cast<double>(i) / steps, 1.0)));
        const Vec6 now = shown();
        e.gained_j += 0.5 * (now + before).dot(way);
        e.jump_n = std::max(e.jump_n, (now - before).norm() - 2.5 * settings.stiffness_n_m * way.norm());
        e.most_n = std::max(e.most_n, now.norm());
        before = now;
    }
    e.closed = e.closed && before.norm() == 0.0 && hand.model->released() == 0;
    return e;
}

void expect_passive(const World& w, const char* name, double half_height_m, int paths) {
    for (const bool shading : {false, true}) {
        for (const double friction : {0.0, 0.2, 0.8}) {
            SeededRandom random(17);
            int closed = 0, pressed = 0;
            for (int k = 0; k < paths; ++k) {
                const Path path = random_path(half_height_m, random);
                const double speed_m_s = 0.02 * std::pow(25.0, random.uniform());
                SurfaceSettings settings = plain(friction);
                settings.shading = shading;
                const Excursion e = run(w, settings, path, speed_m_s);
                if (!e.closed) continue;
                ++closed;
                pressed += e.most_n > 0.05 ? 1 : 0;
                EXPECT_LT(e.gained_j, 1e-6)
                    << name << ", shading " << shading << ", friction " << friction << ", path " << k;
                EXPECT_LT(e.jump_n, 2.0 * SurfaceModel::kLagN + 1e-3) << name << ", path " << k;
            }
            EXPECT_GT(closed, 2 * paths / 3) << name;
            EXPECT_GT(pressed, paths / 2) << name;
        }
    }
}

TEST(ToolEnergy, a_closed_excursion_gains_nothing_at_any_speed) {
    expect_passive(*world(smooth_sphere(10), box_mesh({5e-5, 0.004, 5e-5}), {.points = 200}), "pin on facets",
                   0.004, 40);
    expect_passive(box_on_rough(), "box on rough", 0.005, 25);
    expect_passive(*world(rough_sphere(40), box_mesh({0.003, 0.008, 0.003}), {.points = 400}), "rod on rough",
                   0.008, 40);
}

}  // namespace
}  // namespace tact::force_tool_energy_test
