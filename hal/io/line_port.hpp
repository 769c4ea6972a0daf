// Where the safety lines end: an adapter, or an emulated one. Only a LineWorker talks to it.
#pragma once

#include <string>

#include "hal/io/line_logic.hpp"

namespace tact {

struct LinePortInfo {
    std::string name;
    std::uint8_t inputs = 0;   // LineInput that are fitted
    std::uint8_t outputs = 0;  // LineOutput that are fitted
};

class LinePort {
public:
    virtual ~LinePort() = default;
    virtual LinePortInfo open() = 0;          // outputs low; throws StartupError
    virtual bool reopen() noexcept = 0;       // after a loss: the same adapter, wherever it is now
    virtual LineReading read() noexcept = 0;  // not good: nothing of it counts
    virtual bool write(std::uint8_t outputs) noexcept = 0;  // all of them; true is no promise
    virtual void wait(Duration longest) noexcept = 0;       // until an edge, where the adapter tells of them
};

}  // namespace tact
