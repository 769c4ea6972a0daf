// Source of the bytes of an OpenIGTLink tracker: a TCP connection, or a test.
#pragma once

#include <cstddef>
#include <span>

#include "ipc/base/clock.hpp"

namespace tact {

struct IgtlBatch {
    std::size_t bytes = 0;  // received
    bool gone = false;      // the connection ended: no bytes until reopen()
};

class IgtlSource {
public:
    virtual ~IgtlSource() = default;
    virtual void open() = 0;  // throws StartupError with the fix
    virtual bool
    reopen() noexcept = 0;  // after gone or close(); true: connected again. Blocks for a bounded time
    virtual void close() noexcept = 0;
    // Waits at most `patience` for a byte, then returns what is available and fits.
    virtual IgtlBatch receive(std::span<std::byte> into, Duration patience) noexcept = 0;
};

}  // namespace tact
