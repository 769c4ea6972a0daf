#include "hal/tracker/igtl_socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/api/bus_wait.hpp"
#include "ipc/base/error.hpp"
#include "ipc/igtl/encode.hpp"

namespace tact {

IgtlSocket::IgtlSocket(std::string host, int port, Duration period) : host_(std::move(host)), port_(port) {
    append_start_tdata(greeting_, static_cast<int>(period / std::chrono::milliseconds(1)));
}

IgtlSocket::~IgtlSocket() { close(); }

void IgtlSocket::close() noexcept {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

std::string IgtlSocket::try_open() {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int error = getaddrinfo(host_.c_str(), std::to_string(port_).c_str(), &hints, &found);
        error != 0 || found == nullptr)
        return std::string("the host is not known: ") + gai_strerror(error);
    // The first address that answers; "localhost" often has one of IPv6 on which nobody listens.
    int error = 0;
    bool connected = false;
    for (const addrinfo* a = found; a != nullptr && !connected; a = a->ai_next) {
        address_bytes_ = std::min<socklen_t>(a->ai_addrlen, sizeof address_);
        std::memcpy(&address_, a->ai_addr, address_bytes_);
        error = connect_within(kConnectWithin);
        connected = error == 0;
    }
    freeaddrinfo(found);
    if (connected) return "";
    return error == ECONNREFUSED ? "no OpenIGTLink server listens there"
                                 : std::system_category().message(error);
}

void IgtlSocket::open() {
    const std::string problem = try_open();
    if (!problem.empty())
        throw StartupError("head tracker at " + host_ + ":" + std::to_string(port_), problem,
                           "start the server, set tracker.host and tracker.port, or set tracker.driver = "
                           "\"none\"; tact probe shows what a server sends");
}

bool IgtlSocket::reopen() noexcept { return connect_within(kReconnectWithin) == 0; }

int IgtlSocket::connect_within(Duration patience) noexcept {
    close();
    fd_ = socket(address_.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd_ < 0) return errno;
    const int queue = kQueueBytes, on = 1;
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &queue, sizeof queue);
    setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    setsockopt(fd_, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    int error = ::connect(fd_, reinterpret_cast<const sockaddr*>(&address_), address_bytes_) == 0 ? 0 : errno;
    if (error == EINPROGRESS) {
        pollfd wait{.fd = fd_, .events = POLLOUT, .revents = 0};
        const timespec time = to_timespec(patience);
        socklen_t size = sizeof error;
        if (ppoll(&wait, 1, &time, nullptr) <= 0)
            error = ETIMEDOUT;
        else if (getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size) != 0)
            error = errno;
    }
    // A port of this machine that nobody listens on can be the one that the socket itself was given.
    sockaddr_storage own{};
    socklen_t own_bytes = sizeof own;
    if (error == 0 && getsockname(fd_, reinterpret_cast<sockaddr*>(&own), &own_bytes) == 0 &&
        own_bytes == address_bytes_ && std::memcmp(&own, &address_, own_bytes) == 0)
        error = ECONNREFUSED;
    // The queue of a new connection has room for the request.
    if (error == 0 && send(fd_, greeting_.data(), greeting_.size(), MSG_NOSIGNAL) < 0) error = errno;
    if (error != 0) close();
    return error;
}

IgtlBatch IgtlSocket::receive(std::span<std::byte> into, Duration patience) noexcept {
    if (fd_ < 0) return {.bytes = 0, .gone = true};
    if (patience > Duration{0}) {
        pollfd wait{.fd = fd_, .events = POLLIN, .revents = 0};
        wait_for(std::span(&wait, 1), patience);
    }
    const ssize_t n = recv(fd_, into.data(), into.size(), MSG_DONTWAIT);
    if (n > 0) return {.bytes = static_cast<std::size_t>(n), .gone = false};
    const bool waiting = n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
    return {.bytes = 0, .gone = !waiting};
}

}  // namespace tact
