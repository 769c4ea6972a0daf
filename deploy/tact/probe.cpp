#include "deploy/tact/probe.hpp"

#include <algorithm>
#include <cstdio>

#include "ipc/base/rights.hpp"

namespace tact::launch {
namespace {

using probe::Buses;
using probe::CanInterface;
using probe::GpioChip;
using probe::UsbDevice;

std::string joined(const std::vector<std::string>& parts) {
    std::string all;
    for (const std::string& p : parts) all += (all.empty() ? "" : ", ") + p;
    return all;
}

std::string number_of(std::size_t n, bool more, const char* one, const char* many) {
    return std::to_string(n) + (more ? " or more " : " ") + (n == 1 ? one : many);
}

std::string name_of(const UsbDevice& d) {
    char ids[16];
    static_cast<void>(std::snprintf(ids, sizeof ids, "%04x:%04x", static_cast<unsigned>(d.vendor),
                                    static_cast<unsigned>(d.product)));
    std::string name = std::string(d.known != nullptr ? d.known->what : "") + " (" + ids;
    if (!d.name.empty()) name += ", \"" + d.name + "\"";
    if (!d.serial.empty()) name += ", serial " + d.serial;
    return name + ")";
}

// Why the user may not use the node; "" if permitted.
std::string refusal(const probe::Node& n) {
    if (n.usable) return "";
    if (n.path.empty()) return "the device has no device node";
    char mode[8];
    static_cast<void>(std::snprintf(mode, sizeof mode, "%03o", n.mode));
    return n.mode == 0 ? n.path + " does not exist (a container without its devices?)"
                       : "this user has no permission to open " + n.path + " (group " +
                             (n.group.empty() ? "unknown" : n.group) + ", mode " + mode + ")";
}

// The node that the driver opens: hidraw for a driver that reads reports, else the device's own node.
probe::Node node_of(const UsbDevice& d) {
    const std::string driver = d.known == nullptr ? "" : d.known->driver;
    if (driver == "openhaptics" && !d.nodes.empty())
        return d.nodes.front();  // hidraw or ttyACM, by the model
    if (driver != "polhem") return d.node;
    const auto raw = std::find_if(d.nodes.begin(), d.nodes.end(), [](const probe::Node& n) {
        return n.path.find("hidraw") != std::string::npos;
    });
    return raw == d.nodes.end() ? probe::Node{} : *raw;
}

Finding usb(const Buses& b) {
    if (!b.usb.visible)
        return {"usb", FindingLevel::warn,
                "this kernel or container has no USB (no /sys/bus/usb): no device can be detected",
                "run tact probe on the machine with the devices; in a container mount /sys and /dev/bus/usb"};
    const auto arms = std::count_if(b.usb.entries.begin(), b.usb.entries.end(), [](const UsbDevice& d) {
        return d.known != nullptr && d.known->use == probe::Use::arm;
    });
    return {"usb", FindingLevel::ok,
            number_of(b.usb.entries.size(), b.usb.more, "device", "devices") + " on USB, " +
                number_of(static_cast<std::size_t>(arms), false, "arm", "arms") + " among them",
            ""};
}

// One row per known device.
void known_devices(const Buses& b, const DeviceRequest& request, std::vector<Finding>& out) {
    for (const UsbDevice& d : b.usb.entries) {
        if (d.known == nullptr) continue;
        const bool arm = d.known->use == probe::Use::arm;
        const std::string driver = d.known->driver;
        const auto asked = [&](const std::string& by, const std::string& serial) {
            // USB does not tell the serial number of an arm of Force Dimension.
            return by == driver && (serial.empty() || d.serial.empty() || serial == d.serial);
        };
        const bool wanted =
            arm && (asked(request.driver, request.serial) || asked(request.driver2, request.serial2));
        Finding f{arm ? "arm" : "adapter", FindingLevel::ok, name_of(d), ""};
        if (arm && driver.empty()) {
            f.says += ": detected, but this version has no driver for it";
        } else if (arm) {
            const std::string no = refusal(node_of(d));
            if (!no.empty()) {
                f.level = wanted ? FindingLevel::fail : FindingLevel::warn;
                f.fix = kDeviceRightsFix;
            } else if (driver == "phantom-usb" && d.speed_mbit != "480" && !d.speed_mbit.empty()) {
                f.level = FindingLevel::warn;
                f.fix = "plug the device into a USB 2 high-speed port, without a slow hub between";
            }
            f.says += ": driver " + driver +
                      (!no.empty()                   ? "; " + no
                       : f.level == FindingLevel::ok ? ", accessible"
                                                     : ", at only " + d.speed_mbit + " Mbit/s");
            if (driver == "openhaptics" && d.product == probe::kTouchHid)
                f.says +=
                    "; it needs the manufacturer's TouchDriver of 2023 or newer, and once its "
                    "Touch_HeadlessSetup";
        }
        out.push_back(std::move(f));
    }
}

// Of driver inverse3: its service, not Tact, talks to the arm.
Finding inverse_service(const std::string& section, const std::string& what, const std::string& folder) {
    if (folder.empty())
        return {
            section, FindingLevel::warn,
            what +
                "no configuration of Haply's Inverse Service is on this machine (/etc/haply-inverse-service)",
            "install the service 3.5 or newer (haply.co: Haply Hub, or the .deb package) and run sudo "
            "systemctl "
            "enable --now haply-inverse-service; Haply Hub may also run it without this folder"};
    return {section, FindingLevel::ok,
            what + "the Inverse Service is installed (" + folder +
                "); its arms are known only when tact-rt "
                "connects to it",
            ""};
}

// section: "device" or "device2".
Finding driver_arm(const Buses& b, const std::string& section, const std::string& driver,
                   const std::string& serial, const VendorLibraries& libraries) {
    const std::string what = section + ".driver = \"" + driver + "\": ";
    if (driver == "sim" || driver == "sim-process")
        return {section, FindingLevel::ok, what + "emulated, needs no device", ""};
    if (driver == "openhaptics") {
        if (libraries.hd.empty())
            return {section, FindingLevel::fail, what + "the manufacturer's library libHD.so was not found",
                    "install the manufacturer's OpenHaptics and device driver, or set device.hd_library to "
                    "the file"};
        return {section, FindingLevel::ok,
                what + libraries.hd + "; its devices are known only when tact-rt opens the library", ""};
    }
    if (driver == "inverse3") return inverse_service(section, what, libraries.inverse_service);
    const bool by_library = driver == "forcedimension";
    if (by_library && libraries.fd.empty())
        return {section, FindingLevel::fail, what + "the manufacturer's library libdrd.so was not found",
                "install the Force Dimension SDK for 64-bit Linux (forcedimension.com, Support, Downloads), "
                "and set device.fd_library to its lib/release/lin-x86_64-gcc/libdrd.so"};
    std::vector<std::string> serials;
    bool known = false;
    for (const auto& k : probe::kKnownDevices) known = known || driver == k.driver;
    for (const UsbDevice& d : b.usb.entries) {
        if (d.known != nullptr && d.known->use == probe::Use::arm && driver == d.known->driver &&
            (serial.empty() || by_library || serial == d.serial))
            serials.push_back(d.serial.empty() ? "without serial" : d.serial);
    }
    if (!known)
        return {section, FindingLevel::fail, what + "no such driver, or the driver cannot be probed",
                "tact config check FILE lists the drivers"};
    const std::string which = serial.empty() ? "" : " with serial " + serial;
    if (serials.empty())
        return {section, FindingLevel::fail,
                what + (b.usb.visible ? "no such device" + which + " on USB"
                                      : "USB is not visible here, so that the device cannot be detected"),
                "plug the device in and switch it on, or set " + section +
                    ".driver = \"sim\"; lsusb lists the bus"};
    // The library, not USB, knows the serial numbers of these arms.
    if (by_library && (serials.size() == 1 || !serial.empty()))
        return {section, FindingLevel::ok,
                what + number_of(serials.size(), false, "device", "devices") + " on USB, library " +
                    libraries.fd + "; model and initialization are known only when tact-rt opens it",
                ""};
    if (serials.size() > 1)
        return {section, FindingLevel::fail, what + "several devices match: " + joined(serials),
                "select one with " + section + ".serial"};
    return {section, FindingLevel::ok, what + "one device found" + which, ""};
}

// A Falcon loses its firmware at power-off; its owner has the firmware file.
Finding falcon_firmware(const DeviceRequest& request) {
    if (request.firmware.empty())
        return {"firmware", FindingLevel::warn,
                "device.firmware is not set: a Falcon does not work after power-on",
                "set device.firmware to the firmware file of the manufacturer's software"};
    if (request.firmware_bytes <= 0)
        return {"firmware", FindingLevel::fail,
                "device.firmware = \"" + request.firmware +
                    "\": the file does not exist, is not readable or is empty",
                "set device.firmware to the firmware file of the manufacturer's software"};
    return {"firmware", FindingLevel::ok,
            "device.firmware = \"" + request.firmware + "\": " + std::to_string(request.firmware_bytes) +
                " bytes",
            ""};
}

Finding can(const Buses& b, const DeviceRequest& request) {
    const bool wanted = request.tracker == "can";
    const std::string what = wanted ? "tracker.interface = \"" + request.tracker_interface + "\": " : "";
    const FindingLevel bad = wanted ? FindingLevel::fail : FindingLevel::ok;
    if (!b.can.visible)
        return {"can", bad, what + "this kernel has no CAN, or no interface is visible",
                wanted ? "sudo modprobe can_raw; in a container use the host's network" : ""};
    std::vector<std::string> names;
    const CanInterface* mine = nullptr;
    for (const CanInterface& c : b.can.entries) {
        names.push_back(c.name + (c.up ? " (up" : " (down") + (c.fd ? ", FD)" : ")"));
        if (c.name == request.tracker_interface) mine = &c;
    }
    const std::string list = names.empty() ? "no CAN interface" : "CAN interfaces: " + joined(names);
    if (!wanted) return {"can", FindingLevel::ok, list, ""};
    if (mine == nullptr)
        return {"can", bad, what + "no interface has this name; " + list,
                "plug the adapter in, or set tracker.interface"};
    if (!mine->up) return {"can", bad, what + "the interface is down", "sudo deploy/can-up " + mine->name};
    if (request.tracker_format == "fd" && !mine->fd)
        return {"can", bad, what + "the interface does not support CAN FD, which tracker.format requires",
                "sudo deploy/can-up " + mine->name +
                    "; if the output contains \"classic\", set tracker.format = \"classic\""};
    return {"can", FindingLevel::ok, what + list, ""};
}

Finding gpio(const Buses& b, const DeviceRequest& request) {
    const bool wanted = request.lines == "gpio";
    const std::string what = wanted ? "lines.chip = \"" + request.lines_chip + "\": " : "";
    const FindingLevel bad = wanted ? FindingLevel::fail : FindingLevel::ok;
    if (!b.gpio.visible)
        return {"gpio", bad, what + "this kernel or container has no GPIO (no /sys/bus/gpio)",
                wanted ? "run tact probe on the machine with the adapter" : ""};
    std::vector<std::string> names;
    std::vector<const GpioChip*> mine;
    for (const GpioChip& c : b.gpio.entries) {
        names.push_back(c.name + (c.label.empty() ? "" : " \"" + c.label + "\""));
        if (c.label == request.lines_chip || c.name == request.lines_chip ||
            c.node.path == request.lines_chip)
            mine.push_back(&c);
    }
    const std::string list = names.empty() ? "no GPIO chip" : "GPIO chips: " + joined(names);
    if (!wanted) return {"gpio", FindingLevel::ok, list, ""};
    if (mine.empty())
        return {"gpio", bad, what + "no chip has this label, name or path; " + list,
                "plug the adapter in, or set lines.chip"};
    if (mine.size() > 1)
        return {"gpio", bad, what + "several chips have this label; " + list,
                "set lines.chip to the path of one"};
    const std::string no = refusal(mine.front()->node);
    if (!no.empty()) return {"gpio", bad, what + no, kDeviceRightsFix};
    return {"gpio", FindingLevel::ok, what + "present and accessible; " + list, ""};
}

Finding groups(const Person& p) {
    if (p.root) return {"groups", FindingLevel::ok, "root: needs no group", ""};
    std::vector<std::string> texts;
    Lacking worst = Lacking::nothing;
    for (const char* const group : {"tact", "realtime"}) {
        const Lacking lacking = lacking_group(p, group);
        if (lacking == Lacking::nothing) continue;
        texts.push_back(lacking_text(lacking, group));
        if (worst != Lacking::membership) worst = lacking;
    }
    if (texts.empty()) return {"groups", FindingLevel::ok, "a member of tact and realtime", ""};
    return {"groups", FindingLevel::warn,
            joined(texts) + " (tact: devices; realtime: priority, locked memory)", lacking_fix(worst)};
}

}  // namespace

std::vector<Finding> judge_devices(const Buses& buses, const DeviceRequest& request, const Person& person,
                                   const VendorLibraries& libraries) {
    std::vector<Finding> out = request.problems;
    out.push_back(driver_arm(buses, "device", request.driver, request.serial, libraries));
    if (request.driver2 != "none")
        out.push_back(driver_arm(buses, "device2", request.driver2, request.serial2, libraries));
    out.push_back(usb(buses));
    known_devices(buses, request, out);
    if (request.driver == "falcon" || request.driver2 == "falcon") out.push_back(falcon_firmware(request));
    if (request.driver != "openhaptics" && request.driver2 != "openhaptics")
        out.push_back({"openhaptics", FindingLevel::ok,
                       libraries.hd.empty() ? "the manufacturer's library libHD.so was not found"
                                            : "manufacturer's library: " + libraries.hd,
                       ""});
    if (request.driver != "forcedimension" && request.driver2 != "forcedimension")
        out.push_back({"forcedimension", FindingLevel::ok,
                       libraries.fd.empty() ? "the manufacturer's library libdrd.so was not found"
                                            : "manufacturer's library: " + libraries.fd,
                       ""});
    out.push_back(can(buses, request));
    out.push_back(gpio(buses, request));
    out.push_back(groups(person));
    return out;
}

}  // namespace tact::launch
