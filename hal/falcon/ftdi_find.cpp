#include "hal/falcon/ftdi_find.hpp"

#include <cstdio>
#include <vector>

namespace tact::falcon {

using phantom::BusFault;
using phantom::BusFinding;

ftdi::Piece ftdi::piece_of(std::span<const std::byte> packet) noexcept {
    constexpr std::byte kDamaged{0x1E};
    if (packet.size() < kStatusBytes || packet.size() > kPacketBytes) return {{}, true};
    const bool damaged = (packet[1] & kDamaged) != std::byte{0};
    return {damaged ? std::span<const std::byte>() : packet.subspan(kStatusBytes), damaged};
}

namespace {

bool is_falcon(libusb_device* device) noexcept {
    libusb_device_descriptor d{};
    return libusb_get_device_descriptor(device, &d) == 0 && d.idVendor == ftdi::kVendor &&
           d.idProduct == ftdi::kProduct;
}

// The first interface's bulk endpoints.
bool find_endpoints(libusb_device* device, unsigned char& in, unsigned char& out) noexcept {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_config_descriptor(device, 0, &config) != 0) return false;
    in = out = 0;
    if (config->bNumInterfaces > 0 && config->interface[0].num_altsetting > 0) {
        const libusb_interface_descriptor& d = config->interface[0].altsetting[0];
        for (int e = 0; e < d.bNumEndpoints; ++e) {
            if ((d.endpoint[e].bmAttributes & 3) != LIBUSB_TRANSFER_TYPE_BULK) continue;
            const unsigned char address = d.endpoint[e].bEndpointAddress;
            ((address & LIBUSB_ENDPOINT_IN) != 0 ? in : out) = address;
        }
    }
    libusb_free_config_descriptor(config);
    return in != 0 && out != 0;
}

std::string place(libusb_device* device) {
    char text[48];
    static_cast<void>(std::snprintf(text, sizeof text, "/dev/bus/usb/%03d/%03d",
                                    libusb_get_bus_number(device), libusb_get_device_address(device)));
    return text;
}

std::string serial_of(libusb_device* device, libusb_device_handle* handle) {
    libusb_device_descriptor d{};
    unsigned char text[64] = {};
    if (libusb_get_device_descriptor(device, &d) != 0 || d.iSerialNumber == 0) return {};
    const int n = libusb_get_string_descriptor_ascii(handle, d.iSerialNumber, text, sizeof text - 1);
    return n > 0 ? std::string(reinterpret_cast<const char*>(text), static_cast<std::size_t>(n))
                 : std::string();
}

}  // namespace

// Opens every candidate, since only an open device tells its serial.
FoundFtdi find_ftdi(libusb_context* context, const std::string& serial) {
    libusb_device** list = nullptr;
    const ssize_t n = libusb_get_device_list(context, &list);
    FoundFtdi it;
    BusFinding& found = it.finding;
    if (n < 0) {
        found = {BusFault::failed, {}, libusb_error_name(static_cast<int>(n))};
        return it;
    }
    std::string denied;
    std::vector<libusb_device_handle*> matching;
    for (ssize_t i = 0; i < n; ++i) {
        unsigned char in = 0, out = 0;
        libusb_device_handle* h = nullptr;
        if (!is_falcon(list[i]) || !find_endpoints(list[i], in, out)) continue;
        const int error = libusb_open(list[i], &h);
        if (error == LIBUSB_ERROR_ACCESS) denied = place(list[i]);
        if (error != 0) continue;
        const std::string its = serial_of(list[i], h);
        found.detail += (found.detail.empty() ? "" : ", ") + (its.empty() ? "(no serial)" : its);
        if (!serial.empty() && its != serial) {
            libusb_close(h);
            continue;
        }
        matching.push_back(h);
        found.serial = its;
        it.in = in;
        it.out = out;
    }
    libusb_free_device_list(list, 1);  // what is open keeps its device
    found.fault = matching.size() == 1 ? BusFault::none
                  : !matching.empty()  ? (serial.empty() ? BusFault::several : BusFault::twins)
                  : !denied.empty()    ? BusFault::denied
                                       : BusFault::missing;
    if (found.fault == BusFault::denied) found.detail = denied;
    if (found.fault == BusFault::none)
        it.handle = matching[0];
    else
        for (libusb_device_handle* const h : matching) libusb_close(h);
    return it;
}

}  // namespace tact::falcon
