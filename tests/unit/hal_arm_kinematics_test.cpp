// Kinematics of the arms against geometry, finite differences, virtual work, and data of a real arm.
#include "hal/arm/arm_kinematics.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "tests/unit/hal_arm_samples.hpp"

namespace tact::hal_arm_kinematics_test {
namespace {

template <class Property>
void for_all(Property&& property) {
    EXPECT_TRUE(rc::check(property));
}

using sample::joints;

// A random configuration within the joint limits, elbow included.
Joint6 drawn_joints(const ArmParameters& p) {
    const auto unit = [] { return *rc::gen::inRange(0, 1'000'001) * 1e-6; };
    Joint6 q;
    for (Eigen::Index i = 0; i < 6; ++i) q[i] = p.low_rad[i] + unit() * (p.high_rad[i] - p.low_rad[i]);
    const double low = std::max(p.low_rad[2], q[1] + p.elbow_low_rad);
    const double high = std::min(p.high_rad[2], q[1] + p.elbow_high_rad);
    RC_PRE(low < high);
    q[2] = low + unit() * (high - low);
    return q;
}

Vec3 drawn_vector(double most) {
    const auto axis = [most] { return most * (*rc::gen::inRange(-1'000'000, 1'000'001) * 1e-6); };
    return {axis(), axis(), axis()};
}

class Arms : public testing::TestWithParam<const char*> {
protected:
    const ArmKinematics arm = sample::arm(GetParam());
    const ArmParameters& p = arm.parameters();
};
INSTANTIATE_TEST_SUITE_P(All, Arms,
                         testing::Values("omni", "desktop", "premium-1.0", "premium-1.5", "premium-1.5-6dof"),
                         [](const auto& tested) {
                             std::string name = tested.param;
                             for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                             return name;
                         });

TEST_P(Arms, in_the_reset_pose_the_tip_is_at_the_reference_of_the_origin) {
    EXPECT_LT((arm.tip_m(Joint6::Zero()) + p.origin_m).norm(), 1e-15);
    EXPECT_LT(arm.pose(Joint6::Zero()).q.angularDistance(Quat::Identity()), 1e-12);
}

TEST_P(Arms, joints_turn_according_to_their_signs) {
    const Vec3 rest = arm.tip_m(Joint6::Zero());
    EXPECT_LT((arm.tip_m(joints(0.1, 0, 0)) - rest).x(), -0.01);  // turret to the left
    EXPECT_GT((arm.tip_m(joints(0, 0.1, 0)) - rest).y(), 0.01);   // thigh up
    EXPECT_GT((arm.tip_m(joints(0, 0, 0.1)) - rest).z(), 0.01);   // shin up, towards the user
}

TEST_P(Arms, the_tip_is_the_sum_of_the_links) {
    for_all([&] {
        const Joint6 q = drawn_joints(p);
        const Quat turret(Eigen::AngleAxisd(-q[0], Vec3::UnitY()));
        const Quat thigh = turret * Quat(Eigen::AngleAxisd(-q[1], Vec3::UnitX()));
        const Quat shin = turret * Quat(Eigen::AngleAxisd(-q[2], Vec3::UnitX()));
        const Vec3 shoulder(0.0, p.shin_m, -p.thigh_m);
        const Vec3 tip = shoulder + thigh * Vec3(0, 0, p.thigh_m) + shin * Vec3(0, -p.shin_m, 0) - p.origin_m;
        RC_ASSERT((arm.tip_m(q) - tip).norm() < 1e-14);
    });
}

TEST_P(Arms, inverse_inverts_forward_over_the_whole_range_of_the_joints) {
    const auto holds = [&](const Joint6& q) {
        const Pose pose = arm.pose(q);
        Joint6 back;
        if (!arm.inverse(pose, back)) return false;
        const Pose again = arm.pose(back);
        const bool same_arm = (back - q).head<3>().norm() < 1e-7;
        return same_arm && (again.p_m - pose.p_m).norm() < 1e-9 && again.q.angularDistance(pose.q) < 1e-7;
    };
    for_all([&] { RC_ASSERT(holds(drawn_joints(p))); });
    constexpr int kSteps = 12;
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
            for (int k = 0; k <= kSteps; ++k) {
                const auto at = [](double low, double high, int step) {
                    return low + (high - low) * step / kSteps;
                };
                Joint6 q = Joint6::Zero();
                q[0] = at(p.low_rad[0], p.high_rad[0], i);
                q[1] = at(p.low_rad[1], p.high_rad[1], j);
                q[2] = q[1] + at(p.elbow_low_rad, p.elbow_high_rad, k);
                if (arm.configuration(q).reach_m < 1e-3)
                    continue;  // beyond the turret's axis the solution is the mirrored one
                ASSERT_TRUE(holds(q)) << q.transpose();
            }
        }
    }
}

TEST_P(Arms, every_reachable_position_of_the_workspace_is_found_within_a_nanometre) {
    int reached = 0, all = 0;
    for (double x = -1.0; x <= 1.0; x += 0.1) {
        for (double y = -1.0; y <= 1.0; y += 0.1) {
            for (double z = -1.0; z <= 1.0; z += 0.1) {
                const Pose want{p.workspace_half_m.cwiseProduct(Vec3(x, y, z)), Quat::Identity()};
                Joint6 q;
                ++all;
                if (!arm.inverse(want, q)) continue;
                ++reached;
                ASSERT_LT((arm.tip_m(q) - want.p_m).norm(), 1e-9);
            }
        }
    }
    // The manufacturers' boxes lie completely within reach; the Desktop of this test has made-up dimensions.
    if (std::string(GetParam()) != "desktop") {
        EXPECT_EQ(reached, all);
    }
}

TEST_P(Arms, the_inverse_agrees_with_the_published_one) {
    for_all([&] {
        const Joint6 q = drawn_joints(p);
        RC_PRE(arm.configuration(q).reach_m > 0.01);
        const double l1 = p.thigh_m, l2 = p.shin_m;
        const Vec3 tip = arm.tip_m(q) + p.origin_m + Vec3(0.0, -l2, l1);
        const Vec3 their(tip.z(), -tip.x(), tip.y());  // x forward, y left, z up
        const double h = their.norm();
        const double q1 = std::atan2(their.y(), their.x());
        const double q2 = std::acos((l1 * l1 + h * h - l2 * l2) / (2 * l1 * h)) +
                          std::atan2(their.z(), std::hypot(their.x(), their.y()));
        const double q3 = q2 - M_PI / 2 + std::acos((l1 * l1 + l2 * l2 - h * h) / (2 * l1 * l2));
        RC_ASSERT(std::abs(q1 - q[0]) + std::abs(q2 - q[1]) + std::abs(q3 - q[2]) < 1e-7);
    });
}

TEST_P(Arms, the_jacobian_is_the_derivative_of_the_pose) {
    constexpr double kStep = 1e-5;
    for_all([&] {
        const Joint6 q = drawn_joints(p);
        const Jacobian6 j = arm.jacobian6(q);
        RC_ASSERT((j.topLeftCorner<3, 3>() - arm.jacobian(q)).norm() < 1e-15);
        for (Eigen::Index i = 0; i < 6; ++i) {
            Joint6 up = q, down = q;
            up[i] += kStep;
            down[i] -= kStep;
            const Pose a = arm.pose(up), b = arm.pose(down);
            const Vec3 linear = (a.p_m - b.p_m) / (2 * kStep);
            const Vec3 angular = rotation_vector_rad(a.q * b.q.conjugate()) / (2 * kStep);
            RC_ASSERT((linear - j.block<3, 1>(0, i)).norm() < 1e-9);
            RC_ASSERT((angular - j.block<3, 1>(3, i)).norm() < 1e-9);
        }
        const double det = p.thigh_m * p.shin_m * arm.configuration(q).reach_m * std::cos(q[2] - q[1]);
        RC_ASSERT(std::abs(std::abs(arm.jacobian(q).determinant()) - std::abs(det)) < 1e-15);
    });
}

TEST_P(Arms, joint_torques_do_the_work_of_the_wrench_at_the_tip) {
    for_all([&] {
        const Joint6 q = drawn_joints(p);
        Joint6 rad_s;
        rad_s << drawn_vector(3.0), drawn_vector(3.0);
        Wrench w{drawn_vector(8.0), drawn_vector(0.5)};
        if (p.wrist != Wrist::driven) w.torque_n_m.setZero();
        const Twist v = arm.twist(q, rad_s);
        const double tip_w = w.force_n.dot(v.linear_m_s) + w.torque_n_m.dot(v.angular_rad_s);
        RC_ASSERT(std::abs(arm.torque_n_m(q, w).dot(rad_s) - tip_w) < 1e-12);
    });
}

TEST_P(Arms, torques_are_bounded_by_the_lever_in_every_configuration) {
    const double l1 = p.thigh_m, l2 = p.shin_m;
    const auto bounded = [&](const Joint6& q, const Wrench& w) {
        const Joint6 tau = arm.torque_n_m(q, w);
        const double f = w.force_n.norm(), t = p.wrist == Wrist::driven ? w.torque_n_m.norm() : 0.0;
        const double slack = 1e-12;
        return std::abs(tau[0]) <= std::abs(arm.configuration(q).reach_m) * f + t + slack &&
               std::abs(tau[1]) <= l1 * f + slack && std::abs(tau[2]) <= l2 * f + t + slack &&
               tau.tail<3>().cwiseAbs().maxCoeff() <= t + slack;
    };
    for_all([&] {
        const Wrench w{drawn_vector(8.0), drawn_vector(0.5)};
        Joint6 any;
        any << drawn_vector(4.0), drawn_vector(4.0);
        RC_ASSERT(bounded(any, w));
        for (const double d : {M_PI / 2, -M_PI / 2}) {  // stretched, folded
            any[2] = any[1] + d;
            RC_ASSERT(bounded(any, w));
        }
        any[4] = M_PI / 2;  // yaw and roll in one axis
        RC_ASSERT(bounded(any, w));
        any.head<3>() << 0.3, std::acos(-std::min(1.0, l2 / l1) * std::sin(0.2)), 0.2;  // above the turret
        RC_ASSERT(std::abs(arm.configuration(any).reach_m) < 1e-12 || l2 > l1);
        RC_ASSERT(bounded(any, w));
    });
}

TEST_P(Arms, at_a_singular_configuration_only_the_immobile_direction_is_lost) {
    const Joint6 stretched = joints(0.4, 0.3, 0.3 + M_PI / 2);
    EXPECT_NEAR(arm.configuration(stretched).elbow_cos, 0.0, 1e-12);
    EXPECT_TRUE(arm.configuration(stretched).near_singular);
    const Vec3 shoulder = Vec3(0.0, p.shin_m, -p.thigh_m) - p.origin_m;
    const Vec3 along = (arm.tip_m(stretched) - shoulder).normalized();
    EXPECT_LT(arm.torque_n_m(stretched, {5.0 * along, Vec3::Zero()}).norm(), 1e-12);
    const Vec3 across = along.cross(Vec3::UnitY()).normalized();
    EXPECT_GT(arm.torque_n_m(stretched, {5.0 * across, Vec3::Zero()}).norm(), 0.1);
    EXPECT_FALSE(arm.configuration(joints(0.0, 0.5, 0.5)).near_singular);
}

TEST_P(Arms, an_unreachable_position_is_reported_with_the_nearest_reachable_one) {
    const Vec3 shoulder = Vec3(0.0, p.shin_m, -p.thigh_m) - p.origin_m;
    const Vec3 way = Vec3(0.1, -0.2, 1.0).normalized();
    Joint6 q;
    EXPECT_FALSE(arm.inverse({shoulder + 2.0 * (p.thigh_m + p.shin_m) * way, Quat::Identity()}, q));
    EXPECT_LT((arm.tip_m(q) - shoulder - (p.thigh_m + p.shin_m) * way).norm(), 1e-9);
    Pose wild;
    wild.p_m.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(arm.inverse(wild, q));
}

TEST_P(Arms, the_distance_to_the_joint_limits_is_reported) {
    Joint6 q = 0.5 * (p.low_rad + p.high_rad);
    q[2] = q[1] + 0.5 * (p.elbow_low_rad + p.elbow_high_rad);
    q[0] = p.high_rad[0] - 0.01;
    EXPECT_NEAR(arm.configuration(q).to_limit_rad, 0.01, 1e-12);
    q[0] = p.high_rad[0] + 0.02;
    EXPECT_NEAR(arm.configuration(q).to_limit_rad, -0.02, 1e-12);
    q[0] = 0.0;
    q[2] = q[1] + p.elbow_high_rad + 0.03;
    EXPECT_LE(arm.configuration(q).to_limit_rad, -0.03 + 1e-12);
}

TEST_P(Arms, counts_and_angles_convert_within_half_a_step) {
    const Counts6 zero{1000, -70000, 2'000'000'000, 5, 6, 7};
    for_all([&] {
        const Joint6 q = drawn_joints(p);
        const Counts6 counts = arm.counts(q, zero);
        const Joint6 seen = arm.angles_rad(counts, zero);
        for (Eigen::Index i = 0; i < 6; ++i) {
            if (p.rad_per_count[i] == 0.0) continue;
            RC_ASSERT(std::abs(seen[i] - q[i]) <= 0.5001 * std::abs(p.rad_per_count[i]));
        }
    });
    EXPECT_LT((arm.angles_rad(zero, zero) - p.calibration_rad).norm(), 1e-15);
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    const Counts6 far{kMost, kMost, kMost, kMost, kMost, kMost};
    EXPECT_TRUE(arm.angles_rad(far, {-kMost, -kMost, -kMost, -kMost, -kMost, -kMost}).allFinite());
}

TEST_P(Arms, gravity_torque_is_the_gradient_of_the_potential_energy) {
    ArmParameterSet f = sample::complete_parameters(GetParam());
    f.gravity_mn_m = {Figure{-16.0, FigureSource::configured}, Figure{-74.0, FigureSource::configured}};
    f.tip_mass_g = {90.0, FigureSource::configured};
    const ArmKinematics heavy(arm_parameters(f));
    const auto energy_j = [&](const Joint6& q) {
        return -0.016 * std::sin(q[1]) + 0.074 * std::cos(q[2]) + 0.090 * 9.80665 * heavy.tip_m(q).y();
    };
    for_all([&] {
        const Joint6 q = drawn_joints(p), tau = heavy.gravity_n_m(q);
        for (Eigen::Index i = 0; i < 6; ++i) {
            Joint6 up = q, down = q;
            up[i] += 1e-5;
            down[i] -= 1e-5;
            RC_ASSERT(std::abs((energy_j(up) - energy_j(down)) / 2e-5 - tau[i]) < 1e-9);
        }
    });
}

TEST(Omni, agrees_with_a_real_one_in_its_inkwell) {
    // Joint and gimbal angles and the transform by columns, as the manufacturer's software reported them.
    const ArmKinematics arm = sample::arm("omni");
    const Joint6 q = joints(0.0, 0.26889, -0.370813, 0.000108409, 0.797273, -1.94046);
    Eigen::Matrix3d reported;
    reported.col(0) << -0.361371, 0.848922, -0.385672;
    reported.col(1) << -0.932422, -0.328976, 0.149546;
    reported.col(2) << 7.57409e-05, 0.413651, 0.910436;
    const Pose pose = arm.pose(q);
    EXPECT_LT((pose.p_m - Vec3(0.0, -0.0655107, -0.0881142)).norm(), 1e-5);
    EXPECT_LT((pose.q.toRotationMatrix() - reported).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_GT(arm.configuration(q).to_limit_rad, 0.0);
    Joint6 back;
    ASSERT_TRUE(arm.inverse(pose, back));
    EXPECT_LT((back - q).norm(), 1e-9);
}

// The manufacturers specify a resolution of 0.055 mm and 0.03 mm at the tip; it applies to the reset pose.
TEST(Encoders, one_step_moves_the_tip_by_the_specified_resolution) {
    const auto step_mm = [](const char* model) {
        const ArmKinematics arm = sample::arm(model);
        double most = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            Counts6 one{};
            one[i] = 1;
            Joint6 q = arm.angles_rad(one, {}) - arm.angles_rad({}, {});
            most = std::max(most, (arm.tip_m(q) - arm.tip_m(Joint6::Zero())).norm());
        }
        EXPECT_NEAR(arm.position_step_m(Joint6::Zero()), most, 1e-8);
        return 1e3 * most;
    };
    EXPECT_NEAR(step_mm("omni"), 0.055, 0.001);
    EXPECT_NEAR(step_mm("premium-1.5"), 0.03, 0.0015);
    const ArmKinematics six = sample::arm("premium-1.5-6dof");
    EXPECT_NEAR(six.turn_step_rad(Joint6::Zero()) * 180.0 / M_PI, 0.0080, 1e-6);
}

TEST(Weight, of_a_premium_15_follows_from_the_published_masses) {
    const double g = 9.81, l1 = 0.215, l2 = 0.170, l3 = 0.0325, l5 = -0.0368, l6 = 0.0527;
    const double a = 0.0202, c = 0.0249, be = 0.2359, df = 0.1906;
    const Joint6 tau = sample::arm("premium-1.5").gravity_n_m(joints(0.0, 0.0, M_PI / 2));
    EXPECT_NEAR(tau[1], 0.5 * g * (l1 * (2 * a + c) + 2 * l5 * be), 5e-4);
    EXPECT_NEAR(tau[2], 0.5 * g * (l2 * a + 2 * l3 * c - 2 * l6 * df), 5e-4);
}

TEST(Gimbal, a_pitch_beyond_90_degrees_gives_the_same_pose) {
    const ArmKinematics arm = sample::arm("premium-1.5-6dof");
    const Joint6 q = joints(0.1, 0.2, 0.3, 0.4, 2.0, -0.5);
    Joint6 back;
    ASSERT_TRUE(arm.inverse(arm.pose(q), back));
    // 2 rad and its equivalent below 90 degrees are both within the limits: either gives the same pose.
    EXPECT_LT(arm.pose(back).q.angularDistance(arm.pose(q).q), 1e-9);
    const Joint6 locked = joints(0.1, 0.2, 0.3, 0.4, M_PI / 2, -0.5);
    ASSERT_TRUE(arm.inverse(arm.pose(locked), back));
    EXPECT_LT(arm.pose(back).q.angularDistance(arm.pose(locked).q), 1e-7);
}

TEST(Gimbal, a_torque_at_the_stylus_loads_turret_and_shin_too) {
    const ArmKinematics arm = sample::arm("premium-1.5-6dof");
    const Joint6 up = arm.torque_n_m(Joint6::Zero(), {Vec3::Zero(), Vec3(0.0, 0.1, 0.0)});
    EXPECT_NEAR(up[0], -0.1, 1e-15);
    EXPECT_NEAR(up[3], 0.1, 1e-15);
    const Joint6 right = arm.torque_n_m(Joint6::Zero(), {Vec3::Zero(), Vec3(0.1, 0.0, 0.0)});
    EXPECT_NEAR(right[1], 0.0, 1e-15);
    EXPECT_NEAR(right[2], -0.1, 1e-15);
    EXPECT_NEAR(right[4], -0.1, 1e-15);
}

TEST(Gimbal, without_motors_there_is_no_torque) {
    const ArmKinematics arm = sample::arm("omni");
    EXPECT_EQ(arm.torque_n_m(joints(0.1, 0.2, 0.3), {Vec3::Zero(), Vec3(0.1, 0.2, 0.3)}), Joint6::Zero());
}

}  // namespace
}  // namespace tact::hal_arm_kinematics_test
