// A daemon like spacenavd on a Unix socket, which sends what a test wants, and a reader's environment that finds it.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>

#include "gui/base/scratch_folder.hpp"

namespace tact::test {

class FakeSpacenavd {
public:
    using Packet = std::array<std::int32_t, 8>;
    static constexpr std::int32_t kAskProtocol = 0x7faa5500, kAskType = 0x7faa2005;

    FakeSpacenavd() {
        ::setenv("SPNAV_SOCKET", path().c_str(), 1);
        start();
    }
    ~FakeSpacenavd() {
        stop();
        ::unsetenv("SPNAV_SOCKET");
    }
    FakeSpacenavd(const FakeSpacenavd&) = delete;
    FakeSpacenavd& operator=(const FakeSpacenavd&) = delete;

    [[nodiscard]] std::string path() const { return (folder_.path() / "spnav.sock").string(); }
    void start() {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path().c_str(), path().size());
        listens_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (::bind(listens_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            ::listen(listens_, 8) != 0)
            std::abort();
        timeval most{5, 0};
        ::setsockopt(listens_, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
    }
    // keeps_file: as a daemon that was killed.
    void stop(bool keeps_file = false) {
        leave();
        if (listens_ >= 0) ::close(listens_);
        listens_ = -1;
        if (!keeps_file) std::filesystem::remove(path());
    }
    // The reader's connection; those that end at once only ask whether the daemon is there. False: none came.
    bool meet() {
        for (int i = 0; i < 100; ++i) {
            leave();
            client_ = ::accept4(listens_, nullptr, nullptr, SOCK_CLOEXEC);
            if (client_ < 0) return false;
            timeval most{5, 0};
            ::setsockopt(client_, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
            std::int32_t asked = 0;
            if (::recv(client_, &asked, sizeof asked, MSG_WAITALL) != sizeof asked) continue;
            return (asked & ~0xff) == kAskProtocol;
        }
        return false;
    }
    // Protocol 1, and the answer to the question for the device. type < 0: no device.
    bool welcome(std::int32_t type) { return meet() && speak_protocol() && answer_type(type); }
    bool speak_protocol() {
        const std::int32_t protocol = kAskProtocol | 1;
        return send(&protocol, sizeof protocol);
    }
    bool answer_type(std::int32_t type) {
        Packet asked{};
        if (::recv(client_, asked.data(), sizeof asked, MSG_WAITALL) != sizeof asked || asked[0] != kAskType)
            return false;
        return send({kAskType, type < 0 ? 0 : type, 0, 0, 0, 0, 0, type < 0 ? -1 : 0});
    }
    bool send(const Packet& p) { return send(p.data(), sizeof p); }
    bool send(const void* bytes, std::size_t n) {
        return ::send(client_, bytes, n, MSG_NOSIGNAL) == static_cast<ssize_t>(n);
    }
    // As much as fits; how much that was. Never waits.
    std::size_t flood(const void* bytes, std::size_t n) {
        const ssize_t sent = ::send(client_, bytes, n, MSG_NOSIGNAL | MSG_DONTWAIT);
        return sent > 0 ? static_cast<std::size_t>(sent) : 0;
    }
    bool motion(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t rx = 0, std::int32_t ry = 0,
                std::int32_t rz = 0) {
        return send({0, x, y, z, rx, ry, rz, 16});
    }
    bool button(std::int32_t number, bool down) { return send({down ? 1 : 2, number, 0, 0, 0, 0, 0, 0}); }
    bool device(bool arrives) { return send({3, arrives ? 0 : 1, 0, 0, 0, 0, 0, 0}); }
    void leave() {
        if (client_ >= 0) ::close(client_);
        client_ = -1;
    }

private:
    ScratchFolder folder_;
    int listens_ = -1, client_ = -1;
};

}  // namespace tact::test
