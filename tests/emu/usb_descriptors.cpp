#include "tests/emu/usb_descriptors.hpp"

#include <linux/usb/ch9.h>
#include <linux/usb/functionfs.h>

#include <string_view>

namespace tact::emu {

namespace {

constexpr std::uint16_t kEnglish = 0x409;
constexpr std::string_view kInterfaceName = "Tact arm";

void put(std::vector<std::byte>& out, std::uint64_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFFU));
}

void put_speed(std::vector<std::byte>& out, std::uint8_t interval) {
    put(out, USB_DT_INTERFACE_SIZE, 1);
    put(out, USB_DT_INTERFACE, 1);
    put(out, 0, 1);  // interface number
    put(out, 0, 1);  // alternate setting
    put(out, 2, 1);  // endpoints
    put(out, kInterfaceClass, 1);
    put(out, kInterfaceSubclass, 1);
    put(out, kInterfaceProtocol, 1);
    put(out, 1, 1);  // string index
    for (const std::uint8_t address : {kEndpointIn, kEndpointOut}) {
        put(out, USB_DT_ENDPOINT_SIZE, 1);
        put(out, USB_DT_ENDPOINT, 1);
        put(out, address, 1);
        put(out, USB_ENDPOINT_XFER_INT, 1);
        put(out, kPacketBytesMax, 2);
        put(out, interval, 1);
    }
}

void put_head(std::vector<std::byte>& out, std::uint32_t magic, std::size_t length) {
    put(out, magic, 4);
    put(out, length, 4);
}

}  // namespace

std::uint8_t interval_of(std::uint16_t rate_hz) noexcept {
    if (rate_hz > 4000) return 1;
    if (rate_hz > 2000) return 2;
    return rate_hz > 1000 ? 3 : 4;
}

std::vector<std::byte> ffs_descriptors(std::uint16_t rate_hz) {
    std::vector<std::byte> body;
    put(body, FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC, 4);
    put(body, 3, 4);  // descriptors of full speed
    put(body, 3, 4);  // and of high speed
    put_speed(body, 1);
    put_speed(body, interval_of(rate_hz));
    std::vector<std::byte> out;
    put_head(out, FUNCTIONFS_DESCRIPTORS_MAGIC_V2, 8 + body.size());
    out.insert(out.end(), body.begin(), body.end());
    return out;
}

std::vector<std::byte> ffs_strings() {
    std::vector<std::byte> body;
    put(body, 1, 4);  // number of strings per language
    put(body, 1, 4);  // number of languages
    put(body, kEnglish, 2);
    for (const char c : kInterfaceName) put(body, static_cast<std::uint8_t>(c), 1);
    put(body, 0, 1);
    std::vector<std::byte> out;
    put_head(out, FUNCTIONFS_STRINGS_MAGIC, 8 + body.size());
    out.insert(out.end(), body.begin(), body.end());
    return out;
}

}  // namespace tact::emu
