// tact probe on synthetic machines: trees of files in the kernel's layout.
#include "deploy/tact/probe.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "tests/support/says.hpp"
#include "tests/unit/deploy_probe_tree.hpp"

namespace tact::launch::deploy_probe_test {
namespace {

namespace fs = std::filesystem;
using probe_tree::Answer;
using probe_tree::ask;
using probe_tree::kMember;
using probe_tree::phantom_request;
using probe_tree::Tree;

TEST(Probe, a_machine_without_devices_is_reported_and_an_emulated_run_is_ok) {
    const Tree tree;
    const Answer a = ask(tree, {});
    EXPECT_FALSE(a.fails());
    EXPECT_EQ(a.one("usb").level, FindingLevel::warn);
    EXPECT_TRUE(says(a.one("usb").says, {"no /sys/bus/usb", "no device can be detected"}));
    EXPECT_TRUE(says(a.one("can").says, {"no CAN"}));
    EXPECT_TRUE(says(a.one("gpio").says, {"no GPIO"}));
}

TEST(Probe, an_openigtlink_server_is_judged_by_the_poses_that_it_sends) {
    DeviceRequest request;
    request.tracker = "openigtlink";
    request.tracker_host = "plus";
    request.tracker_devices = " Glasses , Channel 0";
    request.tracker_rate_hz = 60.0;
    probe::IgtlAnswer answer;
    answer.problem = "no OpenIGTLink server listens there";
    const auto level = [&](FindingLevel wanted, std::initializer_list<const char*> texts) {
        const Finding f = judge_igtl(answer, request);
        EXPECT_EQ(f.name, "tracker");
        EXPECT_EQ(f.level, wanted) << f.says;
        EXPECT_TRUE(says(f.says, texts)) << f.says;
        EXPECT_EQ(f.fix.empty(), wanted == FindingLevel::ok);
    };
    level(FindingLevel::fail, {"plus:18944", "no OpenIGTLink server listens there"});
    answer.problem.clear();
    answer.listened_s = 2.0;
    answer.sent = {{"TRANSFORM", "Glasses", 120, 120}, {"IMAGE", "Channel 0", 60, 0}};
    level(FindingLevel::fail, {"no pose \"Channel 0\"", "TRANSFORM \"Glasses\" (60 Hz)"});
    answer.sent.push_back({"TDATA", "Channel 0", 120, 0});
    level(FindingLevel::warn, {"no valid pose of \"Channel 0\""});
    answer.sent.back().valid = 100;
    level(FindingLevel::ok, {"it sends", "TDATA \"Channel 0\" (60 Hz)"});
    request.tracker_rate_hz = 240.0;
    level(FindingLevel::warn, {"arrives at 60 Hz, but tracker.rate_hz is 240"});
    request.tracker_devices = "";
    level(FindingLevel::fail, {"tracker.devices names no sensor", "Glasses"});
}

TEST(Probe, a_configured_but_missing_device_fails_with_a_fix) {
    const Tree tree;
    DeviceRequest request = phantom_request();
    request.tracker = "can";
    request.lines = "gpio";
    const Answer a = ask(tree, request);
    for (const char* const name : {"device", "can", "gpio"}) {
        EXPECT_EQ(a.one(name).level, FindingLevel::fail) << name;
        EXPECT_NE(a.one(name).fix, "") << name;
    }
    EXPECT_TRUE(says(a.one("device").says, {"USB is not visible", "cannot be detected"}));
}

TEST(Probe, devices_without_a_driver_are_reported_as_such) {
    for (const probe::KnownDevice& k : probe::kKnownDevices) {
        if (k.interface != 0) continue;
        const Tree tree;
        char vendor[8], product[8];
        static_cast<void>(std::snprintf(vendor, sizeof vendor, "%04x", static_cast<unsigned>(k.vendor)));
        static_cast<void>(std::snprintf(product, sizeof product, "%04x", static_cast<unsigned>(k.product)));
        tree.usb("3-2", vendor, product, "", 9);
        const Answer a = ask(tree, {});
        const Finding f = a.one(k.use == probe::Use::arm ? "arm" : "adapter");
        EXPECT_TRUE(says(f.says, {k.what, vendor, product})) << f.says;
        EXPECT_EQ(f.says.find("no driver for it") != std::string::npos,
                  k.use == probe::Use::arm && std::string(k.driver).empty());
    }
}

TEST(Probe, hidraw_nodes_and_serial_ports_of_a_device_are_found) {
    const Tree tree;
    tree.usb("1-3", "16c0", "0486", "", 7);
    tree.interface("1-3:1.0", "03\n", "00\n", "00\n");
    fs::create_directories(tree.root() / "sys/bus/usb/devices/1-3:1.0/0003:16C0:0486.0001/hidraw/hidraw2");
    tree.file("dev/hidraw2", "");
    tree.usb("1-4", "0403", "cb48", "", 8);
    tree.interface("1-4:1.0", "ff\n", "ff\n", "ff\n");
    fs::create_directories(tree.root() / "sys/bus/usb/devices/1-4:1.0/ttyUSB5");
    const auto usb = probe::usb_devices(tree.root());
    ASSERT_EQ(usb.entries.size(), 2U);
    ASSERT_EQ(usb.entries[0].nodes.size(), 1U);
    EXPECT_EQ(usb.entries[0].nodes[0].path, (tree.root() / "dev/hidraw2").string());
    EXPECT_TRUE(usb.entries[0].nodes[0].usable);
    DeviceRequest request;
    request.driver = "polhem";
    EXPECT_FALSE(ask(tree, request).fails());
    EXPECT_TRUE(says(ask(tree, request).one("arm").says, {"driver polhem, accessible"}));
    fs::remove(tree.root() / "dev/hidraw2");
    EXPECT_TRUE(says(ask(tree, request).one("arm").says, {"hidraw2 does not exist"}));
    ASSERT_EQ(usb.entries[1].nodes.size(), 1U);
    EXPECT_EQ(usb.entries[1].nodes[0].path, (tree.root() / "dev/ttyUSB5").string());
    EXPECT_FALSE(usb.entries[1].nodes[0].usable);
}

TEST(Probe, a_can_interface_must_exist_be_up_and_have_the_frame_size) {
    const Tree tree;
    tree.can("eth0", "0x1003\n", 1500, 1);
    tree.can("can0", "0x40080\n", 16);
    tree.file("proc/net/can/version", "");
    DeviceRequest request;
    EXPECT_TRUE(says(ask(tree, request).one("can").says, {"can0 (down)"}));
    EXPECT_EQ(ask(tree, request).one("can").says.find("eth0"), std::string::npos);
    EXPECT_FALSE(ask(tree, request).fails());
    request.tracker = "can";
    EXPECT_TRUE(says(ask(tree, request).one("can").says, {"the interface is down"}));
    EXPECT_TRUE(says(ask(tree, request).one("can").fix, {"deploy/can-up can0"}));
    tree.can("can0", "0x400c1\n", 16);
    EXPECT_FALSE(ask(tree, request).fails());
    request.tracker_format = "fd";
    EXPECT_TRUE(says(ask(tree, request).one("can").says, {"CAN FD"}));
    tree.can("can0", "0x400c1\n", 72);
    EXPECT_FALSE(ask(tree, request).fails());
    request.tracker_interface = "can7";
    EXPECT_TRUE(says(ask(tree, request).one("can").says, {"no interface has this name", "can0 (up, FD)"}));
}

TEST(Probe, a_gpio_chip_is_found_by_label_name_or_path_and_duplicates_are_refused) {
    const Tree tree;
    tree.gpio("gpiochip0", "INT34C5:00");
    tree.gpio("gpiochip1", "cp2112_gpio");
    DeviceRequest request;
    EXPECT_TRUE(says(ask(tree, request).one("gpio").says, {"gpiochip0 \"INT34C5:00\"", "gpiochip1"}));
    request.lines = "gpio";
    for (const std::string& chip :
         {std::string("cp2112_gpio"), std::string("gpiochip1"), (tree.root() / "dev/gpiochip1").string()}) {
        request.lines_chip = chip;
        EXPECT_FALSE(ask(tree, request).fails()) << chip;
    }
    request.lines_chip = "mcp2221";
    EXPECT_TRUE(says(ask(tree, request).one("gpio").says, {"no chip has this label"}));
    tree.gpio("gpiochip2", "cp2112_gpio");
    request.lines_chip = "cp2112_gpio";
    EXPECT_TRUE(says(ask(tree, request).one("gpio").says, {"several chips"}));
    request.lines_chip = "gpiochip2";
    fs::remove(tree.root() / "dev/gpiochip2");
    EXPECT_TRUE(says(ask(tree, request).one("gpio").says, {"does not exist"}));
}

TEST(Probe, groups_are_reported_by_purpose) {
    const Tree tree;
    EXPECT_EQ(ask(tree, {}, kMember).one("groups").level, FindingLevel::ok);
    EXPECT_EQ(ask(tree, {}, {true, {}}).one("groups").level, FindingLevel::ok);
    const Finding f = ask(tree, {}, {false, {"users", "tact"}}).one("groups");
    EXPECT_EQ(f.level, FindingLevel::warn);
    EXPECT_TRUE(says(f.says, {"realtime"}));
    EXPECT_TRUE(says(f.fix, {"--rights"}));
    const Finding later = ask(tree, {}, {false, {"users"}, {"users", "tact", "realtime"}, ""}).one("groups");
    EXPECT_EQ(later.level, FindingLevel::warn);
    EXPECT_TRUE(says(later.says, {"a member of the group tact, but this session began before that"}));
    EXPECT_EQ(later.fix, kLoginFix);
    // With one missing membership and one missing login, the fix is the former: a login alone would not suffice.
    EXPECT_EQ(ask(tree, {}, {false, {"users"}, {"users", "tact"}, ""}).one("groups").fix, kRightsFix);
    EXPECT_EQ(ask(tree, {}, {false, {"users"}, {"users", "realtime"}, ""}).one("groups").fix, kRightsFix);
}

TEST(Probe, hostile_texts_numbers_and_long_lists_are_bounded) {
    const Tree tree;
    tree.phantom("1-1", std::string(5000, 'x') + "\x1b[2J", 4);
    tree.file("sys/bus/usb/devices/1-1/product", "\x1b]0;evil\x07 name\n");
    tree.usb("1-2", "12345", "0001", "", 5);
    tree.usb("1-3", "-1", "zz", "", 6);
    tree.file("sys/bus/usb/devices/1-4/idVendor", "");
    tree.usb("1-5", "1209", "0001", "", 7);
    tree.file("sys/bus/usb/devices/1-5/busnum", "../../../etc\n");
    const auto usb = probe::usb_devices(tree.root());
    ASSERT_EQ(usb.entries.size(), 2U);
    EXPECT_LE(usb.entries[0].serial.size(), probe::kTextMax);
    for (const char c : usb.entries[0].name + usb.entries[0].serial) EXPECT_TRUE(c >= ' ' && c <= '~');
    EXPECT_EQ(usb.entries[1].node.path, "");
    EXPECT_FALSE(ask(tree, {}).findings.empty());

    const Tree crowd;
    for (std::size_t i = 0; i < probe::kEntriesMax + 20; ++i)
        fs::create_directories(crowd.root() / ("sys/bus/gpio/devices/gpiochip" + std::to_string(i)));
    const auto gpio = probe::gpio_chips(crowd.root());
    EXPECT_EQ(gpio.entries.size(), probe::kEntriesMax);
    EXPECT_TRUE(gpio.more);

    // A pipe in place of a file does not block.
    const Tree pipes;
    fs::create_directories(pipes.root() / "sys/class/net/can0");
    ASSERT_EQ(mkfifo((pipes.root() / "sys/class/net/can0/type").c_str(), 0600), 0);
    EXPECT_TRUE(probe::can_interfaces(pipes.root()).entries.empty());
}

TEST(Probe, the_controllers_reading_of_the_configuration_decides_what_is_probed) {
    const Tree tree;
    const nlohmann::json answer = {{"ok", false},
                                   {"values",
                                    {{"device.driver", "phantom-usb"},
                                     {"device.serial", "L"},
                                     {"device2.driver", "falcon"},
                                     {"device2.serial", "R"},
                                     {"tracker.driver", "can"},
                                     {"tracker.format", "fd"},
                                     {"lines.driver", "gpio"},
                                     {"servo.core", 3}}},
                                   {"problems",
                                    {{{"where", "a.toml:2"},
                                      {"key", "servo.x"},
                                      {"problem", "there is no such key"},
                                      {"fix", "remove it"}}}}};
    const DeviceRequest w = device_request_from(answer);
    EXPECT_EQ(w.driver + w.serial + w.driver2 + w.serial2 + w.tracker + w.tracker_format + w.lines,
              "phantom-usbLfalconRcanfdgpio");
    EXPECT_EQ(w.tracker_interface, "can0");
    const Answer a = ask(tree, w);
    EXPECT_EQ(a.one("configuration").level, FindingLevel::fail);
    EXPECT_EQ(a.one("configuration").says, "a.toml:2: servo.x: there is no such key");
    EXPECT_EQ(a.one("configuration").fix, "remove it");
    EXPECT_EQ(device_request_from(nlohmann::json::object()).driver, "sim");
    EXPECT_EQ(device_request_from({{"values", {{"device.driver", 3}}}}).driver, "sim");
}

TEST(Probe, a_space_mouse_and_gamepads_are_listed_with_what_is_missing) {
    const Tree tree;
    const auto rows = [&tree](SpacenavService service) {
        return judge_input({service, "/run/spnav.sock"}, probe::joysticks(tree.root()));
    };
    auto found = rows(SpacenavService::absent);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].name, "spacenavd");
    EXPECT_EQ(found[0].level, FindingLevel::ok) << "not needed";
    EXPECT_TRUE(says(found[0].says, {"not found"}));
    EXPECT_EQ(found[1].name, "gamepads");
    EXPECT_EQ(found[1].level, FindingLevel::ok);
    found = rows(SpacenavService::answers);
    EXPECT_TRUE(says(found[0].says, {"answers", "/run/spnav.sock"}));
    for (const SpacenavService bad :
         {SpacenavService::denied, SpacenavService::refuses, SpacenavService::busy}) {
        found = rows(bad);
        EXPECT_EQ(found[0].level, FindingLevel::warn);
        EXPECT_NE(found[0].fix, "");
    }
    tree.file("sys/class/input/js0/device/name", "Pad of\x01 Somebody\n");
    tree.file("sys/class/input/js0/device/event7/dev", "13:71\n");
    tree.file("sys/class/input/mouse0/device/name", "Mouse\n");
    tree.file("dev/input/event7", "");
    const auto sticks = probe::joysticks(tree.root());
    ASSERT_EQ(sticks.entries.size(), 1U);
    EXPECT_EQ(sticks.entries[0].name, "Pad of? Somebody");
    EXPECT_TRUE(sticks.entries[0].node.usable);
    EXPECT_TRUE(says(rows(SpacenavService::absent)[1].says, {"Pad of? Somebody", "accessible"}));
    fs::remove(tree.root() / "dev/input/event7");
    found = rows(SpacenavService::absent);
    EXPECT_EQ(found[1].level, FindingLevel::warn);
    EXPECT_TRUE(says(found[1].says, {"event7", "does not exist"}));
    EXPECT_NE(found[1].fix, "");
}

}  // namespace
}  // namespace tact::launch::deploy_probe_test
