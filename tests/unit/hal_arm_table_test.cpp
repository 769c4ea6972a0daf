// The table of arms: complete entries, clear errors for missing ones, and documentation that matches.
#include "hal/arm/arm_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "ipc/base/error.hpp"
#include "tests/support/says.hpp"
#include "tests/unit/hal_arm_samples.hpp"

namespace tact::hal_arm_table_test {
namespace {

std::string error_of(const ArmParameterSet& f) {
    try {
        static_cast<void>(arm_parameters(f));
    } catch (const StartupError& e) {
        return e.what();
    }
    return {};
}

TEST(ArmTable, a_premium_15_needs_no_configuration) {
    const ArmParameters p = arm_parameters(arm_parameter_set("premium-1.5"));
    EXPECT_DOUBLE_EQ(p.thigh_m, 0.20955);
    EXPECT_DOUBLE_EQ(p.joint_n_m_per_a[0], 0.0234 * 13.3);
    EXPECT_TRUE(p.heat_known);
    EXPECT_NEAR(continuous_current_a(p.heat), p.current_a_continuous[0], 0.01);
    EXPECT_DOUBLE_EQ(p.stiffness_n_m_max, 3500.0);
    EXPECT_EQ(p.rad_per_count[4], 0.0);
}

TEST(ArmTable, unknown_parameters_are_requested_by_their_keys) {
    EXPECT_TRUE(
        says(error_of(arm_parameter_set("desktop")),
             {"desktop", "thigh_mm", "counts_per_turn", "drive_ratio", "current_a_max", "fix:", "[arm]"}));
    const std::string omni = error_of(arm_parameter_set("omni"));
    EXPECT_TRUE(says(omni, {"omni", "counts_per_turn", "torque_constant_mn_m_a"})) << omni;
    EXPECT_EQ(omni.find("thigh_mm"), std::string::npos);
    EXPECT_TRUE(says(error_of(arm_parameter_set("premium-1.0")), {"counts_per_turn", "drive_ratio"}));
    EXPECT_TRUE(
        says(error_of(arm_parameter_set("premium-1.5-6dof")), {"torque_constant_mn_m_a", "current_a_max"}));
    for (const std::string& model : arm_models()) {
        EXPECT_EQ(error_of(sample::complete_parameters(model)), "") << model;
        EXPECT_EQ(arm_parameter_set(model).model, model);
    }
}

TEST(ArmTable, an_unknown_arm_is_refused_with_the_known_ones) {
    try {
        static_cast<void>(arm_parameter_set("delta"));
        FAIL();
    } catch (const StartupError& e) {
        EXPECT_TRUE(says(e.what(), {"delta", "omni", "premium-1.5-6dof", "fix:"}));
    }
}

TEST(ArmTable, contradictory_parameters_are_refused) {
    const auto with = [](auto&& change) {
        ArmParameterSet f = arm_parameter_set("premium-1.5");
        change(f);
        return error_of(f);
    };
    EXPECT_TRUE(says(with([](ArmParameterSet& f) { f.counts_per_turn[1].value = 0.0; }),
                     {"encoder step", "joint 1"}));
    EXPECT_TRUE(says(with([](ArmParameterSet& f) { f.counts_per_turn[1].value = 2.0; }), {"encoder step"}));
    EXPECT_TRUE(says(with([](ArmParameterSet& f) { f.low_deg[0].value = 80.0; }), {"low_deg", "joint 0"}));
    EXPECT_TRUE(says(with([](ArmParameterSet& f) { f.current_a_continuous[2].value = 9.0; }),
                     {"current_a_continuous"}));
    EXPECT_TRUE(
        says(with([](ArmParameterSet& f) { f.force_n_continuous.value = 9.0; }), {"force_n_continuous"}));
    EXPECT_TRUE(
        says(with([](ArmParameterSet& f) { f.torque_constant_mn_m_a[0].value = 0.0; }), {"torque_constant"}));
    EXPECT_TRUE(says(with([](ArmParameterSet& f) { f.elbow_deg[0].value = 75.0; }), {"elbow_deg"}));
}

TEST(ArmTable, every_parameter_lies_in_the_range_of_its_key) {
    for (const std::string& model : arm_models()) {
        ArmParameterSet f = arm_parameter_set(model);
        for (const ArmKey& key : arm_keys(f)) {
            EXPECT_LT(key.low, key.high);
            for (const Figure& figure : key.metrics) {
                if (!figure.known()) continue;
                EXPECT_GE(figure.value, key.low) << model << " " << key.name;
                EXPECT_LE(figure.value, key.high) << model << " " << key.name;
            }
        }
    }
}

TEST(ArmTable, the_calibration_pose_lies_within_the_joint_limits) {
    for (const std::string& model : arm_models()) {
        const ArmKinematics arm = sample::arm(model);
        EXPECT_GE(arm.configuration(arm.parameters().calibration_rad).to_limit_rad, 0.0) << model;
    }
}

TEST(ArmTable, the_readme_has_a_row_for_every_key_and_every_model) {
    std::ifstream in("hal/arm/README.md");
    ASSERT_TRUE(in);
    std::stringstream text;
    text << in.rdbuf();
    ArmParameterSet f;
    for (const ArmKey& key : arm_keys(f)) {
        EXPECT_NE(text.str().find("| `" + std::string(key.name) + "`"), std::string::npos) << key.name;
    }
    for (const std::string& model : arm_models()) {
        EXPECT_NE(text.str().find(model), std::string::npos) << model;
    }
}

}  // namespace
}  // namespace tact::hal_arm_table_test
