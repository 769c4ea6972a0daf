// Connects the servo's seqlocks with an adapter: reads, evaluates, drives.
//
// Order    read, evaluate, drive, publish: a stop lowers the enable line before the servo receives it
// Watchdog toggled once in each round in which the servo's heartbeat has changed; when the servo hangs, the
// line stays constant
// Lost     a failing adapter is searched for twice a second; its outputs start low again
// Thread   open() and round() on the pump's; write(), read() and drop() see hal/api/lines.hpp
#pragma once

#include <atomic>

#include "hal/io/line_port.hpp"
#include "ipc/shm/latest.hpp"

namespace tact {

class LineWorker {
public:
    static constexpr Duration kReopenEvery = std::chrono::milliseconds(500);
    static constexpr Duration kBlinkHalf = std::chrono::milliseconds(250);

    LineWorker(const LineLogicSettings& settings, LinePort& port) noexcept;

    LinesInfo open();
    void round(Instant now) noexcept;
    void end() noexcept;  // all outputs low

    bool read(LinesSample& newest) const noexcept TACT_RT { return sample_.read(newest); }
    void write(const LinesCommand& command) noexcept TACT_RT { command_.publish(command); }
    void drop() noexcept TACT_RT { drops_.fetch_add(1, std::memory_order_relaxed); }
    [[nodiscard]] LinesHealth health() const noexcept TACT_RT;

private:
    [[nodiscard]] LineReading look(Instant now) noexcept;
    [[nodiscard]] std::uint8_t wanted(const LinesCommand& command, Instant now) noexcept;
    void lose(Instant now) noexcept;
    void publish(const LineReading& in, Instant now) noexcept;

    LineLogicSettings settings_;
    LineLogic logic_;
    LinePort& port_;
    Latest<LinesSample> sample_{};
    Latest<LinesHealth> health_{};
    Latest<LinesCommand> command_{};
    std::atomic<std::uint64_t> drops_{0};

    // Used by the pump only.
    LinesHealth counts_;
    std::uint64_t heartbeat_ = 0, sequence_ = 0;
    std::uint8_t driven_ = 0;
    Instant reopen_at_{};
};

}  // namespace tact
