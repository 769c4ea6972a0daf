// An OpenIGTLink server that only sends: every client gets the same messages, and nothing that a client sends has an effect.
//
// Input     read, counted and discarded, at most kReadMost per client and period: the rest waits in the client's own queue
// Slow      a client that leaves more than kQueueMost unread is dropped
// Clients   at most kClientsMost; further ones are closed at once
// Own socket  that of libopenigtlink listens at every address of the machine, and blocks without a limit
// Errors    constructor: StartupError, with the fix
// Thread    one
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/igtl/stream.hpp"

namespace tact::launch {

struct IgtlServerCounts {
    std::uint64_t accepted = 0;       // clients so far
    std::uint64_t turned_away = 0;    // above kClientsMost
    std::uint64_t dropped = 0;        // because they read too slowly
    std::uint64_t bytes_ignored = 0;  // received
    std::uint64_t messages_ignored = 0;
    std::uint64_t garbage = 0;  // clients that sent something else than OpenIGTLink
};

class IgtlServer {
public:
    static constexpr std::size_t kClientsMost = 8, kAcceptsMost = 8;  // the latter per period
    static constexpr std::size_t kQueueMost = std::size_t{64} * 1024, kReadMost = kQueueMost;
    static constexpr int kKernelQueue = 64 * 1024;

    // port 0: any free port.
    IgtlServer(const std::string& address, int port);
    ~IgtlServer();
    IgtlServer(const IgtlServer&) = delete;
    IgtlServer& operator=(const IgtlServer&) = delete;

    // Accepts, reads and writes until `due`.
    void serve_until(Instant due);
    // Queues whole messages for every client and sends what the clients take at once.
    void send(std::span<const std::byte> messages);

    [[nodiscard]] int port() const { return port_; }
    [[nodiscard]] std::size_t clients() const { return clients_.size(); }
    [[nodiscard]] const IgtlServerCounts& counts() const { return counts_; }
    // What happened since the last call, for people; bounded.
    [[nodiscard]] std::vector<std::string> take_news();

private:
    struct Client;
    void accept_clients();
    void read_from(Client& client);
    void write_to(Client& client);
    void drop(Client& client, const std::string& why);
    void forget_gone();
    void news(std::string text);

    int fd_ = -1, port_ = 0;
    std::vector<std::unique_ptr<Client>> clients_;
    IgtlServerCounts counts_;
    std::size_t accepts_left_ = kAcceptsMost;
    std::vector<std::string> news_;
    std::size_t news_omitted_ = 0;
};

}  // namespace tact::launch
