// The check of a configuration file: whether this machine has the core, and the JSON that tact reads.
#include "rt/config/check_config.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "tests/support/says.hpp"

namespace tact::config_problems_test {
namespace {

namespace fs = std::filesystem;

class Folder {
public:
    Folder() : path_(fs::temp_directory_path() / ("tact_check_" + std::to_string(getpid()))) {
        fs::create_directories(path_ / "sys/devices/system/cpu");
    }
    ~Folder() { fs::remove_all(path_); }
    [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name) << text;
        return (path_ / name).string();
    }
    [[nodiscard]] const fs::path& root() const { return path_; }

private:
    fs::path path_;
};

TEST(CheckConfig, the_servo_core_must_be_online) {
    const Folder folder;
    const auto keys = [&](const std::string& text) {
        RtConfig config;
        std::string all;
        for (const ConfigError& e : check_config_file(folder.file("a.toml", text), config, folder.root()))
            all += e.key + ": " + e.problem + "; ";
        return all;
    };
    EXPECT_EQ(keys("[servo]\ncore = 3\n"), "");  // a kernel that does not list its cores
    static_cast<void>(folder.file("sys/devices/system/cpu/online", "0-2,5\n"));
    for (const char* const core : {"-2", "-1", "0", "2", "5"})
        EXPECT_EQ(keys("[servo]\ncore = " + std::string(core) + "\n"), "") << core;
    for (const char* const core : {"3", "4", "6"})
        EXPECT_TRUE(says(keys("[servo]\ncore = " + std::string(core) + "\n"),
                         {"servo.core", "no core", core, "online: 0-2,5"}))
            << core;
    EXPECT_TRUE(says(keys("[servo]\ncore = 5000\n"), {"servo.core: 5000 is outside"}));
    EXPECT_FALSE(says(keys("[servo]\ncore = 5000\n"), {"no core"}));  // reported only once
}

TEST(CheckConfig, an_openigtlink_tracker_names_every_sensor) {
    const Folder folder;
    const auto keys = [&](const std::string& text) {
        RtConfig config;
        std::string all;
        for (const ConfigError& e :
             check_config_file(folder.file("t.toml", "[tracker]\ndriver = \"openigtlink\"\n" + text), config,
                               folder.root()))
            all += e.key + ": " + e.problem + "; ";
        return all;
    };
    EXPECT_EQ(keys("devices = \"Head\"\n"), "");
    EXPECT_EQ(keys("devices = \"Head, Channel 0\"\nsensors = 2\n"), "");
    EXPECT_TRUE(says(keys(""), {"tracker.devices: 0 names for 1 sensors"}));
    EXPECT_TRUE(says(keys("devices = \"Head, Pen\"\n"), {"tracker.devices: 2 names for 1 sensors"}));
    EXPECT_TRUE(says(keys("devices = \"Head, Head\"\nsensors = 2\n"), {"tracker.devices", "given twice"}));
    EXPECT_TRUE(says(keys("devices = \"A name of 21 letters.\"\n"), {"tracker.devices", "too long"}));
    EXPECT_TRUE(says(keys("devices = \"Head\"\nport = 0\n"), {"tracker.port: 0 is outside"}));
}

TEST(CheckConfig, the_report_ends_with_the_number_of_problems_and_the_exit_code_is_1_if_any) {
    const Folder folder;
    std::ostringstream out;
    EXPECT_EQ(print_config_check(out, "deploy/tact.toml", false), 0);
    EXPECT_EQ(out.str(), "deploy/tact.toml: no problems\n");
    out.str("");
    const std::string bad = folder.file("b.toml", "[servo]\nperiod = 3\n[shape]\ndamping_n_s_m = -1\n");
    EXPECT_EQ(print_config_check(out, bad, false), 1);
    EXPECT_TRUE(says(out.str(), {"b.toml:2: servo.period: there is no such key", "servo.period_us?",
                                 "b.toml:4: shape.damping_n_s_m", "b.toml: 2 problems\n"}))
        << out.str();
    out.str("");
    EXPECT_EQ(print_config_check(out, bad, true), 1);
    EXPECT_TRUE(says(out.str(), {"\"ok\": false", "\"key\": \"servo.period\"", "\"device.driver\": \"sim\"",
                                 "\"fix\": \"remove it"}))
        << out.str();
}

}  // namespace
}  // namespace tact::config_problems_test
