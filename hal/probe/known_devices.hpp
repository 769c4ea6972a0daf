// USB devices that Tact knows by their IDs: one table for `tact probe`, error texts and the udev rules; a
// test compares the rules with it.
#pragma once

#include <array>
#include <cstdint>

namespace tact::probe {

enum class Use : std::uint8_t { arm, lines, tracker_bus };

// Of a maker whose devices are all of one kind, with a number per model.
inline constexpr std::uint16_t kAnyProduct = 0;

// The Touch sold since 2023; its driver and its set-up differ from those of the serial model.
inline constexpr std::uint16_t kTouchHid = 0x0304;

struct KnownDevice {
    Use use;
    const char* driver;  // driver name in hal/registry.cpp; "": none yet
    const char* what;
    // 0, 0: identified by the class of an interface instead; product kAnyProduct: by the vendor alone
    std::uint16_t vendor = 0, product = 0;
    std::uint32_t interface = 0;  // class, subclass, protocol, one byte each
};

// The interface of an amplifier board in hal/phantom/PROTOCOL.md.
inline constexpr std::uint32_t kPhantomInterface = 0xFF5401;

inline constexpr std::array kKnownDevices{
    KnownDevice{Use::arm, "phantom-usb", "Phantom arm on an amplifier board", 0, 0, kPhantomInterface},
    KnownDevice{Use::arm, "polhem", "Haptikfabriken or Polhem arm", 0x16c0, 0x0486},
    KnownDevice{Use::arm, "openhaptics", "3D Systems Touch, serial model", 0x2988, 0x0302},
    KnownDevice{Use::arm, "openhaptics", "3D Systems Touch, HID model", 0x2988, kTouchHid},
    KnownDevice{Use::arm, "forcedimension", "Force Dimension arm", 0x1451, kAnyProduct},
    KnownDevice{Use::arm, "falcon", "Novint Falcon", 0x0403, 0xcb48},
    KnownDevice{Use::lines, "gpio", "CP2112, 8 lines", 0x10c4, 0xea90},
    KnownDevice{Use::lines, "gpio", "MCP2221A, 4 lines", 0x04d8, 0x00dd},
    KnownDevice{Use::lines, "gpio", "FT232H, 4 lines", 0x0403, 0x6014},
};

// Places searched for the library of Force Dimension's SDK: libdrd contains libdhd.
inline constexpr std::array kFdPlaces{"libdrd.so",
                                      "libdrd.so.3",
                                      "/usr/local/lib/libdrd.so",
                                      "/usr/lib/libdrd.so",
                                      "/usr/lib/x86_64-linux-gnu/libdrd.so",
                                      "/opt/forcedimension/lib/libdrd.so",
                                      "libdhd.so",
                                      "libdhd.so.3",
                                      "/usr/local/lib/libdhd.so",
                                      "/usr/lib/libdhd.so",
                                      "/usr/lib/x86_64-linux-gnu/libdhd.so"};

// Places searched for libHD.so: first the loader's own search (with LD_LIBRARY_PATH) by the names of its links.
inline constexpr std::array kHdPlaces{"libHD.so",
                                      "libHD.so.3",
                                      "/usr/lib/libHD.so",
                                      "/usr/lib64/libHD.so",
                                      "/usr/lib/x86_64-linux-gnu/libHD.so",
                                      "/usr/local/lib/libHD.so",
                                      "/opt/OpenHaptics/Developer/lib/libHD.so"};

}  // namespace tact::probe
