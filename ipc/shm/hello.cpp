#include "ipc/shm/hello.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace tact {
namespace {

constexpr std::size_t kFilesSeen =
    8;  // descriptors of an oversized packet that are received, counted and closed

// All messages start alike: magic, then version.
template <class Message>
HelloCheck parse(std::span<const std::byte> bytes, std::uint64_t magic, Message& message) noexcept {
    if (bytes.size() != sizeof message) return HelloCheck::garbage;
    std::memcpy(&message, bytes.data(), sizeof message);
    if (message.magic != magic) return HelloCheck::garbage;
    if (message.version != kLinkVersion) return HelloCheck::other_version;
    for (const std::uint64_t word : message.reserved) {
        if (word != 0) return HelloCheck::garbage;
    }
    return HelloCheck::good;
}

}  // namespace

HelloCheck parse_hello(std::span<const std::byte> bytes, HelloMessage& hello) noexcept {
    const HelloCheck check = parse(bytes, kHelloMagic, hello);
    if (check == HelloCheck::good && hello.role > static_cast<std::uint32_t>(LinkRole::instructor))
        return HelloCheck::garbage;
    return check;
}

HelloCheck parse_answer(std::span<const std::byte> bytes, AnswerMessage& answer) noexcept {
    const HelloCheck check = parse(bytes, kAnswerMagic, answer);
    if (check == HelloCheck::good &&
        (answer.answer > static_cast<std::uint32_t>(LinkAnswer::other_version) || answer.reserved0 != 0))
        return HelloCheck::garbage;
    return check;
}

HelloCheck parse_order(std::span<const std::byte> bytes, OrderMessage& order) noexcept {
    const HelloCheck check = parse(bytes, kOrderMagic, order);
    if (check != HelloCheck::good) return check;
    if (order.order > static_cast<std::uint32_t>(LinkOrder::mark)) return HelloCheck::garbage;
    for (const double p : order.pos_model_m)
        if (!(p >= -1e3 && p <= 1e3)) return HelloCheck::garbage;
    return check;
}

Receipt receive_packet(int socket, Packet& packet) noexcept {
    packet.size = 0;
    packet.file = FileDescriptor();
    packet.second = FileDescriptor();
    packet.files_too_many = false;
    alignas(cmsghdr) char control[CMSG_SPACE(kFilesSeen * sizeof(int))];
    iovec data{packet.bytes, sizeof packet.bytes};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t got = recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (got < 0) return errno == EAGAIN || errno == EINTR ? Receipt::nothing_yet : Receipt::closed;
    packet.size = static_cast<std::size_t>(got);
    std::size_t files = 0;
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_RIGHTS) continue;
        const std::size_t count = (c->cmsg_len - CMSG_LEN(0)) / sizeof(int);
        for (std::size_t i = 0; i < count; ++i) {
            int fd = -1;
            std::memcpy(&fd, CMSG_DATA(c) + i * sizeof fd, sizeof fd);
            FileDescriptor file(fd);  // closes all but two
            ++files;
            if (files == 1)
                packet.file = std::move(file);
            else if (files == 2)
                packet.second = std::move(file);
        }
    }
    packet.files_too_many = files > 2 || (message.msg_flags & MSG_CTRUNC) != 0;
    // A sequenced packet without bytes and files means the end of the connection.
    return got == 0 && files == 0 ? Receipt::closed : Receipt::message;
}

bool send_packet(int socket, std::span<const std::byte> bytes, int file, int second) noexcept {
    const int files[] = {file, second};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof files)] = {};
    iovec data{const_cast<std::byte*>(bytes.data()), bytes.size()};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    if (file >= 0) {
        const std::size_t size = (second >= 0 ? 2 : 1) * sizeof(int);
        message.msg_control = control;
        message.msg_controllen = CMSG_SPACE(size);
        cmsghdr* const c = CMSG_FIRSTHDR(&message);
        c->cmsg_level = SOL_SOCKET;
        c->cmsg_type = SCM_RIGHTS;
        c->cmsg_len = CMSG_LEN(size);
        std::memcpy(CMSG_DATA(c), files, size);
    }
    return sendmsg(socket, &message, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

Peer peer_of(int socket) noexcept {
    ucred who{};
    socklen_t size = sizeof who;
    if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return {};
    return {static_cast<std::uint32_t>(who.pid), who.uid, who.uid == geteuid() || who.uid == 0};
}

bool peer_in_group(int socket, std::uint32_t group) noexcept {
    ucred who{};
    socklen_t size = sizeof who;
    if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return false;
    if (who.gid == group) return true;
    std::array<gid_t, 256> groups{};  // a process with more groups is refused (ERANGE)
    size = sizeof groups;
    if (getsockopt(socket, SOL_SOCKET, SO_PEERGROUPS, groups.data(), &size) != 0) return false;
    const gid_t* const begin = groups.data();
    const gid_t* const end = begin + size / sizeof(gid_t);
    return std::find(begin, end, group) != end;
}

}  // namespace tact
