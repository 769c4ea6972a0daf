// USB      /sys/bus/usb/devices: entries with ':' are interfaces, the others devices; numbers are
//          hexadecimal except for busnum and devnum
// CAN      /sys/class/net: a type of 280 (ARPHRD_CAN); an MTU of 72 holds CAN FD
// GPIO     /sys/bus/gpio/devices; the label comes from the chip if it may be opened (one ioctl that changes
//          nothing), otherwise from the older gpio class beside it
// Input    /sys/class/input: jsN/device leads to the device with its name and its eventN
#include "hal/probe/buses.hpp"

#include <fcntl.h>
#include <grp.h>
#include <linux/gpio.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>

namespace tact::probe {

namespace {

namespace fs = std::filesystem;

std::string plain(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    text.resize(std::min(text.size(), kTextMax));
    for (char& c : text) c = c >= ' ' && c <= '~' ? c : '?';
    return text;
}

// The first bytes of a file; "" if unreadable. Does not wait for a pipe or a device.
std::string text_of(const fs::path& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) return "";
    char bytes[256];
    const ssize_t n = ::read(fd, bytes, sizeof bytes);
    ::close(fd);
    return n > 0 ? plain(std::string(bytes, static_cast<std::size_t>(n))) : "";
}

bool number(const std::string& text, int base, std::uint32_t most, std::uint32_t& out) {
    std::uint32_t v = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, v, base);
    if (text.empty() || error != std::errc{} || at != end || v > most) return false;
    out = v;
    return true;
}

// Names in a folder, sorted. False: no such folder.
bool names_in(const fs::path& folder, std::vector<std::string>& names, bool& more) {
    std::error_code error;
    fs::directory_iterator at(folder, error);
    if (error) return false;
    for (const fs::directory_iterator end; at != end && !error; at.increment(error)) {
        if (names.size() == kEntriesMax) {
            more = true;
            break;
        }
        names.push_back(at->path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return true;
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    bool more = false;
    static_cast<void>(names_in(folder, names, more));
    return names;
}

Node node_at(const fs::path& path) {
    Node n;
    n.path = plain(path.string());
    n.usable = access(path.c_str(), R_OK | W_OK) == 0;
    struct stat s {};
    if (stat(path.c_str(), &s) != 0) return n;
    n.mode = s.st_mode & 0777U;
    group g{}, *found = nullptr;
    char buffer[4096];
    if (getgrgid_r(s.st_gid, &g, buffer, sizeof buffer, &found) == 0 && found != nullptr)
        n.group = plain(found->gr_name);
    return n;
}

std::string link_name(const fs::path& link) {
    std::error_code error;
    const fs::path to = fs::read_symlink(link, error);
    return error ? "" : plain(to.filename().string());
}

// hidraw nodes and serial ports are below the interface: hidraw/hidrawN in a subfolder, ttyUSBn in it,
// tty/ttyACMn in it.
void add_nodes(const fs::path& root, const fs::path& interface, std::vector<Node>& nodes) {
    constexpr std::size_t kNodesMax = 16;
    const auto add = [&](const std::string& name) {
        if (nodes.size() < kNodesMax) nodes.push_back(node_at(root / "dev" / name));
    };
    for (const std::string& name : names_in(interface)) {
        if (name.starts_with("ttyUSB")) add(name);
        if (name.find(':') != std::string::npos)
            for (const std::string& raw : names_in(interface / name / "hidraw")) add(raw);
    }
    for (const std::string& name : names_in(interface / "tty")) add(name);
}

const KnownDevice* known(const UsbDevice& d) {
    for (const KnownDevice& k : kKnownDevices) {
        const bool by_number =
            k.interface == 0 && k.vendor == d.vendor && (k.product == kAnyProduct || k.product == d.product);
        const bool by_class =
            k.interface != 0 && std::any_of(d.interfaces.begin(), d.interfaces.end(),
                                            [&](const UsbInterface& i) { return i.triple == k.interface; });
        if (by_number || by_class) return &k;
    }
    return nullptr;
}

void add_interface(const fs::path& root, const fs::path& at, UsbDevice& device) {
    std::uint32_t triple = 0, byte = 0;
    for (const char* const part : {"bInterfaceClass", "bInterfaceSubClass", "bInterfaceProtocol"}) {
        if (!number(text_of(at / part), 16, 0xFF, byte)) return;
        triple = triple << 8U | byte;
    }
    device.interfaces.push_back({triple, link_name(at / "driver")});
    add_nodes(root, at, device.nodes);
}

std::string chip_label(const fs::path& sys, const fs::path& node) {
    const int fd = ::open(node.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd >= 0) {
        gpiochip_info info{};
        const bool told = ioctl(fd, GPIO_GET_CHIPINFO_IOCTL, &info) == 0;
        ::close(fd);
        if (told) return plain(std::string(info.label, strnlen(info.label, sizeof info.label)));
    }
    std::error_code error;
    const fs::path parent = fs::canonical(sys, error).parent_path();
    const std::vector<std::string> older = error ? std::vector<std::string>() : names_in(parent / "gpio");
    return older.size() == 1 ? text_of(parent / "gpio" / older.front() / "label") : "";
}

}  // namespace

Bus<UsbDevice> usb_devices(const fs::path& root) {
    Bus<UsbDevice> bus;
    const fs::path folder = root / "sys/bus/usb/devices";
    std::vector<std::string> names;
    bus.visible = names_in(folder, names, bus.more);
    for (const std::string& name : names) {
        if (name.find(':') != std::string::npos) continue;
        UsbDevice d;
        std::uint32_t vendor = 0, product = 0, number_of_bus = 0, address = 0;
        const fs::path at = folder / name;
        if (!number(text_of(at / "idVendor"), 16, 0xFFFF, vendor) ||
            !number(text_of(at / "idProduct"), 16, 0xFFFF, product))
            continue;
        d.vendor = static_cast<std::uint16_t>(vendor);
        d.product = static_cast<std::uint16_t>(product);
        d.name = text_of(at / "product");
        d.maker = text_of(at / "manufacturer");
        d.serial = text_of(at / "serial");
        d.speed_mbit = text_of(at / "speed");
        if (number(text_of(at / "busnum"), 10, 999, number_of_bus) &&
            number(text_of(at / "devnum"), 10, 999, address)) {
            char path[32];
            static_cast<void>(
                std::snprintf(path, sizeof path, "dev/bus/usb/%03u/%03u", number_of_bus, address));
            d.node = node_at(root / path);
        }
        for (const std::string& other : names) {
            if (other.starts_with(name + ":")) add_interface(root, folder / other, d);
        }
        d.known = known(d);
        bus.entries.push_back(std::move(d));
    }
    return bus;
}

Bus<CanInterface> can_interfaces(const fs::path& root) {
    Bus<CanInterface> bus;
    std::vector<std::string> names;
    static_cast<void>(names_in(root / "sys/class/net", names, bus.more));
    for (const std::string& name : names) {
        const fs::path at = root / "sys/class/net" / name;
        std::uint32_t type = 0, flags = 0, mtu = 0;
        if (!number(text_of(at / "type"), 10, 65535, type) || type != ARPHRD_CAN) continue;
        std::string hex = text_of(at / "flags");
        if (hex.starts_with("0x")) hex.erase(0, 2);
        const bool up = number(hex, 16, 0xFFFFFFFF, flags) && (flags & 1U) != 0;
        const bool fd = number(text_of(at / "mtu"), 10, 65535, mtu) && mtu >= 72;
        bus.entries.push_back({plain(name), up, fd});
    }
    std::error_code error;
    bus.visible = !bus.entries.empty() || fs::exists(root / "proc/net/can", error);
    return bus;
}

Bus<GpioChip> gpio_chips(const fs::path& root) {
    Bus<GpioChip> bus;
    const fs::path folder = root / "sys/bus/gpio/devices";
    std::vector<std::string> names;
    bus.visible = names_in(folder, names, bus.more);
    for (const std::string& name : names) {
        if (!name.starts_with("gpiochip")) continue;
        const fs::path node = root / "dev" / name;
        bus.entries.push_back({plain(name), chip_label(folder / name, node), node_at(node)});
    }
    return bus;
}

Bus<Joystick> joysticks(const fs::path& root) {
    Bus<Joystick> bus;
    const fs::path folder = root / "sys/class/input";
    std::vector<std::string> names;
    bus.visible = names_in(folder, names, bus.more);
    for (const std::string& name : names) {
        if (!name.starts_with("js")) continue;
        const fs::path device = folder / name / "device";
        Joystick stick;
        stick.name = text_of(device / "name");
        for (const std::string& below : names_in(device))
            if (below.starts_with("event")) stick.node = node_at(root / "dev/input" / below);
        bus.entries.push_back(std::move(stick));
    }
    return bus;
}

Buses read_buses(const fs::path& root) {
    Buses b{usb_devices(root), can_interfaces(root), gpio_chips(root)};
    if (root == "/" && !b.can.visible) {
        // The files exist once a module is loaded; creating a socket makes the kernel load it.
        const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, 1);
        b.can.visible = fd >= 0;
        if (fd >= 0) ::close(fd);
    }
    return b;
}

}  // namespace tact::probe
