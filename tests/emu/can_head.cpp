#include "tests/emu/can_head.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/tracker/socket_can.hpp"

namespace tact::emu {

namespace {

constexpr Duration kPatience = std::chrono::milliseconds(20);
constexpr Duration kReopenEvery = std::chrono::milliseconds(500);

ifreq request(const std::string& interface) {
    ifreq r{};
    std::copy_n(interface.begin(), std::min(interface.size(), sizeof r.ifr_name - 1), r.ifr_name);
    return r;
}

int open_socket(const std::string& interface) {
    const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
    if (fd < 0) refuse_interface(CanStep::socket, interface, errno);
    const auto refuse = [&](CanStep step) {
        const int error = errno;
        ::close(fd);
        refuse_interface(step, interface, error);
    };
    ifreq r = request(interface);
    if (interface.empty() || interface.size() >= sizeof r.ifr_name || ioctl(fd, SIOCGIFINDEX, &r) != 0)
        refuse(CanStep::interface);
    const int on = 1;
    // Send only: received frames must not queue up.
    if (setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0 ||
        setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) != 0)
        refuse(CanStep::option);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = r.ifr_ifindex;
    if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) refuse(CanStep::bind);
    return fd;
}

}  // namespace

CanHead::CanHead(const SimHeadSettings& settings, std::string interface, Report& report)
    : interface_(std::move(interface)),
      report_(report),
      bus_(settings, clock_),
      fd_(open_socket(interface_)) {}

CanHead::~CanHead() {
    leave_.store(true);
    if (thread_.joinable()) thread_.join();
    if (fd_ >= 0) ::close(fd_);
}

void CanHead::start() {
    if (!thread_.joinable()) thread_ = std::thread([this] { live(); });
}

void CanHead::say(const char* what, const char* detail) noexcept {
    report_.say({Monotonic::now(), "tracker", interface_, what, detail}, {{"sent", sent_.load()}});
}

void CanHead::say_status() {
    report_.say({Monotonic::now(), "tracker", interface_, "status", ""},
                {{"sent", sent_.load()}, {"not_taken", not_taken_.load()}});
}

void CanHead::live() noexcept {
    std::array<CanFrame, kCanBatch> frames{};
    bus_.open();
    while (!leave_.load(std::memory_order_relaxed)) {
        const bool flood = flood_.load(std::memory_order_relaxed);
        const std::size_t room = flood ? kFloodBatch : frames.size();
        const CanBatch batch = bus_.receive(std::span(frames).first(room), kPatience);
        if (fd_ < 0 && clock_.now() >= retry_at_) reopen();
        for (std::size_t i = 0; i < batch.count; ++i) send(frames[i]);
        if (flood) clock_.wait_until(clock_.now() + kFloodEvery);
    }
}

void CanHead::send(const CanFrame& frame) noexcept {
    canfd_frame raw{};
    raw.can_id = frame.id | (frame.kind == CanKind::error ? CAN_ERR_FLAG : 0U);
    raw.len = frame.length;
    if (frame.kind == CanKind::fd) raw.flags = CANFD_BRS;
    std::copy_n(frame.data.begin(), std::min<std::size_t>(frame.length, sizeof raw.data), raw.data);
    const std::size_t size = frame.kind == CanKind::fd ? CANFD_MTU : CAN_MTU;
    const bool taken = ::write(fd_, &raw, size) == static_cast<ssize_t>(size);
    const int error = errno;
    (taken ? sent_ : not_taken_).fetch_add(1, std::memory_order_relaxed);
    if (taken || fd_ < 0 || (error != ENODEV && error != ENXIO)) return;
    ::close(std::exchange(fd_, -1));
    say("link", "gone");
}

void CanHead::reopen() noexcept {
    retry_at_ = clock_.now() + kReopenEvery;
    try {
        fd_ = open_socket(interface_);
        say("link", "found again");
    } catch (const std::exception&) {  // interface missing
    }
}

void CanHead::set_link(bool up) {
    const int any =
        socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);  // another socket, because the thread owns fd_
    ifreq r = request(interface_);
    bool done = ioctl(any, SIOCGIFFLAGS, &r) == 0;
    const int flags = up ? r.ifr_flags | IFF_UP : r.ifr_flags & ~IFF_UP;
    r.ifr_flags = static_cast<short>(flags);
    done = done && ioctl(any, SIOCSIFFLAGS, &r) == 0;
    const int error = errno;
    ::close(any);
    if (!done) refuse_interface(CanStep::state, interface_, error);
}

bool CanHead::apply(const Order& order) {
    if (row_of(order.action).part != Part::tracker) return false;
    if (order.action == Action::tracker_hold || order.action == Action::tracker_free) {
        if (order.action == Action::tracker_hold)
            bus_.hold(1e-3 * Vec3(order.numbers[0], order.numbers[1], order.numbers[2]));
        else
            bus_.let_go();
        say("sensor", row_of(order.action).words);
        return true;
    }
    flood_.store(order.action == Action::tracker_flood);
    switch (order.action) {
        case Action::link_down:
            set_link(false);
            break;
        case Action::link_up:
            set_link(true);
            break;
        case Action::tracker_silent:
            bus_.inject(TrackerFault::silent);
            break;
        case Action::tracker_corrupt:
            bus_.inject(TrackerFault::corrupt);
            break;
        case Action::tracker_nan:
            bus_.inject(TrackerFault::not_a_number);
            break;
        case Action::tracker_out_of_range:
            bus_.inject(TrackerFault::out_of_range);
            break;
        case Action::tracker_flood:
            bus_.inject(TrackerFault::flood);
            break;
        case Action::bus_off:
            bus_.inject(TrackerFault::bus_off);
            break;
        default:  // well
            bus_.inject(TrackerFault::none);
            break;
    }
    say("fault", row_of(order.action).words);
    return true;
}

}  // namespace tact::emu
