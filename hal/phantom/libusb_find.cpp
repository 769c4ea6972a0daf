#include "hal/phantom/libusb_find.hpp"

#include <libusb.h>

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "hal/probe/known_devices.hpp"

namespace tact::phantom {

namespace {

bool find_interface(libusb_device* device, UsbBoard& board) {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_config_descriptor(device, 0, &config) != 0) return false;
    bool found = false;
    for (int i = 0; i < config->bNumInterfaces && !found; ++i) {
        if (config->interface[i].num_altsetting < 1) continue;
        const libusb_interface_descriptor& d = config->interface[i].altsetting[0];
        const std::uint32_t what = static_cast<std::uint32_t>(d.bInterfaceClass) << 16U |
                                   static_cast<std::uint32_t>(d.bInterfaceSubClass) << 8U |
                                   d.bInterfaceProtocol;
        if (what != probe::kPhantomInterface) continue;
        board = {d.bInterfaceNumber, 0, 0, {}};
        for (int e = 0; e < d.bNumEndpoints; ++e) {
            if ((d.endpoint[e].bmAttributes & 3) != LIBUSB_TRANSFER_TYPE_INTERRUPT) continue;
            const unsigned char address = d.endpoint[e].bEndpointAddress;
            ((address & LIBUSB_ENDPOINT_IN) != 0 ? board.in : board.out) = address;
        }
        found = board.in != 0 && board.out != 0;
    }
    libusb_free_config_descriptor(config);
    return found;
}

std::string place(libusb_device* device) {
    char text[48];
    std::snprintf(text, sizeof text, "/dev/bus/usb/%03d/%03d", libusb_get_bus_number(device),
                  libusb_get_device_address(device));
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

BusFinding find_board(libusb_context* context, const std::string& serial, UsbBoard& board,
                      libusb_device_handle*& handle) {
    libusb_device** list = nullptr;
    const ssize_t n = libusb_get_device_list(context, &list);
    if (n < 0) return {BusFault::failed, {}, libusb_error_name(static_cast<int>(n))};
    BusFinding found;
    std::string denied;
    bool slow = false;
    std::vector<std::pair<UsbBoard, libusb_device_handle*>> matching;
    for (ssize_t i = 0; i < n; ++i) {
        UsbBoard b;
        libusb_device_handle* h = nullptr;
        if (!find_interface(list[i], b)) continue;
        const int error = libusb_open(list[i], &h);
        if (error == LIBUSB_ERROR_ACCESS) denied = place(list[i]);
        if (error != 0) continue;
        b.serial = serial_of(list[i], h);
        found.detail += (found.detail.empty() ? "" : ", ") + (b.serial.empty() ? "(no serial)" : b.serial);
        if (!serial.empty() && b.serial != serial) {
            libusb_close(h);
            continue;
        }
        slow = slow || libusb_get_device_speed(list[i]) < LIBUSB_SPEED_HIGH;
        matching.emplace_back(b, h);
    }
    libusb_free_device_list(list, 1);  // what is open keeps its device
    found.fault = matching.size() == 1 ? (slow ? BusFault::slow : BusFault::none)
                  : !matching.empty()  ? (serial.empty() ? BusFault::several : BusFault::twins)
                  : !denied.empty()    ? BusFault::denied
                                       : BusFault::missing;
    if (found.fault == BusFault::denied) found.detail = denied;
    if (found.fault != BusFault::none) {
        for (const auto& [b, h] : matching) libusb_close(h);
        return found;
    }
    board = matching[0].first;
    handle = matching[0].second;
    found.serial = board.serial;
    return found;
}

}  // namespace tact::phantom
