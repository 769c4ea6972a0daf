// The TCP connection to an OpenIGTLink server. Asks for TDATA; a server that only sends TRANSFORM ignores that.
//
// Own socket   that of libopenigtlink blocks without a limit and cannot be given a small queue
// Queue        kQueueBytes at the receiver: a longer one would only hold older poses in a flood
// Errors       open(): StartupError: an unknown host, nobody listens, no answer within kConnectWithin
// Thread       one
#pragma once

#include <sys/socket.h>

#include <string>
#include <vector>

#include "hal/tracker/igtl_source.hpp"

namespace tact {

class IgtlSocket final : public IgtlSource {
public:
    static constexpr Duration kConnectWithin = std::chrono::seconds(2);
    static constexpr Duration kReconnectWithin = std::chrono::milliseconds(300);
    static constexpr int kQueueBytes = 64 * 1024;

    // period: least time between two TDATA, as the server is asked.
    IgtlSocket(std::string host, int port, Duration period);
    ~IgtlSocket() override;
    IgtlSocket(const IgtlSocket&) = delete;
    IgtlSocket& operator=(const IgtlSocket&) = delete;

    void open() override;
    // As open(), but returns the reason; "": connected. Throws nothing but std::bad_alloc.
    [[nodiscard]] std::string try_open();
    bool reopen() noexcept override;
    void close() noexcept override;
    IgtlBatch receive(std::span<std::byte> into, Duration patience) noexcept override;

private:
    [[nodiscard]] int connect_within(Duration patience) noexcept;  // 0 or errno

    std::string host_;
    int port_;
    std::vector<std::byte> greeting_;  // the request for TDATA
    sockaddr_storage address_{};       // of the host, as found by open()
    socklen_t address_bytes_ = 0;
    int fd_ = -1;
};

}  // namespace tact
