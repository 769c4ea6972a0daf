// Two hands in the configuration: their drivers, serials, scripts and the pointer that leads them.
#include <gtest/gtest.h>

#include "rt/config/config.hpp"
#include "tests/support/says.hpp"
#include "tests/unit/config_file.hpp"

namespace tact::config_hands_test {
namespace {

using test::error_of;
using test::TempFile;

TEST(Config, two_arms_of_one_driver_need_two_serials) {
    RtConfig config;
    config.device.driver = config.device2.driver = "phantom-usb";
    const auto refused = [&] {
        try {
            check_config(config, "here");
        } catch (const StartupError& e) {
            return std::string(e.what()).find("device2.serial") != std::string::npos;
        }
        return false;
    };
    EXPECT_TRUE(refused());
    config.device.serial = config.device2.serial = "A";
    EXPECT_TRUE(refused());
    config.device2.serial = "B";
    EXPECT_FALSE(refused());
    const DeviceSettings second = device2_settings_from(config);
    EXPECT_EQ(second.driver, "phantom-usb");
    EXPECT_EQ(second.serial, "B");
    EXPECT_EQ(device_settings_from(config).serial, "A");
}

TEST(Config, the_second_emulated_hand_has_a_script_of_its_own) {
    RtConfig config;
    config.device.hand = "surgeon";
    config.device.hand_at_mm = {-8.0, 2.0};
    EXPECT_EQ(device2_settings_from(config).sim.hand.script, "surgeon");
    config.device2.hand = "suction-tube";
    EXPECT_EQ(device_settings_from(config).sim.hand.script, "surgeon");
    EXPECT_EQ(device2_settings_from(config).sim.hand.script, "suction-tube");
    EXPECT_TRUE(device2_settings_from(config).sim.hand.at_m.isApprox(Vec3(-8e-3, 2e-3, 0.0)));
}

TEST(Config, a_pointer_leads_emulated_hands_only) {
    RtConfig config;
    const auto refused = [&config] {
        try {
            check_config(config, "here");
        } catch (const ConfigError& e) {
            return e.key + ": " + e.problem;
        }
        return std::string();
    };
    EXPECT_EQ(mouse_hands(config), (std::array{false, false}));
    config.device.hand = "mouse";
    EXPECT_EQ(mouse_hands(config), (std::array{true, false}));
    config.device2.driver = "sim";
    EXPECT_EQ(mouse_hands(config), (std::array{true, true})) << "\"same\" as the first";
    config.device2.hand = "suction-tube";
    EXPECT_EQ(mouse_hands(config), (std::array{true, false}));
    config.device.mouse = true;
    EXPECT_EQ(mouse_hands(config), (std::array{true, true}));
    EXPECT_EQ(refused(), "");
    // The second arm is real: its hand is a person's, the first one may be led.
    config.device2 = {};
    config.device2.driver = "falcon";
    EXPECT_EQ(mouse_hands(config), (std::array{true, false}));
    EXPECT_EQ(refused(), "");
    for (const DeviceEntry& d : device_drivers()) {
        if (std::string(d.name) == "sim") continue;
        config = {};
        config.device.driver = d.name;
        config.device.hand = "mouse";
        EXPECT_TRUE(says(refused(), {"device.hand: the mouse cannot lead", d.name}));
        EXPECT_EQ(mouse_hands(config), (std::array{false, false}));
        config.device.hand = "passive";
        config.device.mouse = true;
        EXPECT_TRUE(says(refused(), {"device.mouse: the mouse cannot lead", d.name}));
        config = {};
        config.device2.driver = d.name;
        config.device2.hand = "mouse";
        EXPECT_TRUE(says(refused(), {"device2.hand: the mouse cannot lead", d.name}));
        for (const char* const device : {"spacemouse", "gamepad"}) {
            config = {};
            config.device.driver = d.name;
            config.device.hand = device;
            EXPECT_TRUE(says(refused(), {"device.hand: the", device, "cannot lead", d.name}));
            EXPECT_EQ(mouse_hands(config), (std::array{false, false}));
        }
    }
}

TEST(Config, a_hand_is_led_by_the_device_that_its_script_names) {
    using enum LeadDevice;
    RtConfig config;
    config.device2.driver = "sim";
    EXPECT_EQ(lead_devices(config), (std::array{mouse, mouse}));
    config.device.hand = "spacemouse";
    EXPECT_EQ(mouse_hands(config), (std::array{true, true}));
    EXPECT_EQ(lead_devices(config), (std::array{spacemouse, spacemouse})) << "\"same\" as the first";
    config.device2.hand = "gamepad";
    EXPECT_EQ(mouse_hands(config), (std::array{true, true}));
    EXPECT_EQ(lead_devices(config), (std::array{spacemouse, gamepad}));
    check_config(config, "here");
    config.device2.hand = "wander";
    EXPECT_EQ(mouse_hands(config), (std::array{true, false}));
    EXPECT_EQ(lead_devices(config), (std::array{spacemouse, mouse}));
}

TEST(Config, any_pair_of_drivers_may_be_first_and_second_hand_or_is_refused_with_the_reason) {
    for (const DeviceEntry& first : device_drivers()) {
        for (const DeviceEntry& second : device_drivers()) {
            SCOPED_TRACE(std::string(first.name) + " and " + second.name);
            RtConfig config;
            config.device.driver = first.name;
            config.device2.driver = second.name;
            const auto refused = [&] {
                try {
                    check_config(config, "here");
                } catch (const ConfigError& e) {
                    return e.key + ": " + e.problem;
                }
                return std::string();
            };
            const bool same = first.name == second.name && !first.emulated;
            if (same && std::string(first.name) == "openhaptics") {
                EXPECT_TRUE(says(refused(), {"device2.driver", "drives one arm, not two"})) << refused();
                continue;
            }
            if (same) {
                EXPECT_TRUE(says(refused(), {"device2.serial", "different serials"})) << refused();
            }
            config.device.serial = "1";
            config.device2.serial = "2";
            EXPECT_EQ(refused(), "");
            const DeviceSettings of_first = device_settings_from(config),
                                 of_second = device2_settings_from(config);
            EXPECT_EQ(of_first.driver, first.name);
            EXPECT_EQ(of_second.driver, second.name);
            EXPECT_EQ(of_first.serial + of_second.serial, "12");
            EXPECT_NE(first.make(of_first), nullptr);
            EXPECT_NE(second.make(of_second), nullptr);
            // A hand led by the mouse beside any arm, on either side.
            if (std::string(second.name) == "sim") {
                config.device2.hand = "mouse";
                EXPECT_EQ(refused(), "");
                EXPECT_EQ(mouse_hands(config)[1], true);
            }
            if (std::string(first.name) == "sim") {
                config.device.hand = "mouse";
                config.device2.hand = "passive";
                EXPECT_EQ(refused(), "");
                EXPECT_EQ(mouse_hands(config), (std::array{true, false}));
            }
        }
    }
}

}  // namespace
}  // namespace tact::config_hands_test
