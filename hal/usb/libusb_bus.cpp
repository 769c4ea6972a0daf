// A new libusb context for each connection: Debian's libusb updates its device list only through udev
// events or with a new context, and udev is not always present.
#include "hal/usb/libusb_bus.hpp"

#include <libusb.h>
#include <poll.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "hal/api/bus_wait.hpp"
#include "hal/usb/event_queue.hpp"
#include "hal/usb/libusb_find.hpp"

namespace tact::usb {

namespace {

constexpr std::size_t kIn = 4;  // queued transfers
// One whole packet. A transfer ends with a packet shorter than the endpoint's maximum, or when its buffer
// is full: a larger buffer would merge states of full size, eight of them in 512 bytes.
constexpr std::size_t kInBytes = 64;
constexpr std::array<std::byte, kInBytes + 1> kTooLong{};  // placeholder for a packet that did not fit
constexpr std::size_t kEvents = 64;
constexpr unsigned kErrorsMax = 20;      // in a row: the device counts as disconnected
constexpr unsigned kControlMaxMs = 500;  // a present device answers within a millisecond
constexpr Duration kCloseMax = std::chrono::milliseconds(500);

class LibusbBus final : public Bus {
public:
    explicit LibusbBus(const DeviceKind& kind) : kind_(kind) {}
    ~LibusbBus() override { close(); }
    LibusbBus(const LibusbBus&) = delete;
    LibusbBus& operator=(const LibusbBus&) = delete;

    BusFinding open(const std::string& serial) override;
    void close() noexcept override;
    std::size_t wait(std::span<BusEvent> events, Duration patience) noexcept override;
    bool send(std::span<const std::byte> packet) noexcept override;
    bool clear_stall() noexcept override;
    bool control(const VendorRequest& request) noexcept override;
    Instant now() noexcept override { return Monotonic::now(); }

private:
    struct In {
        LibusbBus* bus = nullptr;
        libusb_transfer* transfer = nullptr;
        bool busy = false;
        std::array<unsigned char, kInBytes> bytes{};
    };
    [[nodiscard]] BusFinding claim(const BusFinding& found);
    void queue(In& in) noexcept;
    void push(BusEventKind kind, std::span<const std::byte> bytes = {}) noexcept;
    void push_transfer(std::span<const std::byte> bytes) noexcept;
    void fill(libusb_transfer* transfer, unsigned char address, std::span<unsigned char> bytes,
              libusb_transfer_cb_fn done, void* of) noexcept;
    void handle_now() noexcept;
    void learn_descriptors() noexcept;
    static void LIBUSB_CALL received(libusb_transfer* transfer) noexcept;
    static void LIBUSB_CALL was_sent(libusb_transfer* transfer) noexcept;

    libusb_context* context_ = nullptr;
    libusb_device_handle* handle_ = nullptr;
    DeviceKind kind_;
    FoundDevice device_;
    bool claimed_ = false, closing_ = false, stall_said_ = false, gone_ = false;
    unsigned errors_ = 0;  // in a row
    std::array<In, kIn> in_;
    libusb_transfer* out_ = nullptr;
    bool out_busy_ = false;
    std::array<unsigned char, 64> out_bytes_{};
    EventQueue<kEvents> events_;
    std::array<pollfd, 16> polled_{};
    nfds_t polled_count_ = 0;
};

BusFinding LibusbBus::claim(const BusFinding& found) {
    // The kernel may already have bound its own driver to the device.
    static_cast<void>(libusb_set_auto_detach_kernel_driver(handle_, 1));
    const int error = libusb_claim_interface(handle_, device_.interface);
    if (error == 0) {
        claimed_ = true;
        return {BusFault::none, found.serial, {}};
    }
    // The device was found before its configuration was set.
    const bool soon = error == LIBUSB_ERROR_NOT_FOUND || error == LIBUSB_ERROR_NO_DEVICE;
    const BusFault fault = soon                           ? BusFault::not_ready
                           : error == LIBUSB_ERROR_BUSY   ? BusFault::busy
                           : error == LIBUSB_ERROR_ACCESS ? BusFault::denied
                                                          : BusFault::failed;
    return {fault, {}, std::string("claiming its interface: ") + libusb_error_name(error)};
}

BusFinding LibusbBus::open(const std::string& serial) {
    close();
    if (context_ != nullptr)
        return {BusFault::failed, {}, "transfers of the last connection are still running"};
    if (const int error = libusb_init(&context_); error != 0) {
        context_ = nullptr;
        return {BusFault::failed, {}, std::string("starting libusb: ") + libusb_error_name(error)};
    }
    BusFinding found = find_device(context_, kind_, serial, device_);
    if (found.fault == BusFault::none) {
        handle_ = device_.handle;
        found = claim(found);
    }
    if (found.fault != BusFault::none) {
        close();
        return found;
    }
    errors_ = 0;
    gone_ = stall_said_ = false;
    events_.clear();
    out_ = libusb_alloc_transfer(0);
    for (In& in : in_) {
        in.bus = this;
        in.transfer = libusb_alloc_transfer(0);
    }
    learn_descriptors();
    for (In& in : in_) queue(in);
    if (gone_ || out_ == nullptr) {
        close();
        return {BusFault::not_ready, {}, "the device disappeared while it was being opened"};
    }
    return found;
}

void LibusbBus::learn_descriptors() noexcept {
    polled_count_ = 0;
    const libusb_pollfd** list = libusb_get_pollfds(context_);
    if (list == nullptr) return;
    for (std::size_t i = 0; list[i] != nullptr && polled_count_ < polled_.size(); ++i)
        polled_[polled_count_++] = {list[i]->fd, list[i]->events, 0};
    libusb_free_pollfds(list);
}

void LibusbBus::fill(libusb_transfer* transfer, unsigned char address, std::span<unsigned char> bytes,
                     libusb_transfer_cb_fn done, void* of) noexcept {
    const auto fill_transfer = kind_.bulk ? &libusb_fill_bulk_transfer : &libusb_fill_interrupt_transfer;
    fill_transfer(transfer, handle_, address, bytes.data(), static_cast<int>(bytes.size()), done, of, 0);
}

void LibusbBus::queue(In& in) noexcept {
    if (in.transfer == nullptr || closing_ || gone_) return;
    fill(in.transfer, device_.in, in.bytes, &LibusbBus::received, &in);
    in.busy = libusb_submit_transfer(in.transfer) == 0;
    if (!in.busy) push(BusEventKind::gone);
}

void LibusbBus::push(BusEventKind kind, std::span<const std::byte> bytes) noexcept {
    if (kind == BusEventKind::gone && std::exchange(gone_, true)) return;
    events_.push(kind, Monotonic::now(), bytes);
}

void LibusbBus::push_transfer(std::span<const std::byte> bytes) noexcept {
    if (kind_.unpack == nullptr) return push(BusEventKind::packet, bytes);
    const Piece piece = kind_.unpack(bytes);
    if (piece.damaged)
        push(BusEventKind::receive_failed);
    else if (!piece.bytes.empty())
        push(BusEventKind::packet, piece.bytes);
}

void LIBUSB_CALL LibusbBus::received(libusb_transfer* transfer) noexcept {
    In& in = *static_cast<In*>(transfer->user_data);
    LibusbBus& bus = *in.bus;
    in.busy = false;
    switch (transfer->status) {
        case LIBUSB_TRANSFER_COMPLETED:
            bus.errors_ = 0;
            bus.push_transfer(
                std::as_bytes(std::span(in.bytes)).first(static_cast<std::size_t>(transfer->actual_length)));
            break;
        case LIBUSB_TRANSFER_OVERFLOW:
            if (++bus.errors_ > kErrorsMax) return bus.push(BusEventKind::gone);
            bus.push_transfer(kTooLong);
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

void LIBUSB_CALL LibusbBus::was_sent(libusb_transfer* transfer) noexcept {
    LibusbBus& bus = *static_cast<LibusbBus*>(transfer->user_data);
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

bool LibusbBus::send(std::span<const std::byte> packet) noexcept {
    if (handle_ == nullptr || out_busy_ || gone_ || packet.size() > out_bytes_.size()) return false;
    std::memcpy(out_bytes_.data(), packet.data(), packet.size());
    fill(out_, device_.out, std::span(out_bytes_).first(packet.size()), &LibusbBus::was_sent, this);
    const int error = libusb_submit_transfer(out_);
    out_busy_ = error == 0;
    if (error == LIBUSB_ERROR_NO_DEVICE || (error != 0 && ++errors_ > kErrorsMax))
        push(BusEventKind::gone);
    else if (error != 0)
        push(BusEventKind::send_failed);
    return true;
}

bool LibusbBus::clear_stall() noexcept {
    if (handle_ == nullptr || gone_) return false;
    stall_said_ = false;
    if (libusb_clear_halt(handle_, device_.in) != 0 || libusb_clear_halt(handle_, device_.out) != 0)
        return false;
    for (In& in : in_) {
        if (!in.busy) queue(in);
    }
    return !gone_;
}

bool LibusbBus::control(const VendorRequest& request) noexcept {
    constexpr std::uint8_t kVendorOut = 0x40;
    return handle_ != nullptr && !gone_ &&
           libusb_control_transfer(handle_, kVendorOut, request.request, request.value, 0, nullptr, 0,
                                   kControlMaxMs) == 0;
}

void LibusbBus::handle_now() noexcept {
    timeval none{};
    static_cast<void>(libusb_handle_events_timeout_completed(context_, &none, nullptr));
}

// Uses ppoll instead of libusb's own wait, which rounds up to milliseconds.
std::size_t LibusbBus::wait(std::span<BusEvent> events, Duration patience) noexcept {
    if (handle_ == nullptr) {
        nap(patience);
        return 0;
    }
    if (events_.empty() && !events.empty()) {
        wait_for(std::span(polled_).first(polled_count_), patience);
        handle_now();
    }
    return events_.fetch(events);
}

void LibusbBus::close() noexcept {
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
    if (busy()) return;  // the kernel still uses the memory: keep it and retry at the next open()
    for (In& in : in_) libusb_free_transfer(std::exchange(in.transfer, nullptr));
    libusb_free_transfer(std::exchange(out_, nullptr));
    if (handle_ != nullptr) {
        if (claimed_) static_cast<void>(libusb_release_interface(handle_, device_.interface));
        libusb_close(std::exchange(handle_, nullptr));
    }
    claimed_ = false;
    libusb_exit(std::exchange(context_, nullptr));
}

}  // namespace

std::unique_ptr<Bus> make_libusb_bus(const DeviceKind& kind) { return std::make_unique<LibusbBus>(kind); }

}  // namespace tact::usb
