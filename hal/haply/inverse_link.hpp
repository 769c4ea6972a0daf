// The WebSocket to the Inverse Service on this machine.
//
// Channel  what the pump needs of it; the tests put a service in memory in its place
// Errors   open() returns the reason; afterwards a broken, closed or too slow connection is `broken`
// Time     connecting and answering are bounded; nothing waits longer
// Thread   the one that opens, then the pump's
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hal/haply/ws_frames.hpp"
#include "ipc/base/clock.hpp"

namespace tact::haply {

class Channel {
public:
    virtual ~Channel() = default;
    [[nodiscard]] virtual std::string open() = 0;  // empty: connected
    virtual void close() noexcept = 0;
    [[nodiscard]] virtual bool send(std::string_view text) = 0;
    // The next text message; need_more: none within `patience`.
    [[nodiscard]] virtual ReadResult receive(std::string& text, Duration patience) = 0;
};

class InverseLink final : public Channel {
public:
    static constexpr Duration kOpenMax = std::chrono::seconds(2);

    explicit InverseLink(std::uint16_t port) : port_(port) {}
    ~InverseLink() override { close(); }
    InverseLink(const InverseLink&) = delete;
    InverseLink& operator=(const InverseLink&) = delete;

    [[nodiscard]] std::string open() override;
    void close() noexcept override;
    [[nodiscard]] bool send(std::string_view text) override;
    [[nodiscard]] ReadResult receive(std::string& text, Duration patience) override;

private:
    [[nodiscard]] bool send_frame(Opcode opcode, std::string_view payload);
    [[nodiscard]] bool write_all(std::string_view bytes, Instant end);
    // False: nothing came before `end`, or the connection is broken (open_ false).
    [[nodiscard]] bool read_some(std::string& bytes, Instant end);
    [[nodiscard]] bool wait(short events, Instant end) const;

    std::uint16_t port_;
    int socket_ = -1;
    bool open_ = false;
    std::uint32_t mask_ = 0x5A17C3E9U;
    FrameReader reader_;
    std::string out_, in_;
};

}  // namespace tact::haply
