#include "hal/usb/libusb_find.hpp"

#include <libusb.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace tact::usb {

namespace {

std::uint32_t class_of(const libusb_interface_descriptor& d) noexcept {
    return static_cast<std::uint32_t>(d.bInterfaceClass) << 16U |
           static_cast<std::uint32_t>(d.bInterfaceSubClass) << 8U | d.bInterfaceProtocol;
}

bool has_numbers(libusb_device* device, const DeviceKind& kind) noexcept {
    if (kind.vendor == 0 && kind.product == 0) return true;
    libusb_device_descriptor d{};
    return libusb_get_device_descriptor(device, &d) == 0 && d.idVendor == kind.vendor &&
           d.idProduct == kind.product;
}

// An interface of the kind with one endpoint each way.
bool find_interface(libusb_device* device, const DeviceKind& kind, FoundDevice& found) noexcept {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_config_descriptor(device, 0, &config) != 0) return false;
    const auto wanted = kind.bulk ? LIBUSB_TRANSFER_TYPE_BULK : LIBUSB_TRANSFER_TYPE_INTERRUPT;
    const int interfaces =
        kind.interface == 0 ? std::min<int>(config->bNumInterfaces, 1) : config->bNumInterfaces;
    bool complete = false;
    for (int i = 0; i < interfaces && !complete; ++i) {
        if (config->interface[i].num_altsetting < 1) continue;
        const libusb_interface_descriptor& d = config->interface[i].altsetting[0];
        if (kind.interface != 0 && class_of(d) != kind.interface) continue;
        found = {nullptr, d.bInterfaceNumber, 0, 0};
        for (int e = 0; e < d.bNumEndpoints; ++e) {
            if ((d.endpoint[e].bmAttributes & 3) != wanted) continue;
            const unsigned char address = d.endpoint[e].bEndpointAddress;
            ((address & LIBUSB_ENDPOINT_IN) != 0 ? found.in : found.out) = address;
        }
        complete = found.in != 0 && found.out != 0;
    }
    libusb_free_config_descriptor(config);
    return complete;
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

BusFinding find_device(libusb_context* context, const DeviceKind& kind, const std::string& serial,
                       FoundDevice& device) {
    libusb_device** list = nullptr;
    const ssize_t n = libusb_get_device_list(context, &list);
    if (n < 0) return {BusFault::failed, {}, libusb_error_name(static_cast<int>(n))};
    BusFinding found;
    std::string denied;
    bool slow = false;
    std::vector<FoundDevice> matching;
    for (ssize_t i = 0; i < n; ++i) {
        FoundDevice d;
        if (!has_numbers(list[i], kind) || !find_interface(list[i], kind, d)) continue;
        const int error = libusb_open(list[i], &d.handle);
        if (error == LIBUSB_ERROR_ACCESS) denied = place(list[i]);
        if (error != 0) continue;
        const std::string its = serial_of(list[i], d.handle);
        found.detail += (found.detail.empty() ? "" : ", ") + (its.empty() ? "(no serial)" : its);
        if (!serial.empty() && its != serial) {
            libusb_close(d.handle);
            continue;
        }
        slow = slow || (kind.high_speed && libusb_get_device_speed(list[i]) < LIBUSB_SPEED_HIGH);
        found.serial = its;
        matching.push_back(d);
    }
    libusb_free_device_list(list, 1);  // each open handle keeps its device
    found.fault = matching.size() == 1 ? (slow ? BusFault::slow : BusFault::none)
                  : !matching.empty()  ? (serial.empty() ? BusFault::several : BusFault::twins)
                  : !denied.empty()    ? BusFault::denied
                                       : BusFault::missing;
    if (found.fault == BusFault::denied) found.detail = denied;
    if (found.fault == BusFault::none) {
        device = matching[0];
        return found;
    }
    found.serial.clear();
    for (const FoundDevice& d : matching) libusb_close(d.handle);
    return found;
}

}  // namespace tact::usb
