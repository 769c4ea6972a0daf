// Source of the reader's frames: a SocketCAN interface, an emulated bus, or a test.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/tracker/can_frame.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

inline constexpr std::size_t kCanBatch = 64;

enum class CanFault : std::uint8_t {
    none,
    down,  // the interface was taken down; the source stays usable
    gone,  // the interface vanished or fails: no frames until reopen()
};

struct CanBatch {
    std::size_t count = 0;  // frames received
    CanFault fault = CanFault::none;
    std::uint32_t dropped = 0;  // frames dropped by the kernel since the last batch: queue full
};

class CanSource {
public:
    virtual ~CanSource() = default;
    virtual void open() = 0;             // throws StartupError with the fix
    virtual bool reopen() noexcept = 0;  // after gone; true: usable again
    // Waits at most `patience` for a frame, then returns the available ones, at most kCanBatch and no more
    // than fit in `into`.
    virtual CanBatch receive(std::span<CanFrame> into, Duration patience) noexcept = 0;
};

}  // namespace tact
