#include "hal/polhem/hidraw_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/polhem/reports.hpp"

namespace tact::polhem {

using usb::BusFault;
using usb::BusFinding;

namespace {

// Printable and at most 16 characters, to fit a packet of hal/phantom; "no serial" for a board without one.
std::string serial_of(const probe::UsbDevice& d) {
    return d.serial.empty() ? "no serial" : d.serial.substr(0, 16);
}

}  // namespace

BusFinding find_board(const probe::Bus<probe::UsbDevice>& usb, const std::string& serial, std::string& node) {
    std::string all;
    const probe::UsbDevice* found = nullptr;
    std::size_t fitting = 0;
    for (const probe::UsbDevice& d : usb.entries) {
        if (d.vendor != kVendor || d.product != kProduct) continue;
        all += (all.empty() ? "" : ", ") + serial_of(d);
        if (!serial.empty() && serial_of(d) != serial.substr(0, 16)) continue;
        found = &d;
        ++fitting;
    }
    if (found == nullptr)
        return {BusFault::missing, {}, usb.visible ? all : "nothing: this kernel reports no USB bus"};
    if (fitting > 1) return {serial.empty() ? BusFault::several : BusFault::twins, {}, all};
    for (const probe::Node& n : found->nodes) {
        if (n.path.find("hidraw") == std::string::npos) continue;
        node = n.path;
        return {BusFault::none, serial_of(*found), {}};
    }
    return {BusFault::not_ready, {}, "the board has no hidraw node yet"};
}

BusFinding HidrawPort::open(const std::string& serial) {
    if (root_.empty()) return {fd_ >= 0 ? BusFault::none : BusFault::missing, serial, {}};
    close();
    std::string node;
    BusFinding found = find_board(probe::usb_devices(root_), serial, node);
    if (found.fault != BusFault::none) return found;
    fd_ = ::open(node.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd_ >= 0) return found;
    found.fault = errno == EACCES || errno == EPERM ? BusFault::denied
                  : errno == EBUSY                  ? BusFault::busy
                  : errno == ENOENT                 ? BusFault::not_ready
                                                    : BusFault::failed;
    found.detail = node + ": " + std::strerror(errno);
    return found;
}

void HidrawPort::close() noexcept {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

int HidrawPort::read(std::span<std::byte> into, Duration patience) noexcept {
    const std::int64_t ns = std::max<std::int64_t>(patience.count(), 0);
    const timespec wait{ns / 1'000'000'000, ns % 1'000'000'000};
    if (fd_ < 0) {
        if (ns > 0) nanosleep(&wait, nullptr);
        return kPortGone;
    }
    pollfd ready{fd_, POLLIN, 0};
    const int n = ppoll(&ready, 1, &wait, nullptr);
    if (n < 0) return errno == EINTR ? 0 : kPortGone;
    if (n == 0) return 0;
    if ((ready.revents & POLLIN) == 0) return kPortGone;  // POLLERR, POLLHUP: unplugged
    const ssize_t size = ::read(fd_, into.data(), into.size());
    if (size > 0) return static_cast<int>(size);
    return size < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : kPortGone;
}

bool HidrawPort::write(std::span<const std::byte> report) noexcept {
    // The report number comes first: 0, as these reports have none.
    std::array<std::byte, 1 + kReportBytesMax> bytes{};
    const std::size_t size = std::min(report.size(), kReportBytesMax);
    std::copy_n(report.begin(), size, bytes.begin() + 1);
    return fd_ >= 0 && ::write(fd_, bytes.data(), size + 1) == static_cast<ssize_t>(size + 1);
}

}  // namespace tact::polhem
