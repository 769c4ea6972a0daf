// The Falcon's legs: forward and inverse kinematics, Jacobian and motor torques against finite differences and virtual
// work, and invalid configurations.
#include "hal/falcon/kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tact::falcon::hal_falcon_kinematics_test {
namespace {

class FalconKinematics : public testing::Test {
protected:
    static constexpr double kHalf = kWorkspaceHalfM;

    template <class Do>
    void everywhere(int n, Do look) const {
        for (int x = -n; x <= n; ++x)
            for (int y = -n; y <= n; ++y)
                for (int z = -n; z <= n; ++z) look(Vec3(Vec3(x, y, z) * (kHalf / n)));
    }
    [[nodiscard]] Vec3 angles(const Vec3& grip_m) const {
        Vec3 rad;
        EXPECT_TRUE(k_.inverse(grip_m, rad)) << grip_m.transpose();
        return rad;
    }
    const Kinematics k_;
};

// A leg built in its own plane: thigh, short links and shin in series, as in the drawings.
TEST_F(FalconKinematics, a_leg_is_the_chain_of_its_parts) {
    const Geometry g;
    everywhere(3, [&](const Vec3& p) {
        const Vec3 t = angles(p);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 radial(std::cos(g.leg_rad[i]), std::sin(g.leg_rad[i]), 0.0);
            const Vec3 across(-radial.y(), radial.x(), 0.0), out(0.0, 0.0, 1.0);
            const double a = t[static_cast<Eigen::Index>(i)];
            const Vec3 hip = radial * g.base_m + across * g.base_across_m;
            const Vec3 knee = hip + g.thigh_m * (radial * std::cos(a) + out * std::sin(a));
            const Vec3 end = p + out * g.middle_z_m + radial * g.grip_m + across * g.grip_across_m;
            // The short links point along the projection of the shin onto the leg's plane.
            const Vec3 way = end - knee;
            const Vec3 shadow = (way - across * way.dot(across)).normalized();
            EXPECT_NEAR((way - shadow * g.ends_m).norm(), g.shin_m, 1e-12) << i << ": " << p.transpose();
        }
    });
}

TEST_F(FalconKinematics, forward_inverts_inverse_from_anywhere_in_the_workspace) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> in(-kHalf, kHalf);
    double worst = 0.0;
    everywhere(6, [&](const Vec3& p) {
        const Vec3 t = angles(p);
        for (const Vec3& near : {Vec3(Vec3::Zero()), Vec3(in(random), in(random), in(random)), p}) {
            Vec3 back = Vec3::Constant(1.0);
            ASSERT_TRUE(k_.forward(t, near, back)) << p.transpose() << " from " << near.transpose();
            worst = std::max(worst, (back - p).norm());
        }
    });
    EXPECT_LT(worst, 1e-9);
}

TEST_F(FalconKinematics, the_jacobian_matches_finite_differences) {
    constexpr double kStep = 1e-6;
    everywhere(3, [&](const Vec3& p) {
        const ArmConfiguration here = k_.configuration(p);
        ASSERT_TRUE(here.good) << p.transpose();
        for (Eigen::Index i = 0; i < 3; ++i) {
            Vec3 up, down;
            ASSERT_TRUE(k_.forward(here.leg_rad + kStep * Vec3::Unit(i), p, up));
            ASSERT_TRUE(k_.forward(here.leg_rad - kStep * Vec3::Unit(i), p, down));
            const Vec3 rate = (up - down) / (2.0 * kStep);
            EXPECT_LT((rate - here.jacobian.col(i)).norm(), 1e-6 * (1.0 + rate.norm())) << p.transpose();
        }
    });
}

// Motor torques and the force at the grip do the same work for any small displacement.
TEST_F(FalconKinematics, the_motors_do_the_work_of_the_force) {
    const Geometry g;
    const Vec3 force(0.8, -1.1, 0.6);
    everywhere(3, [&](const Vec3& p) {
        const ArmConfiguration here = k_.configuration(p);
        const Drive d = k_.drive(here, force);
        ASSERT_TRUE(d.valid);
        EXPECT_EQ(d.share, 1.0);
        for (const Vec3& way : {Vec3(1e-6, 0.0, 0.0), Vec3(0.0, 1e-6, 0.0), Vec3(0.0, 0.0, 1e-6)}) {
            const Vec3 turned = angles(p + way) - angles(p - way);
            double work = 0.0;  // motor torque counts against the encoders
            for (std::size_t i = 0; i < 3; ++i)
                work -= d.torque[i] * g.motor_n_m_per_step * g.gear * turned[static_cast<Eigen::Index>(i)];
            // Rounding changes each motor by at most half a step.
            const double rounding = 0.5 * g.motor_n_m_per_step * g.gear * turned.cwiseAbs().sum();
            EXPECT_NEAR(work, 2.0 * force.dot(way), rounding + 1e-12) << p.transpose();
        }
        EXPECT_LT((k_.force_n(here, d.torque) - force).norm(), 0.02) << p.transpose();
    });
}

TEST_F(FalconKinematics, a_force_towards_the_user_turns_all_thighs_equally_outwards) {
    const ArmConfiguration here = k_.configuration(Vec3::Zero());
    const Drive d = k_.drive(here, Vec3(0.0, 0.0, 1.0));
    EXPECT_EQ(d.torque[0], d.torque[1]);
    EXPECT_EQ(d.torque[1], d.torque[2]);
    EXPECT_LT(d.torque[0], 0);
    Vec3 farther;
    ASSERT_TRUE(k_.forward(here.leg_rad + Vec3::Constant(0.01), Vec3::Zero(), farther));
    EXPECT_GT(farther.z(), 0.0);
    EXPECT_NEAR(farther.head<2>().norm(), 0.0, 1e-12);
}

TEST_F(FalconKinematics, a_force_beyond_the_limit_is_reduced_and_keeps_its_direction) {
    everywhere(2, [&](const Vec3& p) {
        const ArmConfiguration here = k_.configuration(p);
        for (const Vec3& f : {Vec3(100.0, -30.0, 20.0), Vec3(0.0, 8.0, 0.0), Vec3(-6.0, 0.0, 6.0)}) {
            const Drive d = k_.drive(here, f);
            ASSERT_TRUE(d.valid);
            for (const std::int16_t t : d.torque) EXPECT_LE(std::abs(int{t}), int{kTorqueMax});
            const Vec3 shown = k_.force_n(here, d.torque);
            EXPECT_LT(shown.norm(), kForceMaxN + 0.02);
            EXPECT_LT((shown - d.share * f).norm(), 0.02) << p.transpose();
        }
    });
}

TEST_F(FalconKinematics, one_count_moves_the_grip_by_the_reported_resolution) {
    const double step = k_.position_step_m();
    EXPECT_GT(step, 30e-6);
    EXPECT_LT(step, 63e-6);  // the manufacturer's 400 dpi
    const Counts3 middle = k_.counts(angles(Vec3::Zero()));
    Vec3 here;
    ASSERT_TRUE(k_.forward(k_.angles_rad(middle), Vec3::Zero(), here));
    for (std::size_t i = 0; i < 3; ++i) {
        Counts3 next = middle;
        ++next[i];
        Vec3 there;
        ASSERT_TRUE(k_.forward(k_.angles_rad(next), here, there));
        EXPECT_NEAR((there - here).norm(), step, 0.02 * step);
    }
    // Counts of a position lead back to it within half a step of each leg.
    everywhere(4, [&](const Vec3& p) {
        Vec3 back;
        ASSERT_TRUE(k_.forward(k_.angles_rad(k_.counts(angles(p))), p, back));
        const ArmConfiguration q = k_.configuration(p);
        const double most = 0.5 * k_.rad_per_count() * q.jacobian.colwise().norm().sum();
        EXPECT_LT((back - p).norm(), 1.01 * most) << p.transpose();
    });
}

TEST_F(FalconKinematics, an_invalid_configuration_is_refused_and_gives_no_force) {
    Vec3 kept(1.0, 2.0, 3.0);
    EXPECT_FALSE(k_.inverse(Vec3(0.3, 0.0, 0.0), kept));
    EXPECT_FALSE(k_.inverse(Vec3(0.0, 0.0, 0.2), kept));
    // One thigh in, two out by more than the shins can reach.
    EXPECT_FALSE(k_.forward(k_.angles_rad({-2600, 2600, 2600}), Vec3::Zero(), kept));
    const double nan = std::nan("");
    EXPECT_FALSE(k_.forward(Vec3(nan, 0.0, 0.0), Vec3::Zero(), kept));
    EXPECT_FALSE(k_.forward(Vec3::Zero(), Vec3(0.0, nan, 0.0), kept));
    EXPECT_EQ(kept, Vec3(1.0, 2.0, 3.0));
    EXPECT_FALSE(k_.configuration(Vec3(0.3, 0.0, 0.0)).good);
    EXPECT_FALSE(k_.configuration(Vec3(nan, 0.0, 0.0)).good);
    EXPECT_FALSE(k_.drive(k_.configuration(Vec3::Zero()), Vec3(nan, 0.0, 0.0)).valid);
    EXPECT_FALSE(k_.drive(k_.configuration(Vec3(0.3, 0.0, 0.0)), Vec3(1.0, 0.0, 0.0)).valid);
}

// The axis towards the user has both singularities: the grip folds outwards far out, the shins are stretched far in.
TEST_F(FalconKinematics, near_a_singularity_the_configuration_is_flagged_before_numbers_degrade) {
    bool was_good = false, turned_bad_near = false, turned_bad_far = false;
    for (double z = -0.07; z < 0.08; z += 1e-4) {
        const ArmConfiguration q = k_.configuration(Vec3(0.0, 0.0, z));
        turned_bad_near = turned_bad_near || (z < 0.0 && !q.good);
        turned_bad_far = turned_bad_far || (z > 0.0 && was_good && !q.good);
        was_good = q.good;
        EXPECT_TRUE(q.jacobian.allFinite());
        if (!q.good) continue;
        EXPECT_GE(q.spread, ArmConfiguration::kPoorest);
        EXPECT_GE(q.leverage, ArmConfiguration::kPoorest);
        EXPECT_LT(q.jacobian.cwiseAbs().maxCoeff(), 1.0);
    }
    EXPECT_TRUE(turned_bad_near && turned_bad_far);
    everywhere(5, [&](const Vec3& p) { EXPECT_TRUE(k_.configuration(p).good) << p.transpose(); });
}

TEST_F(FalconKinematics, any_counts_give_a_reachable_position_or_none) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> any(-32768, 32767);
    for (int i = 0; i < 20000; ++i) {
        Counts3 c;
        const int span = i % 2 == 0 ? 1 : 12;  // half of them near the range of a Falcon
        for (std::int16_t& n : c) n = static_cast<std::int16_t>(any(random) / span);
        Vec3 p = Vec3::Constant(9.0);
        if (!k_.forward(k_.angles_rad(c), Vec3::Zero(), p)) continue;
        EXPECT_LE(p.norm(), kReachM);
        Vec3 again;
        ASSERT_TRUE(k_.inverse(p, again));
        EXPECT_EQ(k_.counts(again), c);
    }
}

}  // namespace
}  // namespace tact::falcon::hal_falcon_kinematics_test
