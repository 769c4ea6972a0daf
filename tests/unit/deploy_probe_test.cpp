// tact probe on synthetic machines: trees of files in the kernel's layout.
#include "deploy/tact/probe.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/rights.hpp"
#include "tests/support/says.hpp"

namespace tact::launch::deploy_probe_test {
namespace {

namespace fs = std::filesystem;

class Tree {
public:
    [[nodiscard]] const fs::path& root() const { return folder_.path(); }
    void file(const std::string& path, const std::string& text) const {
        fs::create_directories((root() / path).parent_path());
        std::ofstream(root() / path) << text;
    }
    void usb(const std::string& name, const std::string& vendor, const std::string& product,
             const std::string& serial, int address) const {
        const std::string at = "sys/bus/usb/devices/" + name + "/";
        file(at + "idVendor", vendor + "\n");
        file(at + "idProduct", product + "\n");
        file(at + "product", "Board\n");
        file(at + "serial", serial + "\n");
        file(at + "speed", "480\n");
        file(at + "busnum", "1\n");
        file(at + "devnum", std::to_string(address) + "\n");
        char node[32];
        static_cast<void>(std::snprintf(node, sizeof node, "dev/bus/usb/001/%03d", address));
        file(node, "");
    }
    void interface(const std::string& name, const char* c, const char* s, const char* p) const {
        const std::string at = "sys/bus/usb/devices/" + name + "/";
        file(at + "bInterfaceClass", c);
        file(at + "bInterfaceSubClass", s);
        file(at + "bInterfaceProtocol", p);
    }
    void phantom(const std::string& name, const std::string& serial, int address) const {
        usb(name, "1209", "0001", serial, address);
        interface(name + ":1.0", "ff\n", "54\n", "01\n");
    }
    void can(const std::string& name, const char* flags, int mtu, int type = 280) const {
        const std::string at = "sys/class/net/" + name + "/";
        file(at + "type", std::to_string(type) + "\n");
        file(at + "flags", flags);
        file(at + "mtu", std::to_string(mtu) + "\n");
    }
    // The kernel's layout: the chip below its device, the older class beside it, links from the bus.
    void gpio(const std::string& name, const std::string& label) const {
        const fs::path device = root() / "sys/devices/pci/usb1" / name;
        file("sys/devices/pci/usb1/" + name + "/" + name + "/dev", "254:0\n");
        file("sys/devices/pci/usb1/" + name + "/gpio/gpiochip512/label", label + "\n");
        fs::create_directories(root() / "sys/bus/gpio/devices");
        fs::create_directory_symlink(device / name, root() / "sys/bus/gpio/devices" / name);
        file("dev/" + name, "");
    }

private:
    ScratchFolder folder_;
};

const Person kMember{false, {"users", "tact", "realtime"}};

struct Answer {
    std::vector<Finding> findings;
    [[nodiscard]] Finding one(const std::string& name) const {
        for (const Finding& f : findings) {
            if (f.name == name) return f;
        }
        return {};
    }
    [[nodiscard]] bool fails() const {
        return std::any_of(findings.begin(), findings.end(),
                           [](const Finding& f) { return f.level == FindingLevel::fail; });
    }
};

Answer ask(const Tree& tree, const DeviceRequest& request, const Person& person = kMember) {
    return {
        judge_devices(probe::read_buses(tree.root()), request, person, find_libraries(tree.root(), request))};
}

DeviceRequest phantom_request() {
    DeviceRequest w;
    w.driver = "phantom-usb";
    return w;
}

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
