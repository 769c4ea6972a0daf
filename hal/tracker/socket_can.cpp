#include "hal/tracker/socket_can.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

// The kernel charges about 800 bytes per CAN frame and doubles the requested size: about 300 frames, one
// round of the reader. A longer queue would only hold older frames in a flood.
constexpr int kQueueBytes = 128 * 1024;

// Closes the descriptor unless ownership was taken.
class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const noexcept { return fd_; }
    [[nodiscard]] int take() noexcept { return std::exchange(fd_, -1); }

private:
    int fd_;
};

ifreq request(const std::string& interface) {
    ifreq r{};
    std::copy_n(interface.begin(), std::min(interface.size(), sizeof r.ifr_name - 1), r.ifr_name);
    return r;
}

int open_socket(const std::string& interface, const FixSettings& settings) {
    Descriptor fd(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW));
    if (fd.get() < 0) refuse_interface(CanStep::socket, interface, errno);
    ifreq r = request(interface);
    if (interface.empty() || interface.size() >= sizeof r.ifr_name)
        refuse_interface(CanStep::interface, interface, ENODEV);
    if (ioctl(fd.get(), SIOCGIFINDEX, &r) != 0) refuse_interface(CanStep::interface, interface, errno);
    const int index = r.ifr_ifindex;
    r = request(interface);
    if (ioctl(fd.get(), SIOCGIFHWADDR, &r) != 0 || r.ifr_hwaddr.sa_family != ARPHRD_CAN)
        refuse_interface(CanStep::type, interface, errno);
    r = request(interface);
    if (ioctl(fd.get(), SIOCGIFFLAGS, &r) != 0 || (r.ifr_flags & IFF_UP) == 0)
        refuse_interface(CanStep::state, interface, errno);
    r = request(interface);
    const bool fd_frames = settings.format == CanFormat::fd;
    if (fd_frames && (ioctl(fd.get(), SIOCGIFMTU, &r) != 0 || r.ifr_mtu < static_cast<int>(CANFD_MTU)))
        refuse_interface(CanStep::mtu, interface, errno);

    const int on = 1, queue = kQueueBytes;
    const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL;
    const std::vector<can_filter> filters = tracker_filters(settings.format, settings.sensors);
    const auto set = [&fd](int level, int name, const void* value, std::size_t size) {
        return setsockopt(fd.get(), level, name, value, static_cast<socklen_t>(size)) == 0;
    };
    if (!set(SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), filters.size() * sizeof(can_filter)) ||
        !set(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) ||
        (fd_frames && !set(SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on)) ||
        !set(SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on) || !set(SOL_SOCKET, SO_RCVBUF, &queue, sizeof queue))
        refuse_interface(CanStep::option, interface, errno);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = index;
    if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        refuse_interface(CanStep::bind, interface, errno);
    return fd.take();
}

CanFrame from_raw(const canfd_frame& raw, std::size_t bytes) noexcept {
    CanFrame f;
    f.id = raw.can_id & CAN_EFF_MASK;
    const bool whole =
        bytes == CAN_MTU ? raw.len <= CAN_MAX_DLEN : bytes == CANFD_MTU && raw.len <= CANFD_MAX_DLEN;
    if (!whole || (raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0) return f;
    f.length = raw.len;
    std::copy_n(raw.data, raw.len, f.data.begin());
    f.kind = (raw.can_id & CAN_ERR_FLAG) != 0 ? CanKind::error
             : bytes == CANFD_MTU             ? CanKind::fd
                                              : CanKind::classic;
    return f;
}

std::uint32_t dropped_in(const msghdr& message, std::uint32_t before) noexcept {
    for (const cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr;
         c = CMSG_NXTHDR(const_cast<msghdr*>(&message), const_cast<cmsghdr*>(c))) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SO_RXQ_OVFL) continue;
        std::uint32_t total = 0;
        std::memcpy(&total, CMSG_DATA(c), sizeof total);
        return total;
    }
    return before;  // the kernel sends none before the first drop
}

}  // namespace

std::vector<can_filter> tracker_filters(CanFormat format, unsigned sensors) {
    // All bits of the identifier and both flags must match, so extended and remote frames fail.
    constexpr canid_t kAll = CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK;
    std::vector<can_filter> filters;
    const auto pass = [&filters](std::uint32_t id) { filters.push_back({id, kAll}); };
    if (format == CanFormat::classic) pass(kSyncId);
    for (unsigned s = 0; s < sensors; ++s) {
        if (format == CanFormat::fd) {
            pass(kPoseId + s);
        } else {
            pass(kPosId + s);
            pass(kQuatId + s);
        }
    }
    return filters;
}

void refuse_interface(CanStep step, const std::string& interface, int error) {
    const std::string what = "CAN interface \"" + interface + "\" of the tracker";
    const std::string reason = std::strerror(error);
    const std::string set_up = "ip link set " + interface + " up type can bitrate 1000000";
    switch (step) {
        case CanStep::socket:
            if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT)
                throw StartupError(what, "this kernel has no CAN", "run as root: modprobe can_raw");
            throw StartupError(what, "the kernel refused a CAN socket: " + reason,
                               error == EPERM || error == EACCES
                                   ? "allow AF_CAN: RestrictAddressFamilies= of the "
                                     "service, or the container's network (use the host's)"
                                   : "close other programs that use CAN sockets");
        case CanStep::interface:
            throw StartupError(
                what, "no such interface exists",
                "plug in the adapter, or set tracker.interface to an existing one; ip -br link lists them");
        case CanStep::type:
            throw StartupError(what, "this is not a CAN interface",
                               "set tracker.interface to one listed by: ip -br link show type can");
        case CanStep::state:
            throw StartupError(what, "the interface is down", "run as root: " + set_up);
        case CanStep::mtu:
            throw StartupError(what, "the interface does not support CAN FD",
                               "set it down, then run as root: " + set_up +
                                   " dbitrate 5000000 fd on; or set tracker.format = \"classic\"");
        case CanStep::option:
            throw StartupError(what, "the kernel refused a socket option: " + reason,
                               "use kernel 5.4 or newer");
        case CanStep::bind:
            break;
    }
    throw StartupError(what, "binding a socket failed: " + reason, "run as root: " + set_up);
}

SocketCan::SocketCan(std::string interface, const FixSettings& settings)
    : interface_(std::move(interface)), settings_(settings) {}

SocketCan::SocketCan(int fd) : fd_(fd) {}

SocketCan::~SocketCan() { close(); }

void SocketCan::close() noexcept {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

void SocketCan::open() {
    if (interface_.empty() && fd_ >= 0) return;
    close();
    fd_ = open_socket(interface_, settings_);
    dropped_ = 0;
}

bool SocketCan::reopen() noexcept {
    if (interface_.empty()) return false;
    try {
        open();
        return true;
    } catch (const std::exception&) {
        return false;  // still absent: the reader tries again
    }
}

CanBatch SocketCan::fault(int error, CanBatch batch) noexcept {
    if (error == EAGAIN || error == EINTR) return batch;
    batch.fault = error == ENETDOWN ? CanFault::down : CanFault::gone;
    if (batch.fault == CanFault::gone) close();
    return batch;
}

CanBatch SocketCan::receive(std::span<CanFrame> into, Duration patience) noexcept {
    CanBatch batch;
    if (fd_ < 0) {
        batch.fault = CanFault::gone;
        return batch;
    }
    if (patience > Duration{0}) {
        pollfd ready{fd_, POLLIN, 0};
        const timespec wait{static_cast<time_t>(patience.count() / 1'000'000'000),
                            static_cast<long>(patience.count() % 1'000'000'000)};
        if (ppoll(&ready, 1, &wait, nullptr) <= 0) return batch;
    }
    const std::size_t room = std::min(into.size(), kCanBatch);
    for (std::size_t i = 0; i < room; ++i) {
        parts_[i] = {&raw_[i], sizeof raw_[i]};
        messages_[i] = {};
        messages_[i].msg_hdr.msg_iov = &parts_[i];
        messages_[i].msg_hdr.msg_iovlen = 1;
        messages_[i].msg_hdr.msg_control = controls_[i].bytes.data();
        messages_[i].msg_hdr.msg_controllen = controls_[i].bytes.size();
    }
    const int n = recvmmsg(fd_, messages_.data(), static_cast<unsigned>(room), MSG_DONTWAIT, nullptr);
    if (n < 0) return fault(errno, batch);
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
        // A CAN socket gives no empty message: size 0 means the end of a stream socket.
        if (messages_[i].msg_len == 0) return fault(ENODEV, batch);
        const bool cut = (messages_[i].msg_hdr.msg_flags & MSG_TRUNC) != 0;
        into[batch.count++] = from_raw(raw_[i], cut ? 0 : messages_[i].msg_len);
        const std::uint32_t dropped = dropped_in(messages_[i].msg_hdr, dropped_);
        batch.dropped += dropped - dropped_;
        dropped_ = dropped;
    }
    return batch;
}

}  // namespace tact
