// One libusb context for each time the board is open: Debian's libusb lists devices anew only by udev's
// events or with a new context, and there is not always a udev.
#include "hal/phantom/libusb_bus.hpp"

#include <libusb.h>
#include <poll.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "hal/api/bus_wait.hpp"
#include "hal/phantom/libusb_find.hpp"

namespace tact::phantom {

namespace {

constexpr std::size_t kIn = 4;  // transfers that wait for a state
// One whole packet. A transfer ends with a packet that is shorter than the endpoint's largest, or when its memory
// is full: with more than this, states of full size would be glued together, eight of them in 512 bytes.
constexpr std::size_t kInBytes = 64;
constexpr std::array<unsigned char, kInBytes + 1> kTooLong{};  // stands for a packet that did not fit
constexpr std::size_t kEvents = 64;
constexpr unsigned kErrorsMax = 20;  // in a row: it is as good as gone
constexpr Duration kCloseMax = std::chrono::milliseconds(500);

class LibusbBus final : public UsbBus {
public:
    LibusbBus() = default;
    ~LibusbBus() override { close(); }
    LibusbBus(const LibusbBus&) = delete;
    LibusbBus& operator=(const LibusbBus&) = delete;

    BusFinding open(const std::string& serial) override;
    void close() noexcept override;
    std::size_t wait(std::span<BusEvent> events, Duration patience) noexcept override;
    bool send(std::span<const std::byte> packet) noexcept override;
    bool clear_stall() noexcept override;
    Instant now() noexcept override { return Monotonic::now(); }

private:
    struct In {
        LibusbBus* bus = nullptr;
        libusb_transfer* transfer = nullptr;
        bool busy = false;
        std::array<unsigned char, kInBytes> bytes{};
    };
    [[nodiscard]] BusFinding claim();
    void queue(In& in) noexcept;
    void push(BusEventKind kind, std::span<const unsigned char> bytes = {}) noexcept;
    void handle_now() noexcept;
    void learn_descriptors() noexcept;
    static void LIBUSB_CALL received(libusb_transfer* transfer) noexcept;
    static void LIBUSB_CALL was_sent(libusb_transfer* transfer) noexcept;

    libusb_context* context_ = nullptr;
    libusb_device_handle* handle_ = nullptr;
    UsbBoard board_;
    bool claimed_ = false, closing_ = false, stall_said_ = false, gone_ = false;
    unsigned errors_ = 0;  // in a row
    std::array<In, kIn> in_;
    libusb_transfer* out_ = nullptr;
    bool out_busy_ = false;
    std::array<unsigned char, 64> out_bytes_{};
    std::array<BusEvent, kEvents> events_{};
    std::size_t first_ = 0, count_ = 0;
    std::array<pollfd, 16> polled_{};
    nfds_t polled_count_ = 0;
};

BusFinding LibusbBus::claim() {
    static_cast<void>(libusb_set_auto_detach_kernel_driver(handle_, 1));
    const int error = libusb_claim_interface(handle_, board_.interface);
    if (error == 0) {
        claimed_ = true;
        return {BusFault::none, board_.serial, {}};
    }
    // Arrived before its configuration was set.
    const bool soon = error == LIBUSB_ERROR_NOT_FOUND || error == LIBUSB_ERROR_NO_DEVICE;
    const BusFault fault = soon                           ? BusFault::not_ready
                           : error == LIBUSB_ERROR_BUSY   ? BusFault::busy
                           : error == LIBUSB_ERROR_ACCESS ? BusFault::denied
                                                          : BusFault::failed;
    return {fault, {}, std::string("claiming its interface: ") + libusb_error_name(error)};
}

BusFinding LibusbBus::open(const std::string& serial) {
    close();
    if (context_ != nullptr) return {BusFault::failed, {}, "transfers of the last connection do not end"};
    if (const int error = libusb_init(&context_); error != 0) {
        context_ = nullptr;
        return {BusFault::failed, {}, std::string("starting libusb: ") + libusb_error_name(error)};
    }
    BusFinding found = find_board(context_, serial, board_, handle_);
    if (found.fault == BusFault::none) found = claim();
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
    learn_descriptors();
    for (In& in : in_) queue(in);
    if (gone_ || out_ == nullptr) {
        close();
        return {BusFault::not_ready, {}, "it went away while it was being opened"};
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

void LibusbBus::queue(In& in) noexcept {
    if (in.transfer == nullptr || closing_ || gone_) return;
    libusb_fill_interrupt_transfer(in.transfer, handle_, board_.in, in.bytes.data(),
                                   static_cast<int>(in.bytes.size()), &LibusbBus::received, &in, 0);
    in.busy = libusb_submit_transfer(in.transfer) == 0;
    if (!in.busy) push(BusEventKind::gone);
}

// The newest events stay: an old state is worth nothing.
void LibusbBus::push(BusEventKind kind, std::span<const unsigned char> bytes) noexcept {
    if (kind == BusEventKind::gone) {
        if (gone_) return;
        gone_ = true;
    }
    if (count_ == kEvents) {
        first_ = (first_ + 1) % kEvents;
        --count_;
    }
    BusEvent& e = events_[(first_ + count_++) % kEvents];
    e.kind = kind;
    e.at = Monotonic::now();
    e.size = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 65));
    std::memcpy(e.bytes.data(), bytes.data(), std::min(bytes.size(), e.bytes.size()));
}

void LIBUSB_CALL LibusbBus::received(libusb_transfer* transfer) noexcept {
    In& in = *static_cast<In*>(transfer->user_data);
    LibusbBus& bus = *in.bus;
    in.busy = false;
    switch (transfer->status) {
        case LIBUSB_TRANSFER_COMPLETED:
            bus.errors_ = 0;
            bus.push(BusEventKind::packet,
                     std::span(in.bytes).first(static_cast<std::size_t>(transfer->actual_length)));
            break;
        case LIBUSB_TRANSFER_OVERFLOW:
            if (++bus.errors_ > kErrorsMax) return bus.push(BusEventKind::gone);
            bus.push(BusEventKind::packet, kTooLong);
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
    switch (transfer->status) {
        case LIBUSB_TRANSFER_COMPLETED:
            return bus.push(BusEventKind::sent);
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
    libusb_fill_interrupt_transfer(out_, handle_, board_.out, out_bytes_.data(),
                                   static_cast<int>(packet.size()), &LibusbBus::was_sent, this, 0);
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
    if (libusb_clear_halt(handle_, board_.in) != 0 || libusb_clear_halt(handle_, board_.out) != 0)
        return false;
    for (In& in : in_) {
        if (!in.busy) queue(in);
    }
    return !gone_;
}

void LibusbBus::handle_now() noexcept {
    timeval none{};
    static_cast<void>(libusb_handle_events_timeout_completed(context_, &none, nullptr));
}

// ppoll instead of libusb's own wait, which rounds up to milliseconds.
std::size_t LibusbBus::wait(std::span<BusEvent> events, Duration patience) noexcept {
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
    if (busy()) return;  // the kernel still has the memory: it stays, and is tried again with the next open()
    for (In& in : in_) {
        libusb_free_transfer(in.transfer);
        in.transfer = nullptr;
    }
    libusb_free_transfer(out_);
    out_ = nullptr;
    if (handle_ != nullptr) {
        if (claimed_) static_cast<void>(libusb_release_interface(handle_, board_.interface));
        libusb_close(handle_);
    }
    handle_ = nullptr;
    claimed_ = false;
    libusb_exit(context_);
    context_ = nullptr;
}

}  // namespace

std::unique_ptr<UsbBus> make_libusb_bus() { return std::make_unique<LibusbBus>(); }

}  // namespace tact::phantom
