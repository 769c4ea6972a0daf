// The USB serial converter in the Falcon (FTDI, full speed) as a bus of hal/usb; vendor requests configure
// the converter.
//
// Events   of kind `packet`: bytes of the line, at most 62, without the converter's two status bytes; bytes
//          reported as damaged become `receive_failed` and are not passed on
// Source   requests and status: the Linux kernel's ftdi_sio.h; settings for the Falcon: libnifalcon
// Thread   see usb::Bus; control() waits for the device, so never on the servo thread
#pragma once

#include <array>
#include <memory>

#include "hal/usb/bus.hpp"
#include "hal/usb/device_kind.hpp"

namespace tact::falcon {

namespace ftdi {

inline constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xcb48;
inline constexpr std::size_t kPacketBytes = 64, kStatusBytes = 2;
inline constexpr std::size_t kPieceBytes = kPacketBytes - kStatusBytes;

inline constexpr usb::VendorRequest kForgetIn{0, 1}, kForgetOut{0, 2};  // clear the converter's buffers
inline constexpr usb::VendorRequest kDtrLow{1, 0x0100}, kDtrHigh{1, 0x0101}, kRtsLow{1, 0x0200};
inline constexpr usb::VendorRequest kNoFlowControl{2, 0};
// The value divides 3 MHz; its two high bits add a fraction: 01 is a half.
inline constexpr usb::VendorRequest kBaud9600{3, 0x4138}, kBaud143k{3, 21}, kBaud1500k{3, 2};
inline constexpr usb::VendorRequest k8n1{4, 8};
inline constexpr usb::VendorRequest kLatency1ms{9, 1},
    kLatency16ms{9, 16};  // longest wait before a partly filled packet is sent

// For the Falcon's boot loader; DTR restarts it.
inline constexpr std::array kBootLine{kForgetIn,      kForgetOut, kLatency16ms, kBaud9600, k8n1,
                                      kNoFlowControl, kRtsLow,    kDtrLow,      kDtrHigh};
inline constexpr std::array kLoadLine{kDtrLow, kBaud143k};
inline constexpr std::array kRunLine{kLatency1ms, kBaud1500k, k8n1, kNoFlowControl, kForgetIn, kForgetOut};

[[nodiscard]] usb::Piece piece_of(std::span<const std::byte> packet) noexcept;

}  // namespace ftdi

// The bus of this computer.
[[nodiscard]] std::unique_ptr<usb::Bus> make_ftdi_bus();

}  // namespace tact::falcon
