#include "hal/haply/inverse_link.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "ipc/base/error.hpp"

namespace tact::haply {

namespace {

constexpr Duration kSendMax = std::chrono::milliseconds(20);
constexpr int kMessagesMax = 16;  // read in one call, so that a flood ends

}  // namespace

bool InverseLink::wait(short events, Instant end) const {
    while (true) {
        const Duration left = std::max(end - Monotonic::now(), Duration{0});
        const timespec patience{.tv_sec = left.count() / 1'000'000'000,
                                .tv_nsec = left.count() % 1'000'000'000};
        pollfd one{.fd = socket_, .events = events, .revents = 0};
        const int n = ::ppoll(&one, 1, &patience, nullptr);
        if (n > 0) return true;
        if (n == 0 || errno != EINTR) return false;
    }
}

bool InverseLink::write_all(std::string_view bytes, Instant end) {
    while (!bytes.empty()) {
        const ssize_t n = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (n > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(n));
        } else if (n < 0 && errno == EINTR) {
            continue;
        } else if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
            if (!wait(POLLOUT, end)) return false;
        } else {
            return false;
        }
    }
    return true;
}

bool InverseLink::read_some(std::string& bytes, Instant end) {
    std::array<char, 16384> part{};
    while (true) {
        const ssize_t n = ::recv(socket_, part.data(), part.size(), 0);
        if (n > 0) {
            bytes.assign(part.data(), static_cast<std::size_t>(n));
            return true;
        }
        if (n < 0 && errno == EINTR) continue;
        if (n == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) {
            open_ = false;
            return false;
        }
        if (!wait(POLLIN, end)) return false;
    }
}

std::string InverseLink::open() {
    close();
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0) return "no socket: " + last_error();
    const int on = 1;
    static_cast<void>(::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port_);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const Instant end = Monotonic::now() + kOpenMax;
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        if (errno != EINPROGRESS || !wait(POLLOUT, end)) return "no connection: " + last_error();
        int error = 0;
        socklen_t size = sizeof error;
        if (::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size) != 0 || error != 0) {
            errno = error;
            return "no connection: " + last_error();
        }
    }
    open_ = true;
    std::string answer;
    if (!write_all(handshake_request("127.0.0.1", port_), end)) return "the connection broke";
    while (true) {
        std::size_t used = 0;
        const ReadResult result = check_handshake(answer, used);
        if (result == ReadResult::broken) return "what answers there does not speak WebSocket";
        if (result == ReadResult::message) {
            static_cast<void>(reader_.feed(std::string_view(answer).substr(used)));
            return "";
        }
        if (!read_some(in_, end)) return open_ ? "no answer to the handshake" : "the connection broke";
        answer += in_;
    }
}

void InverseLink::close() noexcept {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
    open_ = false;
    reader_.clear();
}

bool InverseLink::send_frame(Opcode opcode, std::string_view payload) {
    if (!open_) return false;
    out_.clear();
    mask_ = mask_ * 1664525U + 1013904223U;
    append_frame(out_, opcode, payload, mask_);
    open_ = write_all(out_, Monotonic::now() + kSendMax);
    return open_;
}

bool InverseLink::send(std::string_view text) { return send_frame(Opcode::text, text); }

ReadResult InverseLink::receive(std::string& text, Duration patience) {
    const Instant end = Monotonic::now() + patience;
    for (int messages = 0; open_ && messages < kMessagesMax;) {
        Opcode opcode = Opcode::continuation;
        const ReadResult result = reader_.next(opcode, text);
        if (result == ReadResult::broken) break;
        if (result == ReadResult::need_more) {
            if (!read_some(in_, end)) {
                if (open_) return ReadResult::need_more;
                break;
            }
            if (!reader_.feed(in_)) break;
            continue;
        }
        ++messages;
        if (opcode == Opcode::text) return ReadResult::message;
        if (opcode == Opcode::close) break;
        if (opcode == Opcode::ping && !send_frame(Opcode::pong, text)) break;
    }
    open_ = false;
    return ReadResult::broken;
}

}  // namespace tact::haply
