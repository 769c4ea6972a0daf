// A machine's devices as files in the kernel's layout, and what tact probe says of them.
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "deploy/tact/files.hpp"
#include "deploy/tact/probe.hpp"

namespace tact::launch::probe_tree {

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

inline const Person kMember{false, {"users", "tact", "realtime"}};

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

inline Answer ask(const Tree& tree, const DeviceRequest& request, const Person& person = kMember) {
    return {
        judge_devices(probe::read_buses(tree.root()), request, person, find_libraries(tree.root(), request))};
}

inline DeviceRequest phantom_request() {
    DeviceRequest w;
    w.driver = "phantom-usb";
    return w;
}

}  // namespace tact::launch::probe_tree
