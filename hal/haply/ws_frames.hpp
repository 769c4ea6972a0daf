// The client's side of WebSocket (RFC 6455) as pure functions: handshake, frames, messages.
//
// Input    from a process that is not trusted: sizes are bounded before anything is stored
// Errors   `broken`: the connection must be closed; a reader stays broken
// Key      the one of the RFC's example, with its answer: the key only proves that the other side speaks
//          WebSocket, and no proxy stands between two processes of one machine
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tact::haply {

enum class Opcode : std::uint8_t { continuation = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };
enum class ReadResult : std::uint8_t { message, need_more, broken };

inline constexpr std::size_t kHandshakeMax = 4096;                   // bytes of the answer
inline constexpr std::size_t kMessageMax = std::size_t{256} * 1024;  // bytes of a message

[[nodiscard]] std::string handshake_request(std::string_view host, std::uint16_t port);
// `message`: accepted, and `used` bytes belong to the answer; the rest are frames.
[[nodiscard]] ReadResult check_handshake(std::string_view answer, std::size_t& used);

// Appends one whole message; a client masks its frames.
void append_frame(std::string& out, Opcode opcode, std::string_view payload, std::uint32_t mask);

class FrameReader {
public:
    // Appends received bytes. False: more than any message needs, and it is broken.
    bool feed(std::string_view bytes);
    // The next whole message; fragments are joined, control messages come between them.
    [[nodiscard]] ReadResult next(Opcode& opcode, std::string& payload);
    void clear();

private:
    [[nodiscard]] ReadResult broken();

    std::string buffer_, joined_;
    std::size_t at_ = 0;  // bytes of buffer_ already read
    Opcode joined_opcode_ = Opcode::continuation;
    bool broken_ = false;
};

}  // namespace tact::haply
