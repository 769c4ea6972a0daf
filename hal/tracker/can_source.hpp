// Where the reader's frames come from: a SocketCAN interface, an emulated bus, or what a test makes up.
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
    gone,  // the interface vanished or fails: nothing comes any more until reopen()
};

struct CanBatch {
    std::size_t count = 0;  // frames given
    CanFault fault = CanFault::none;
    std::uint32_t dropped = 0;  // frames the kernel dropped since the last batch, for want of room
};

class CanSource {
public:
    virtual ~CanSource() = default;
    virtual void open() = 0;             // throws StartupError with the fix
    virtual bool reopen() noexcept = 0;  // after gone; true: it works again
    // Waits for `patience` at most until there is something, then gives what there is, kCanBatch at most and
    // no more than `into` holds.
    virtual CanBatch receive(std::span<CanFrame> into, Duration patience) noexcept = 0;
};

}  // namespace tact
