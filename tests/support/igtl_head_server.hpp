// An OpenIGTLink server on a loopback port that sends an emulated head, as TDATA, and fails as told.
//
// Faults   bus_off: bytes that are no OpenIGTLink; down, gone: it closes the connection and does not listen
// Thread   its own; inject(), accepted() and heard() on any
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <utility>

#include "hal/sim/sim_head_bus.hpp"
#include "ipc/igtl/encode.hpp"
#include "ipc/igtl/stream.hpp"

namespace tact {

class IgtlHeadServer {
public:
    static constexpr const char* kNames[] = {"HeadToTracker", "StylusToTracker"};

    explicit IgtlHeadServer(const SimHeadSettings& settings)
        : head_(settings), period_(static_cast<std::int64_t>(1e9 / settings.can.rate_hz)) {
        listen_again();
        thread_ = std::thread([this] { live(); });
    }
    ~IgtlHeadServer() {
        leave_ = true;
        thread_.join();
        shut(client_);
        shut(listener_);
    }
    IgtlHeadServer(const IgtlHeadServer&) = delete;
    IgtlHeadServer& operator=(const IgtlHeadServer&) = delete;

    [[nodiscard]] int port() const { return port_; }
    [[nodiscard]] const SimHead& head() const { return head_; }
    void inject(TrackerFault fault) { fault_ = fault; }
    [[nodiscard]] int accepted() const { return accepted_; }
    [[nodiscard]] int asked() const { return asked_; }  // requests for TDATA

private:
    static void shut(int& fd) {
        if (fd >= 0) ::close(std::exchange(fd, -1));
    }
    void listen_again() {
        listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        const int on = 1;
        setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        a.sin_port = htons(static_cast<std::uint16_t>(port_));
        socklen_t size = sizeof a;
        if (bind(listener_, reinterpret_cast<sockaddr*>(&a), size) != 0 || listen(listener_, 4) != 0 ||
            getsockname(listener_, reinterpret_cast<sockaddr*>(&a), &size) != 0)
            throw std::runtime_error("listening");
        port_ = ntohs(a.sin_port);
    }
    void accept_one() {
        const int fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (fd < 0) return;
        shut(client_);
        client_ = fd;
        const int queue = 16 * 1024, on = 1;
        setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &queue, sizeof queue);
        setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        const timeval patience{.tv_sec = 0, .tv_usec = 200'000};
        setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        stream_.restart();
        ++accepted_;
    }
    void hear() {
        const auto room = stream_.room();
        const ssize_t n = recv(client_, room.data(), room.size(), MSG_DONTWAIT);
        if (n == 0) return shut(client_);
        if (n > 0) stream_.add(static_cast<std::size_t>(n));
        while (stream_.next() == IgtlStream::Next::message)
            if (stream_.header.type.view() == "STT_TDATA") ++asked_;
    }
    void say(const IgtlBytes& bytes) {
        if (client_ < 0) return;
        if (send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size()))
            shut(client_);
    }
    void live() {
        Instant due = Monotonic::now();
        while (!leave_) {
            const TrackerFault fault = fault_;
            const bool away = fault == TrackerFault::down || fault == TrackerFault::gone;
            if (away) {
                shut(client_);
                shut(listener_);
            } else if (listener_ < 0) {
                listen_again();
            }
            if (listener_ >= 0) accept_one();
            if (client_ >= 0) hear();
            if (client_ >= 0 && fault != TrackerFault::silent) tell(fault, due + period_);
            due += period_;
            std::this_thread::sleep_until(std::chrono::steady_clock::now() + (due - Monotonic::now()));
        }
    }
    void tell(TrackerFault fault, Instant until) {
        IgtlBytes bytes;
        const Instant now = Monotonic::now();
        IgtlNamedPose poses[] = {{kNames[0], head_.at(0, now)}, {kNames[1], head_.at(1, now)}};
        for (IgtlNamedPose& p : poses) {
            if (fault == TrackerFault::not_a_number) p.T.p_m.x() = std::nan("");
            if (fault == TrackerFault::out_of_range) p.T.p_m.x() += 10.0;
        }
        timespec utc{};
        clock_gettime(CLOCK_REALTIME, &utc);
        append_tdata(bytes, "Tracker", poses, std::int64_t{utc.tv_sec} * 1'000'000'000 + utc.tv_nsec);
        if (fault == TrackerFault::corrupt) bytes.back() ^= std::byte{1};
        if (fault == TrackerFault::bus_off) bytes.assign(500, std::byte{0x5A});
        say(bytes);
        if (fault != TrackerFault::flood) return;
        const IgtlBytes one = bytes;
        for (int i = 0; i < 63; ++i) bytes.insert(bytes.end(), one.begin(), one.end());
        while (client_ >= 0 && Monotonic::now() < until) say(bytes);
    }

    SimHead head_;
    Duration period_;
    int listener_ = -1, client_ = -1, port_ = 0;
    IgtlStream stream_;
    std::atomic<TrackerFault> fault_{TrackerFault::none};
    std::atomic<int> accepted_{0}, asked_{0};
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
