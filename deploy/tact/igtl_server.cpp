#include "deploy/tact/igtl_server.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

constexpr std::size_t kNewsMost = 8;

std::string peer_text(const sockaddr_storage& address, socklen_t bytes) {
    char host[NI_MAXHOST], service[NI_MAXSERV];
    if (getnameinfo(reinterpret_cast<const sockaddr*>(&address), bytes, host, sizeof host, service,
                    sizeof service, NI_NUMERICHOST | NI_NUMERICSERV) != 0)
        return "a client";
    return std::string(host) + ":" + service;
}

void set_option(int fd, int level, int name, int value) { setsockopt(fd, level, name, &value, sizeof value); }

// A listening socket, or -1 with errno.
int listen_at(const addrinfo& a) {
    const int fd = socket(a.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0) return -1;
    set_option(fd, SOL_SOCKET, SO_REUSEADDR, 1);
    if (bind(fd, a.ai_addr, a.ai_addrlen) == 0 && listen(fd, 16) == 0) return fd;
    const int error = errno;
    ::close(fd);
    errno = error;
    return -1;
}

}  // namespace

struct IgtlServer::Client {
    Client(int descriptor, std::string peer) : fd(descriptor), name(std::move(peer)) {}
    ~Client() { ::close(fd); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    int fd;
    std::string name;
    std::vector<std::byte> queue;  // whole messages, of which `sent` bytes left already
    std::size_t sent = 0;
    IgtlStream stream;
    std::size_t read_left = kReadMost;
    bool gone = false;
};

IgtlServer::IgtlServer(const std::string& address, int port) {
    const std::string attempt = "listening at " + address + ":" + std::to_string(port);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE;
    addrinfo* found = nullptr;
    if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0 || found == nullptr)
        throw StartupError(attempt, "this is neither an address nor the name of a machine",
                           "give a --listen address of this machine, such as 127.0.0.1, or 0.0.0.0 for all");
    fd_ = listen_at(*found);
    const int error = errno;
    freeaddrinfo(found);
    if (fd_ < 0) {
        const bool ours = error != EADDRNOTAVAIL;
        throw StartupError(attempt,
                           error == EADDRINUSE ? "another program listens there"
                           : ours              ? std::system_category().message(error)
                                               : "the address is not of this machine",
                           ours ? "give another --port (0: any free one), or end the other program; ss -tlnp "
                                  "shows it"
                                : "give a --listen address of this machine; ip address lists them");
    }
    sockaddr_storage own{};
    socklen_t bytes = sizeof own;
    getsockname(fd_, reinterpret_cast<sockaddr*>(&own), &bytes);
    // The port is at the same place in both.
    port_ = ntohs(reinterpret_cast<const sockaddr_in*>(&own)->sin_port);
}

IgtlServer::~IgtlServer() { ::close(fd_); }

void IgtlServer::news(std::string text) {
    if (news_.size() < kNewsMost)
        news_.push_back(std::move(text));
    else
        ++news_omitted_;
}

std::vector<std::string> IgtlServer::take_news() {
    if (news_omitted_ > 0) news_.push_back(std::to_string(std::exchange(news_omitted_, 0)) + " more lines");
    return std::exchange(news_, {});
}

void IgtlServer::drop(Client& client, const std::string& why) {
    if (client.gone) return;
    client.gone = true;
    news(client.name + " " + why);
}

void IgtlServer::forget_gone() {
    std::erase_if(clients_, [](const auto& client) { return client->gone; });
}

void IgtlServer::accept_clients() {
    for (; accepts_left_ > 0; --accepts_left_) {
        sockaddr_storage address{};
        socklen_t bytes = sizeof address;
        const int fd =
            accept4(fd_, reinterpret_cast<sockaddr*>(&address), &bytes, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (fd < 0) return;
        if (clients_.size() >= kClientsMost) {
            ++counts_.turned_away;
            ::close(fd);
            continue;
        }
        set_option(fd, SOL_SOCKET, SO_SNDBUF, kKernelQueue);
        set_option(fd, SOL_SOCKET, SO_RCVBUF, kKernelQueue);
        set_option(fd, IPPROTO_TCP, TCP_NODELAY, 1);
        ++counts_.accepted;
        clients_.push_back(std::make_unique<Client>(fd, peer_text(address, bytes)));
        news(clients_.back()->name + " connected");
    }
}

void IgtlServer::read_from(Client& client) {
    while (client.read_left > 0 && !client.gone) {
        const std::span<std::byte> room = client.stream.room();
        const ssize_t n = recv(client.fd, room.data(), std::min(room.size(), client.read_left), MSG_DONTWAIT);
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
        if (n <= 0) return drop(client, "left");
        const auto bytes = static_cast<std::size_t>(n);
        client.read_left -= bytes;
        counts_.bytes_ignored += bytes;
        const bool garbage_before = client.stream.fault != IgtlHeaderFault::none;
        client.stream.add(bytes);
        for (auto next = client.stream.next(); next != IgtlStream::Next::more; next = client.stream.next()) {
            if (next == IgtlStream::Next::lost) {
                if (!garbage_before) ++counts_.garbage;
                break;
            }
            ++counts_.messages_ignored;
        }
    }
}

void IgtlServer::write_to(Client& client) {
    while (!client.gone && client.sent < client.queue.size()) {
        const ssize_t n = ::send(client.fd, client.queue.data() + client.sent,
                                 client.queue.size() - client.sent, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
        if (n < 0) return drop(client, "left");
        client.sent += static_cast<std::size_t>(n);
    }
    client.queue.clear();
    client.sent = 0;
}

void IgtlServer::send(std::span<const std::byte> messages) {
    for (const auto& client : clients_) {
        client->queue.erase(
            client->queue.begin(),
            client->queue.begin() + static_cast<std::ptrdiff_t>(std::exchange(client->sent, 0)));
        if (client->queue.size() + messages.size() > kQueueMost) {
            ++counts_.dropped;
            drop(*client, "reads too slowly and was dropped");
            continue;
        }
        client->queue.insert(client->queue.end(), messages.begin(), messages.end());
        write_to(*client);
    }
    forget_gone();
}

void IgtlServer::serve_until(Instant due) {
    accepts_left_ = kAcceptsMost;
    for (const auto& client : clients_) client->read_left = kReadMost;
    for (;;) {
        forget_gone();
        std::vector<pollfd> wait;
        wait.push_back({.fd = accepts_left_ > 0 ? fd_ : -1, .events = POLLIN, .revents = 0});
        for (const auto& client : clients_) {
            const int events =
                (client->read_left > 0 ? POLLIN : 0) | (client->sent < client->queue.size() ? POLLOUT : 0);
            // A closed or failed connection wakes poll() whatever is asked for, so one that may not be read is left out.
            wait.push_back(
                {.fd = events != 0 ? client->fd : -1, .events = static_cast<short>(events), .revents = 0});
        }
        const std::int64_t left_ns = (due - Monotonic::now()).count();
        if (left_ns <= 0) return;
        const timespec time{.tv_sec = left_ns / 1'000'000'000, .tv_nsec = left_ns % 1'000'000'000};
        if (ppoll(wait.data(), wait.size(), &time, nullptr) < 0 && errno != EINTR) return;
        for (std::size_t i = 1; i < wait.size(); ++i) {
            if ((wait[i].revents & POLLOUT) != 0) write_to(*clients_[i - 1]);
            if ((wait[i].revents & (POLLIN | POLLHUP | POLLERR)) != 0) read_from(*clients_[i - 1]);
        }
        if (wait[0].revents != 0) accept_clients();
    }
}

}  // namespace tact::launch
