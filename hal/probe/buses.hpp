// What devices there are, as the kernel's files tell it, without opening one and without a library.
//
// Root     of the tree that is read: "/" but in tests
// Hostile  names and texts come from devices: every list, text and number is bounded, and what is not
//          printable becomes '?'
// Honest   `visible` is false where the kernel shows no such bus at all: then nothing can be said about devices
// Thread   any; may be slow. Nothing here throws but for want of memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/probe/known_devices.hpp"

namespace tact::probe {

inline constexpr std::size_t kEntriesMax = 512;  // of a folder
inline constexpr std::size_t kTextMax = 120;

// Whether the calling user may read and write a node, and whose it is.
struct Node {
    std::string path;  // "" where there is none
    bool usable = false;
    std::string group;  // "" where it cannot be told
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
    bool fd = false;  // its MTU holds CAN FD frames
};

struct GpioChip {
    std::string name, label;  // label "" where it cannot be told
    Node node;
};

template <class T>
struct Bus {
    bool visible = false;
    bool more = false;  // than kEntriesMax: the rest was not looked at
    std::vector<T> there;
};

struct Buses {
    Bus<UsbDevice> usb;
    Bus<CanInterface> can;  // visible: the kernel can make CAN sockets
    Bus<GpioChip> gpio;
};

[[nodiscard]] Bus<UsbDevice> usb_devices(const std::filesystem::path& root);
[[nodiscard]] Bus<CanInterface> can_interfaces(const std::filesystem::path& root);
[[nodiscard]] Bus<GpioChip> gpio_chips(const std::filesystem::path& root);
[[nodiscard]] Buses read_buses(const std::filesystem::path& root = "/");

}  // namespace tact::probe
