// The messages of a link: the client's hello, the controller's answer, and orders of an instructor. Fixed size, plain data.
//
// Input    untrusted: parse_hello(), parse_answer() and parse_order() take any bytes and accept only fields in range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "ipc/shm/region.hpp"

namespace tact {

// A recorder writes every cycle to a file; a flight recorder keeps the last half minute. An instructor watches, and may stop
// the run and mark places.
enum class LinkRole : std::uint32_t { observer, gui, recorder, flight, instructor };
enum class LinkOrder : std::uint32_t { stop, mark };
enum class LinkAnswer : std::uint32_t {
    attached,  // as requested; comes with the region's file, and the bone region's file if there is one
    watching,  // requested as gui, but another one is attached: same files; its region may be used later
    full,      // too many clients
    other_user,
    other_version,
};

inline constexpr std::uint64_t kHelloMagic = 0x314F4C4C45485441ULL;
inline constexpr std::uint64_t kAnswerMagic = 0x3152535741485441ULL;
inline constexpr std::uint64_t kOrderMagic = 0x3152445241485441ULL;
inline constexpr std::uint32_t kLinkVersion = 4;  // 4: instructors

struct HelloMessage {
    std::uint64_t magic;
    std::uint32_t version;
    std::uint32_t role;         // LinkRole
    std::uint64_t reserved[6];  // zero
};
struct AnswerMessage {
    std::uint64_t magic;
    std::uint32_t version;
    std::uint32_t answer;       // LinkAnswer
    std::uint32_t gui_pid;      // of the attached visual process; 0: none
    std::uint32_t reserved0;    // zero
    std::uint64_t reserved[5];  // zero
};
struct OrderMessage {
    std::uint64_t magic;
    std::uint32_t version;
    std::uint32_t order;        // LinkOrder
    double pos_model_m[3];      // mark
    std::uint64_t reserved[3];  // zero
};
static_assert(std::is_trivially_copyable_v<OrderMessage> && sizeof(OrderMessage) == 64);
static_assert(std::is_trivially_copyable_v<HelloMessage> && sizeof(HelloMessage) == 64);
static_assert(std::is_trivially_copyable_v<AnswerMessage> && sizeof(AnswerMessage) == 64);

enum class HelloCheck : std::uint8_t { good, garbage, other_version };
[[nodiscard]] HelloCheck parse_hello(std::span<const std::byte> bytes, HelloMessage& hello) noexcept;
[[nodiscard]] HelloCheck parse_answer(std::span<const std::byte> bytes, AnswerMessage& answer) noexcept;
// Good: also a place within a kilometre.
[[nodiscard]] HelloCheck parse_order(std::span<const std::byte> bytes, OrderMessage& order) noexcept;

// One packet with at most two files. Both functions never block.
enum class Receipt : std::uint8_t { message, nothing_yet, closed };
struct Packet {
    std::byte bytes[65];  // one more than a message, to detect longer ones
    std::size_t size = 0;
    FileDescriptor file, second;  // not valid(): no file
    bool files_too_many = false;
};
[[nodiscard]] Receipt receive_packet(int socket, Packet& packet) noexcept;
// file -1: none; `second` needs a valid `file`.
[[nodiscard]] bool send_packet(int socket, std::span<const std::byte> bytes, int file,
                               int second = -1) noexcept;

struct Peer {
    std::uint32_t pid = 0;
    std::uint32_t uid = 0;
    bool trusted = false;  // this user, or root
};
[[nodiscard]] Peer peer_of(int socket) noexcept;
// True for its own or a supplementary group at the time of its connect().
[[nodiscard]] bool peer_in_group(int socket, std::uint32_t group) noexcept;

}  // namespace tact
