// The port of the safety inputs: an adapter, or an emulated one. Used by a LineWorker only.
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
    virtual LinePortInfo open() = 0;                        // outputs low; throws StartupError
    virtual bool reopen() noexcept = 0;                     // after a loss: finds the same adapter again
    virtual LineReading read() noexcept = 0;                // not good: ignore all its bits
    virtual bool write(std::uint8_t outputs) noexcept = 0;  // all outputs; true is no guarantee
    virtual void wait(Duration longest) noexcept = 0;       // until an edge, where the adapter reports them
};

}  // namespace tact
