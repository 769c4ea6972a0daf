// tact probe and force-feedback arms: which is there, what it needs, and what is missing.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/says.hpp"
#include "tests/unit/deploy_probe_tree.hpp"

namespace tact::launch::deploy_probe_arms_test {
namespace {

namespace fs = std::filesystem;
using probe_tree::Answer;
using probe_tree::ask;
using probe_tree::kMember;
using probe_tree::phantom_request;
using probe_tree::Tree;

TEST(Probe, an_arm_is_identified_by_its_interface_class_and_reported_with_its_serial) {
    const Tree tree;
    tree.usb("usb1", "1d6b", "0002", "0000:00", 1);
    tree.phantom("1-1", "P15-7", 4);
    const Answer a = ask(tree, phantom_request());
    EXPECT_FALSE(a.fails());
    EXPECT_EQ(a.one("device").level, FindingLevel::ok);
    EXPECT_TRUE(says(a.one("usb").says, {"2 devices", "1 arm "}));
    EXPECT_TRUE(
        says(a.one("arm").says, {"Phantom arm", "1209:0001", "P15-7", "driver phantom-usb", "accessible"}));
}

TEST(Probe, several_arms_need_a_serial_and_a_wrong_serial_fails) {
    const Tree tree;
    tree.phantom("1-1", "LEFT", 4);
    tree.phantom("1-2", "RIGHT", 5);
    DeviceRequest request = phantom_request();
    EXPECT_TRUE(says(ask(tree, request).one("device").says, {"several", "LEFT", "RIGHT"}));
    EXPECT_TRUE(ask(tree, request).fails());
    request.serial = "RIGHT";
    EXPECT_FALSE(ask(tree, request).fails());
    request.serial = "MIDDLE";
    EXPECT_TRUE(says(ask(tree, request).one("device").says, {"no such device with serial MIDDLE"}));
}

TEST(Probe, a_node_without_rights_fails_for_the_configured_arm_and_warns_for_another) {
    const Tree tree;
    tree.phantom("1-1", "P", 4);
    probe::Buses buses = probe::read_buses(tree.root());
    probe::Node& node = buses.usb.entries.at(0).node;
    EXPECT_TRUE(node.usable);
    node.usable = false;
    node.group = "root";
    node.mode = 0664;
    const Answer wanted{judge_devices(buses, phantom_request(), kMember, {})};
    EXPECT_EQ(wanted.one("arm").level, FindingLevel::fail);
    EXPECT_TRUE(says(wanted.one("arm").says, {"no permission to open", "group root, mode 664"}));
    EXPECT_TRUE(says(wanted.one("arm").fix, {"deploy/install.sh --rights"}));
    const Answer other{judge_devices(buses, {}, kMember, {})};
    EXPECT_EQ(other.one("arm").level, FindingLevel::warn);
    fs::remove(tree.root() / "dev/bus/usb/001/004");
    EXPECT_TRUE(says(ask(tree, phantom_request()).one("arm").says, {"does not exist", "container"}));
}

TEST(Probe, a_slow_port_is_warned_about) {
    const Tree tree;
    tree.phantom("1-1", "P", 4);
    tree.file("sys/bus/usb/devices/1-1/speed", "12\n");
    const Answer a = ask(tree, phantom_request());
    EXPECT_EQ(a.one("arm").level, FindingLevel::warn);
    EXPECT_TRUE(says(a.one("arm").says, {"only 12 Mbit/s"}));
    EXPECT_NE(a.one("arm").fix, "");
}

TEST(Probe, a_falcon_is_reported_with_the_firmware_that_it_needs) {
    const Tree tree;
    tree.usb("1-4", "0403", "cb48", "FA-1", 8);
    tree.file("sys/bus/usb/devices/1-4/speed", "12\n");
    DeviceRequest request;
    EXPECT_EQ(ask(tree, request).one("firmware").says, "");  // none configured
    request.driver = "falcon";
    Answer a = ask(tree, request);
    EXPECT_TRUE(says(a.one("arm").says, {"Novint Falcon", "FA-1", "driver falcon, accessible"}));
    EXPECT_EQ(a.one("firmware").level, FindingLevel::warn);
    EXPECT_TRUE(says(a.one("firmware").fix, {"the firmware file of the manufacturer"}));
    const auto read_again = [&] {
        return device_request_from(
            {{"ok", true},
             {"values",
              {{"device.driver", "falcon"}, {"device.firmware", (tree.root() / "fw.bin").string()}}}});
    };
    a = ask(tree, read_again());
    EXPECT_EQ(a.one("firmware").level, FindingLevel::fail);
    EXPECT_TRUE(says(a.one("firmware").says, {"fw.bin", "the file does not exist"}));
    tree.file("fw.bin", "");
    a = ask(tree, read_again());
    EXPECT_EQ(a.one("firmware").level, FindingLevel::fail);
    tree.file("fw.bin", "12345");
    a = ask(tree, read_again());
    EXPECT_FALSE(a.fails());
    EXPECT_TRUE(says(a.one("firmware").says, {"fw.bin", "5 bytes"}));
}

TEST(Probe, the_vendors_library_is_found_in_its_place_or_by_path) {
    const Tree tree;
    DeviceRequest request;
    request.driver = "openhaptics";
    EXPECT_TRUE(says(ask(tree, request).one("device").says, {"libHD.so"}));
    EXPECT_TRUE(ask(tree, request).fails());
    tree.file("usr/lib/libHD.so", "");
    EXPECT_TRUE(says(ask(tree, request).one("device").says, {"/usr/lib/libHD.so", "known only when"}));
    request.hd_library = "/nowhere/libHD.so";
    EXPECT_TRUE(ask(tree, request).fails());
}

TEST(Probe, an_inverse3_needs_its_service) {
    const Tree tree;
    DeviceRequest request;
    request.driver = "inverse3";
    Finding f = ask(tree, request).one("device");
    EXPECT_EQ(f.level, FindingLevel::warn);
    EXPECT_TRUE(says(f.fix, {"haply-inverse-service", "3.5"}));
    tree.file("etc/haply-inverse-service/haply-inverse-service-config.json", "{}");
    f = ask(tree, request).one("device");
    EXPECT_EQ(f.level, FindingLevel::ok);
    EXPECT_TRUE(says(f.says, {"Inverse Service is installed", "known only when"}));
}

TEST(Probe, both_models_of_a_touch_are_known_and_the_newer_is_reported_with_its_set_up) {
    const Tree tree;
    tree.usb("1-3", "2988", "0304", "", 7);
    tree.interface("1-3:1.0", "03\n", "00\n", "00\n");
    fs::create_directories(tree.root() / "sys/bus/usb/devices/1-3:1.0/0003:2988:0304.0001/hidraw/hidraw2");
    tree.file("usr/lib/libHD.so", "");
    DeviceRequest request;
    request.driver = "openhaptics";
    EXPECT_TRUE(says(ask(tree, request).one("arm").says, {"HID model", "hidraw2 does not exist"}));
    EXPECT_EQ(ask(tree, request).one("arm").level, FindingLevel::fail);
    tree.file("dev/hidraw2", "");
    const Answer a = ask(tree, request);
    EXPECT_FALSE(a.fails());
    EXPECT_TRUE(says(a.one("arm").says,
                     {"driver openhaptics, accessible", "TouchDriver of 2023", "Touch_HeadlessSetup"}));
    const Tree older;
    older.usb("1-3", "2988", "0302", "", 7);
    older.file("usr/lib/libHD.so", "");
    const std::string text = ask(older, request).one("arm").says;
    EXPECT_TRUE(says(text, {"serial model", "accessible"}));
    EXPECT_EQ(text.find("Touch_HeadlessSetup"), std::string::npos);
}

TEST(Probe, an_arm_of_force_dimension_needs_its_library_and_is_found_by_the_vendor_alone) {
    const Tree tree;
    tree.usb("usb1", "1d6b", "0002", "0000:00", 1);
    DeviceRequest request;
    EXPECT_TRUE(says(ask(tree, request).one("forcedimension").says, {"libdrd.so", "not found"}));
    request.driver = "forcedimension";
    EXPECT_EQ(ask(tree, request).one("device").level, FindingLevel::fail);
    EXPECT_TRUE(says(ask(tree, request).one("device").says, {"libdrd.so was not found"}));
    EXPECT_TRUE(says(ask(tree, request).one("device").fix, {"forcedimension.com", "device.fd_library"}));
    tree.file("usr/local/lib/libdrd.so", "");
    EXPECT_TRUE(says(ask(tree, request).one("device").says, {"no such device", "on USB"}));
    EXPECT_TRUE(ask(tree, request).fails());
    tree.usb("1-1", "1451", "0402", "", 4);
    Answer a = ask(tree, request);
    EXPECT_FALSE(a.fails());
    EXPECT_TRUE(
        says(a.one("device").says, {"1 device on USB", "/usr/local/lib/libdrd.so", "known only when"}));
    EXPECT_TRUE(
        says(a.one("arm").says, {"Force Dimension arm (1451:0402", "driver forcedimension, accessible"}));
    request.serial = "1001";  // USB does not tell it
    EXPECT_FALSE(ask(tree, request).fails());
    tree.usb("1-2", "1451", "040c", "", 5);
    EXPECT_FALSE(ask(tree, request).fails());
    request.serial = "";
    a = ask(tree, request);
    EXPECT_TRUE(a.fails());
    EXPECT_TRUE(says(a.one("device").says, {"several devices"}));
    EXPECT_TRUE(says(a.one("device").fix, {"device.serial"}));
    request.serial = "1001";
    probe::Buses buses = probe::read_buses(tree.root());
    for (probe::UsbDevice& d : buses.usb.entries) d.node.usable = false;
    const Answer refused{judge_devices(buses, request, kMember, find_libraries(tree.root(), request))};
    EXPECT_EQ(refused.one("arm").level, FindingLevel::fail);
    EXPECT_TRUE(says(refused.one("arm").fix, {"deploy/install.sh --rights"}));
    request.fd_library = "/nowhere/libdrd.so";
    EXPECT_TRUE(ask(tree, request).fails());
    EXPECT_EQ(device_request_from({{"values", {{"device.fd_library", "/x/libdrd.so"}}}}).fd_library,
              "/x/libdrd.so");
}

TEST(Probe, the_second_device_is_probed_too) {
    const Tree tree;
    tree.phantom("1-1", "LEFT", 4);
    DeviceRequest request;
    EXPECT_EQ(ask(tree, request).one("device2").says, "");  // none configured
    request.driver2 = "phantom-usb";
    EXPECT_FALSE(ask(tree, request).fails());
    EXPECT_TRUE(
        says(ask(tree, request).one("device2").says, {"device2.driver = \"phantom-usb\": one device found"}));
    request.serial2 = "RIGHT";
    EXPECT_TRUE(ask(tree, request).fails());
    EXPECT_TRUE(says(ask(tree, request).one("device2").says, {"no such device with serial RIGHT"}));
    EXPECT_TRUE(says(ask(tree, request).one("device2").fix, {"device2.driver = \"sim\""}));
    tree.phantom("1-2", "RIGHT", 5);
    request.driver = "phantom-usb";
    request.serial = "LEFT";
    EXPECT_FALSE(ask(tree, request).fails());
    // The second arm's node counts as configured.
    probe::Buses buses = probe::read_buses(tree.root());
    for (probe::UsbDevice& d : buses.usb.entries) d.node.usable = d.serial != "RIGHT";
    const Answer refused{judge_devices(buses, request, kMember, {})};
    EXPECT_TRUE(refused.fails());
    request.driver2 = "falcon";
    EXPECT_EQ(ask(tree, request).one("firmware").level, FindingLevel::warn);
    request.driver2 = "openhaptics";
    EXPECT_EQ(ask(tree, request).one("device2").level, FindingLevel::fail);
}

}  // namespace
}  // namespace tact::launch::deploy_probe_arms_test
