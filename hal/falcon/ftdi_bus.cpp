// One libusb context for each time the device is open, as hal/phantom has it: libusb lists devices anew only
// then or with udev.
#include <libusb.h>
#include <poll.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "hal/api/bus_wait.hpp"
#include "hal/falcon/ftdi_find.hpp"

namespace tact::falcon {

using phantom::BusEvent;
using phantom::BusEventKind;
using phantom::BusFault;
using phantom::BusFinding;

namespace {

constexpr std::size_t kIn = 4;  // transfers that wait
constexpr std::size_t kEvents = 64;
constexpr unsigned kErrorsMax = 20;      // in a row: it is as good as gone
constexpr unsigned kControlMaxMs = 500;  // the converter answers within a millisecond, or is gone
constexpr Duration kCloseMax = std::chrono::milliseconds(500);

class LibusbFtdi final : public FtdiBus {
public:
    LibusbFtdi() = default;
    ~LibusbFtdi() override { close(); }
    LibusbFtdi(const LibusbFtdi&) = delete;
    LibusbFtdi& operator=(const LibusbFtdi&) = delete;

    BusFinding open(const std::string& serial) override;
    void close() noexcept override;
    std::size_t wait(std::span<BusEvent> events, Duration patience) noexcept override;
    bool send(std::span<const std::byte> packet) noexcept override;
    bool clear_stall() noexcept override;
    bool control(const FtdiRequest& request) noexcept override;
    Instant now() noexcept override { return Monotonic::now(); }

private:
    struct In {
        LibusbFtdi* bus = nullptr;
        libusb_transfer* transfer = nullptr;
        bool busy = false;
        std::array<unsigned char, ftdi::kPacketBytes> bytes{};
    };
    [[nodiscard]] BusFinding claim(BusFinding found);
    void queue(In& in) noexcept;
    void handle_now() noexcept;
    void push(BusEventKind kind, std::span<const std::byte> bytes = {}) noexcept;
    void came(const In& in, int size) noexcept;
    static void LIBUSB_CALL received(libusb_transfer* transfer) noexcept;
    static void LIBUSB_CALL was_sent(libusb_transfer* transfer) noexcept;

    libusb_context* context_ = nullptr;
    libusb_device_handle* handle_ = nullptr;
    unsigned char in_address_ = 0, out_address_ = 0;
    bool claimed_ = false, closing_ = false, stall_said_ = false, gone_ = false;
    unsigned errors_ = 0;  // in a row
    std::array<In, kIn> in_;
    libusb_transfer* out_ = nullptr;
    bool out_busy_ = false;
    std::array<unsigned char, ftdi::kPacketBytes> out_bytes_{};
    std::array<BusEvent, kEvents> events_{};
    std::size_t first_ = 0, count_ = 0;
    std::array<pollfd, 16> polled_{};
    nfds_t polled_count_ = 0;
};

BusFinding LibusbFtdi::claim(BusFinding found) {
    // The kernel's own driver for such converters has it by then.
    static_cast<void>(libusb_set_auto_detach_kernel_driver(handle_, 1));
    const int error = libusb_claim_interface(handle_, 0);
    claimed_ = error == 0;
    if (claimed_) return found;
    const bool soon = error == LIBUSB_ERROR_NOT_FOUND || error == LIBUSB_ERROR_NO_DEVICE;
    const BusFault fault = soon                           ? BusFault::not_ready
                           : error == LIBUSB_ERROR_BUSY   ? BusFault::busy
                           : error == LIBUSB_ERROR_ACCESS ? BusFault::denied
                                                          : BusFault::failed;
    return {fault, {}, std::string("claiming its interface: ") + libusb_error_name(error)};
}

BusFinding LibusbFtdi::open(const std::string& serial) {
    close();
    if (context_ != nullptr) return {BusFault::failed, {}, "transfers of the last connection do not end"};
    if (const int error = libusb_init(&context_); error != 0) {
        context_ = nullptr;
        return {BusFault::failed, {}, std::string("starting libusb: ") + libusb_error_name(error)};
    }
    FoundFtdi it = find_ftdi(context_, serial);
    handle_ = it.handle;
    in_address_ = it.in;
    out_address_ = it.out;
    BusFinding found = std::move(it.finding);
    if (found.fault == BusFault::none) found = claim(std::move(found));
    if (found.fault != BusFault::none) {
        close();
        return found;
    }
    errors_ = 0;
    gone_ = stall_said_ = false;
    first_ = count_ = 0;
    out_ = libusb_alloc_transfer(0);
    for (In& in : in_) {
        in.bus = this;
        in.transfer = libusb_alloc_transfer(0);
    }
    polled_count_ = 0;
    if (const libusb_pollfd** const fds = libusb_get_pollfds(context_); fds != nullptr) {
        for (std::size_t i = 0; fds[i] != nullptr && polled_count_ < polled_.size(); ++i)
            polled_[polled_count_++] = {fds[i]->fd, fds[i]->events, 0};
        libusb_free_pollfds(fds);
    }
    for (In& in : in_) queue(in);
    if (gone_ || out_ == nullptr) {
        close();
        return {BusFault::not_ready, {}, "it went away while it was being opened"};
    }
    return found;
}

void LibusbFtdi::queue(In& in) noexcept {
    if (in.transfer == nullptr || closing_ || gone_) return;
    libusb_fill_bulk_transfer(in.transfer, handle_, in_address_, in.bytes.data(),
                              static_cast<int>(in.bytes.size()), &LibusbFtdi::received, &in, 0);
    in.busy = libusb_submit_transfer(in.transfer) == 0;
    if (!in.busy) push(BusEventKind::gone);
}

// The newest events stay: an old reply is worth nothing.
void LibusbFtdi::push(BusEventKind kind, std::span<const std::byte> bytes) noexcept {
    if (kind == BusEventKind::gone && std::exchange(gone_, true)) return;
    if (count_ == kEvents) {
        first_ = (first_ + 1) % kEvents;
        --count_;
    }
    BusEvent& e = events_[(first_ + count_++) % kEvents];
    e.kind = kind;
    e.at = Monotonic::now();
    e.size = static_cast<std::uint8_t>(std::min(bytes.size(), e.bytes.size()));
    std::copy_n(bytes.begin(), e.size, e.bytes.begin());
}

// The converter sends its status every few milliseconds, mostly with nothing behind it.
void LibusbFtdi::came(const In& in, int size) noexcept {
    const auto bytes = std::as_bytes(std::span(in.bytes).first(static_cast<std::size_t>(size)));
    const ftdi::Piece piece = ftdi::piece_of(bytes);
    if (piece.damaged)
        push(BusEventKind::receive_failed);
    else if (!piece.bytes.empty())
        push(BusEventKind::packet, piece.bytes);
}

void LIBUSB_CALL LibusbFtdi::received(libusb_transfer* transfer) noexcept {
    In& in = *static_cast<In*>(transfer->user_data);
    LibusbFtdi& bus = *in.bus;
    in.busy = false;
    switch (transfer->status) {
        case LIBUSB_TRANSFER_COMPLETED:
            bus.errors_ = 0;
            bus.came(in, transfer->actual_length);
            break;
        case LIBUSB_TRANSFER_CANCELLED:
            return;
        case LIBUSB_TRANSFER_NO_DEVICE:
            return bus.push(BusEventKind::gone);
        case LIBUSB_TRANSFER_STALL:
            if (!std::exchange(bus.stall_said_, true)) bus.push(BusEventKind::stalled);
            return;
        default:
            if (++bus.errors_ > kErrorsMax) return bus.push(BusEventKind::gone);
            bus.push(BusEventKind::receive_failed);
    }
    bus.queue(in);
}

void LIBUSB_CALL LibusbFtdi::was_sent(libusb_transfer* transfer) noexcept {
    LibusbFtdi& bus = *static_cast<LibusbFtdi*>(transfer->user_data);
    bus.out_busy_ = false;
    const bool whole = transfer->actual_length == transfer->length;
    switch (transfer->status) {
        case LIBUSB_TRANSFER_COMPLETED:
            return bus.push(whole ? BusEventKind::sent : BusEventKind::send_failed);
        case LIBUSB_TRANSFER_NO_DEVICE:
            return bus.push(BusEventKind::gone);
        case LIBUSB_TRANSFER_STALL:
            bus.push(BusEventKind::send_failed);
            if (!std::exchange(bus.stall_said_, true)) bus.push(BusEventKind::stalled);
            return;
        default:
            return bus.push(++bus.errors_ > kErrorsMax ? BusEventKind::gone : BusEventKind::send_failed);
    }
}

bool LibusbFtdi::send(std::span<const std::byte> packet) noexcept {
    if (handle_ == nullptr || out_busy_ || gone_ || packet.size() > out_bytes_.size()) return false;
    std::memcpy(out_bytes_.data(), packet.data(), packet.size());
    libusb_fill_bulk_transfer(out_, handle_, out_address_, out_bytes_.data(), static_cast<int>(packet.size()),
                              &LibusbFtdi::was_sent, this, 0);
    const int error = libusb_submit_transfer(out_);
    out_busy_ = error == 0;
    if (error == LIBUSB_ERROR_NO_DEVICE || (error != 0 && ++errors_ > kErrorsMax))
        push(BusEventKind::gone);
    else if (error != 0)
        push(BusEventKind::send_failed);
    return true;
}

bool LibusbFtdi::clear_stall() noexcept {
    if (handle_ == nullptr || gone_) return false;
    stall_said_ = false;
    if (libusb_clear_halt(handle_, in_address_) != 0 || libusb_clear_halt(handle_, out_address_) != 0)
        return false;
    for (In& in : in_) {
        if (!in.busy) queue(in);
    }
    return !gone_;
}

bool LibusbFtdi::control(const FtdiRequest& request) noexcept {
    constexpr std::uint8_t kVendorOut = 0x40;
    constexpr std::uint16_t kOnlyPort = 0;
    return handle_ != nullptr && !gone_ &&
           libusb_control_transfer(handle_, kVendorOut, request.request, request.value, kOnlyPort, nullptr, 0,
                                   kControlMaxMs) == 0;
}

void LibusbFtdi::handle_now() noexcept {
    timeval none{};
    static_cast<void>(libusb_handle_events_timeout_completed(context_, &none, nullptr));
}

// ppoll instead of libusb's own wait, which rounds up to milliseconds.
std::size_t LibusbFtdi::wait(std::span<BusEvent> events, Duration patience) noexcept {
    if (handle_ == nullptr) {
        nap(patience);
        return 0;
    }
    if (count_ == 0 && !events.empty()) {
        wait_for(std::span(polled_).first(polled_count_), patience);
        handle_now();
    }
    const std::size_t n = std::min(count_, events.size());
    for (std::size_t i = 0; i < n; ++i) events[i] = events_[(first_ + i) % kEvents];
    first_ = (first_ + n) % kEvents;
    count_ -= n;
    return n;
}

void LibusbFtdi::close() noexcept {
    if (context_ == nullptr) return;
    closing_ = true;
    const auto busy = [this] {
        return out_busy_ || std::any_of(in_.begin(), in_.end(), [](const In& in) { return in.busy; });
    };
    for (In& in : in_) {
        if (in.busy) static_cast<void>(libusb_cancel_transfer(in.transfer));
    }
    if (out_busy_) static_cast<void>(libusb_cancel_transfer(out_));
    const Instant end = Monotonic::now() + kCloseMax;
    while (busy() && Monotonic::now() < end) {
        handle_now();
        if (busy()) nap(kBusNap);
    }
    closing_ = false;
    if (busy()) return;  // the kernel still has the memory: it stays, and is tried again with the next open()
    for (In& in : in_) libusb_free_transfer(std::exchange(in.transfer, nullptr));
    libusb_free_transfer(std::exchange(out_, nullptr));
    if (handle_ != nullptr) {
        if (claimed_) static_cast<void>(libusb_release_interface(handle_, 0));
        libusb_close(std::exchange(handle_, nullptr));
    }
    claimed_ = false;
    libusb_exit(std::exchange(context_, nullptr));
}

}  // namespace

std::unique_ptr<FtdiBus> make_ftdi_bus() { return std::make_unique<LibusbFtdi>(); }

}  // namespace tact::falcon
