// Section [arm] of the configuration: parameters reach the device's settings, and every error names file, line and key.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "hal/arm/arm_parameters.hpp"
#include "ipc/base/error.hpp"
#include "rt/config/config.hpp"
#include "tests/support/says.hpp"

namespace tact::config_arm_test {
namespace {

RtConfig read(const std::string& text) {
    const auto path =
        std::filesystem::temp_directory_path() / ("tact_arm_" + std::to_string(getpid()) + ".toml");
    std::ofstream(path) << text;
    RtConfig config;
    try {
        read_config(path.string(), config);
    } catch (...) {
        std::filesystem::remove(path);
        throw;
    }
    std::filesystem::remove(path);
    return config;
}

std::string error_of(const std::string& text) {
    try {
        static_cast<void>(read(text));
    } catch (const StartupError& e) {
        return e.what();
    }
    return {};
}

TEST(ConfigArm, arm_parameters_of_the_file_reach_the_device) {
    // The model does not overwrite other keys, in any order.
    const RtConfig c =
        read("[arm]\ncounts_per_turn = [-8192, 8192, 8192]\nforce_n_max = 5\nmodel = \"premium-1.5\"\n");
    const ArmParameters p = arm_parameters(device_settings_from(c).arm);
    EXPECT_EQ(p.force_n_max, 5.0);
    EXPECT_LT(p.rad_per_count[0], 0.0);
    EXPECT_EQ(c.arm.counts_per_turn[0].source, FigureSource::configured);
    EXPECT_EQ(c.arm.drive_ratio[0].source, FigureSource::verified);
}

TEST(ConfigArm, an_arm_with_unknown_parameters_opens_once_they_are_set) {
    EXPECT_THROW(static_cast<void>(arm_parameters(read("[arm]\nmodel = \"omni\"\n").arm)), StartupError);
    const RtConfig c = read(
        "[arm]\nmodel = \"omni\"\nwrist = \"none\"\ntorque_constant_mn_m_a = [20, 20, 20]\n"
        "current_a_max = [1.5, 1.5, 1.5]\ncurrent_a_continuous = [0.5, 0.5, 0.5]\n");
    const ArmParameters p = arm_parameters(c.arm);
    EXPECT_EQ(p.wrist, Wrist::none);
    EXPECT_DOUBLE_EQ(p.joint_n_m_per_a[2], 0.020);
}

TEST(ConfigArm, without_the_section_it_is_the_documented_arm) {
    const RtConfig c;
    EXPECT_EQ(c.arm.model, "premium-1.5");
    RtConfig documented;
    documented.arm = arm_parameter_set("omni");
    read_config("deploy/tact.toml", documented);
    EXPECT_EQ(documented.arm.model, c.arm.model);
}

TEST(ConfigArm, errors_name_line_key_and_fix) {
    EXPECT_TRUE(says(error_of("[arm]\nmodel = \"delta\"\n"), {".toml:2", "arm.model", "omni", "fix:"}));
    EXPECT_TRUE(
        says(error_of("[arm]\n\nthigh_cm = 3\n"), {".toml:3", "arm.thigh_cm", "no such key", "thigh_mm"}));
    EXPECT_TRUE(says(error_of("[arm]\nthigh_mm = 3\n"), {".toml:2", "arm.thigh_mm", "10 to 2000"}));
    EXPECT_TRUE(says(error_of("[arm]\nthigh_mm = nan\n"), {".toml:2", "arm.thigh_mm"}));
    EXPECT_TRUE(says(error_of("[arm]\nthigh_mm = \"long\"\n"), {"not a number"}));
    EXPECT_TRUE(says(error_of("[arm]\nwrist = \"broken\"\n"), {".toml:2", "sensed"}));
    EXPECT_TRUE(says(error_of("[arm]\nwrist = 3\n"), {"text in quotes"}));
    EXPECT_TRUE(says(error_of("[arm]\ndrive_ratio = [1, 2]\n"), {".toml:2", "3 or 6 numbers"}));
    EXPECT_TRUE(says(error_of("[arm]\ndrive_ratio = 11\n"), {"3 or 6 numbers"}));
    EXPECT_TRUE(says(error_of("[arm]\ndrive_ratio = [1, 2, \"x\"]\n"), {"not a number"}));
    EXPECT_TRUE(says(error_of("[arm]\norigin_mm = [1, 2, 3, 4]\n"), {"list of 3 numbers"}));
}

}  // namespace
}  // namespace tact::config_arm_test
