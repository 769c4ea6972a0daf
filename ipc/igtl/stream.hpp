// Cuts a stream of bytes into OpenIGTLink messages, in a fixed memory.
//
// Large    a body above kIgtlBodyKept is skipped while it arrives, so that a server may also send images
// Lost     after a faulty header nothing more is found: close the connection and call restart()
// Thread   one; no allocation
#pragma once

#include "ipc/igtl/decode.hpp"

namespace tact {

inline constexpr std::size_t kIgtlBodyKept =
    std::size_t{16} * 1024;  // kIgtlPosesMax elements with ample metadata

class IgtlStream {
public:
    enum class Next : std::uint8_t {
        more,     // more bytes are needed
        message,  // `header` and `body`, which stays valid until room()
        skipped,  // `header` of a large message; its body will be skipped
        lost,     // `fault` tells the reason
    };

    // Memory for the next bytes, never empty; after writing n of them: add(n). Bytes beyond the room are ignored.
    [[nodiscard]] std::span<std::byte> room() noexcept;
    void add(std::size_t n) noexcept;
    Next next() noexcept;
    void restart() noexcept;

    IgtlHeader header;
    std::span<const std::byte> body;
    IgtlHeaderFault fault = IgtlHeaderFault::none;

private:
    std::array<std::byte, 2 * (kIgtlHeaderBytes + kIgtlBodyKept)> bytes_;
    std::size_t begin_ = 0, end_ = 0;  // of the bytes that are not read yet
    std::uint64_t skip_ = 0;           // bytes of a large body that are still to come
};

}  // namespace tact
