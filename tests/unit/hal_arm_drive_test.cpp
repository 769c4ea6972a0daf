// Motor currents: limits keep the direction, gravity compensation has priority, invalid input gives zero.
#include "hal/arm/arm_drive.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

#include "tests/unit/hal_arm_samples.hpp"

namespace tact::hal_arm_drive_test {
namespace {

template <class Property>
void for_all(Property&& property) {
    EXPECT_TRUE(rc::check(property));
}

using sample::joints;

double drawn(double most) { return most * (*rc::gen::inRange(-1'000'000, 1'000'001) * 1e-6); }
Vec3 drawn_vector(double most) { return {drawn(most), drawn(most), drawn(most)}; }
Joint6 configuration() {
    return joints(drawn(0.7), 0.5 + drawn(0.5), 0.4 + drawn(0.4), drawn(1), drawn(1), drawn(1));
}

Joint6 torque_of(const ArmKinematics& arm, const Joint6& current_a) {
    return current_a.cwiseProduct(arm.parameters().joint_n_m_per_a);
}

class Drives : public testing::TestWithParam<const char*> {
protected:
    const ArmKinematics arm = sample::arm(GetParam());
    const ArmParameters& p = arm.parameters();
};
INSTANTIATE_TEST_SUITE_P(All, Drives, testing::Values("omni", "premium-1.5", "premium-1.5-6dof"),
                         [](const auto& tested) {
                             std::string name = tested.param;
                             for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                             return name;
                         });

TEST_P(Drives, within_the_limits_the_motors_give_exactly_the_requested_wrench) {
    for_all([&] {
        const Joint6 q = configuration();
        const Wrench w{drawn_vector(0.3), drawn_vector(0.01)};
        const DriveCurrents d = drive_currents(arm, q, w, Joint6::Zero(), p.current_a_max);
        RC_ASSERT(d.valid);
        RC_ASSERT(d.share == 1.0);
        RC_ASSERT((torque_of(arm, d.current_a) - arm.torque_n_m(q, w)).norm() < 1e-12);
    });
}

TEST_P(Drives, no_motor_exceeds_its_limit_and_the_wrench_keeps_its_direction) {
    for_all([&] {
        const Joint6 q = configuration();
        const Wrench w{drawn_vector(60.0), drawn_vector(2.0)};
        const Joint6 hold = arm.gravity_n_m(q);
        Joint6 limit = p.current_a_max;
        for (Eigen::Index i = 0; i < 6; ++i) limit[i] *= std::abs(drawn(1.2));
        const DriveCurrents d = drive_currents(arm, q, w, hold, limit);
        RC_ASSERT(d.valid);
        for (Eigen::Index i = 0; i < 6; ++i) {
            RC_ASSERT(std::abs(d.current_a[i]) <= std::min(limit[i], p.current_a_max[i]));
        }
        RC_ASSERT(d.share >= 0.0 && d.share <= 1.0);
        RC_ASSERT(d.share * w.force_n.norm() <= p.force_n_max * (1 + 1e-12));
        if (d.share == 0.0) return;  // not even gravity compensation
        const Joint6 shown = torque_of(arm, d.current_a) - hold;
        RC_ASSERT((shown - d.share * arm.torque_n_m(q, w)).norm() < 1e-9);
    });
}

TEST_P(Drives, a_wrench_just_beyond_a_limit_is_barely_reduced) {
    const Joint6 q = joints(0.1, 0.4, 0.3);
    const Joint6 ones = Joint6::Constant(1.0);
    const Wrench w{Vec3(0.0, 1.0, 0.5), Vec3::Zero()};
    const Joint6 needed = drive_currents(arm, q, w, Joint6::Zero(), 1e3 * ones).current_a.cwiseAbs();
    const DriveCurrents d = drive_currents(arm, q, w, Joint6::Zero(), 0.999 * needed);
    EXPECT_NEAR(d.share, 0.999, 1e-9);
}

TEST_P(Drives, non_finite_input_gives_zero_current) {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    const Wrench w{Vec3(1, 1, 1), Vec3::Zero()};
    const Joint6 zero = Joint6::Zero(), bad = Joint6::Constant(nan);
    for (const DriveCurrents& d :
         {drive_currents(arm, bad, w, zero, p.current_a_max),
          drive_currents(arm, zero, {Vec3(nan, 0, 0), Vec3::Zero()}, zero, p.current_a_max),
          drive_currents(arm, zero, {Vec3::Zero(), Vec3(0, inf, 0)}, zero, p.current_a_max),
          drive_currents(arm, zero, w, bad, p.current_a_max), drive_currents(arm, zero, w, zero, bad)}) {
        EXPECT_FALSE(d.valid);
        EXPECT_EQ(d.current_a, zero);
    }
    const DriveCurrents huge =
        drive_currents(arm, zero, {Vec3::Constant(1e300), Vec3::Zero()}, zero, p.current_a_max);
    EXPECT_TRUE(huge.valid && huge.current_a.allFinite());
    EXPECT_EQ(drive_currents(arm, zero, w, zero, Joint6::Constant(-1.0)).current_a, zero);
}

TEST_P(Drives, at_a_singular_configuration_currents_stay_within_their_limits) {
    for_all([&] {
        Joint6 q = configuration();
        q[2] = q[1] + M_PI / 2;
        q[4] = M_PI / 2;
        const DriveCurrents d =
            drive_currents(arm, q, {drawn_vector(20.0), drawn_vector(1.0)}, Joint6::Zero(), p.current_a_max);
        RC_ASSERT(d.valid && d.current_a.allFinite());
        RC_ASSERT(((p.current_a_max - d.current_a.cwiseAbs()).array() >= 0.0).all());
    });
}

// Forces that follow from the table's motors and levers, against the manufacturer's 8.5 N peak and 1.4 N continuous.
TEST(Premium, its_motors_give_the_specified_forces) {
    const ArmKinematics arm = sample::arm("premium-1.5");
    const ArmParameters& p = arm.parameters();
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
        const Joint6 q = Joint6::Zero();
        const auto most_n = [&](const Joint6& limit_a) {
            return 100.0 * drive_currents(arm, q, {100.0 * way, Vec3::Zero()}, Joint6::Zero(), limit_a).share;
        };
        EXPECT_GT(most_n(p.current_a_max), 6.5);
        EXPECT_LE(most_n(p.current_a_max), 8.5 + 1e-9);
        EXPECT_GT(most_n(p.current_a_continuous), 1.4);
        EXPECT_LT(most_n(p.current_a_continuous), 2.0);
    }
}

}  // namespace
}  // namespace tact::hal_arm_drive_test
