// Lists the connected devices from the kernel's files, without opening one and without a library.
//
// Root     of the tree to read: "/" except in tests
// Input    names and texts come from devices and are not trusted: every list, text and number is bounded,
//          and each non-printable character becomes '?'
// Visible  `visible` is false when the kernel shows no such bus at all: then the presence of devices is
//          unknown
// Thread   any; may be slow. Throws only when memory is exhausted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/probe/known_devices.hpp"

namespace tact::probe {

inline constexpr std::size_t kEntriesMax = 512;  // of a folder
inline constexpr std::size_t kTextMax = 120;

// A device node, with the calling user's access right and the owning group.
struct Node {
    std::string path;  // "" without a node
    bool usable = false;
    std::string group;  // "" if unknown
    unsigned mode = 0;  // rwxrwxrwx
};

struct UsbInterface {
    std::uint32_t triple = 0;  // class, subclass, protocol
    std::string kernel_driver;
};

struct UsbDevice {
    std::uint16_t vendor = 0, product = 0;
    std::string name, maker, serial;
    std::string speed_mbit;
    Node node;                // /dev/bus/usb/BUS/DEVICE
    std::vector<Node> nodes;  // hidraw and serial ports of it
    std::vector<UsbInterface> interfaces;
    const KnownDevice* known = nullptr;
};

struct CanInterface {
    std::string name;
    bool up = false;
    bool fd = false;  // its MTU allows CAN FD frames
};

struct GpioChip {
    std::string name, label;  // label "" if unknown
    Node node;
};

// A joystick or gamepad, also a SpaceMouse.
struct Joystick {
    std::string name;  // by the device
    Node node;         // /dev/input/eventN, which the window reads
};

template <class T>
struct Bus {
    bool visible = false;
    bool more = false;  // more than kEntriesMax: the rest is ignored
    std::vector<T> entries;
};

struct Buses {
    Bus<UsbDevice> usb;
    Bus<CanInterface> can;  // visible: the kernel can make CAN sockets
    Bus<GpioChip> gpio;
};

[[nodiscard]] Bus<UsbDevice> usb_devices(const std::filesystem::path& root);
[[nodiscard]] Bus<CanInterface> can_interfaces(const std::filesystem::path& root);
[[nodiscard]] Bus<GpioChip> gpio_chips(const std::filesystem::path& root);
// Not part of Buses, because no controller uses them. visible: the kernel shows input devices at all.
[[nodiscard]] Bus<Joystick> joysticks(const std::filesystem::path& root = "/");
[[nodiscard]] Buses read_buses(const std::filesystem::path& root = "/");

}  // namespace tact::probe
