// Emulated safety inputs: contacts that tests can open, an amplifier whose read-back follows the enable
// line.
//
// SimBoard  the adapter with its wiring; faults may come from any thread, and an emergency stop from
//           another process
// SimLines  the board behind the same LineWorker as a real adapter, in lockstep: each read() polls at its
//           `now`, so the same calls give the same states, on any clock
#pragma once

#include <atomic>

#include "hal/io/line_worker.hpp"

namespace tact {

enum class LinesFault : std::uint8_t {
    none,
    stop_pressed,  // both channels
    stop_a_open,   // one channel alone, or its wire broken
    stop_b_open,
    pedal_released,
    amplifier_off,  // regardless of the enable line
    amplifier_on,
    read_error,
    unplugged,  // writes still seem to work
};

class SimBoard final : public LinePort {
public:
    static constexpr std::uint8_t kInputs =
        kLineStopA | kLineStopB | kLineDeadMan | kLineAmplifier | kLineBurr | kLineSuction;
    static constexpr std::uint8_t kOutputs = kLineEnable | kLineWatchdog | kLineLamp;

    LinePortInfo open() override;
    bool reopen() noexcept override;
    LineReading read() noexcept override;
    bool write(std::uint8_t outputs) noexcept override;
    void wait(Duration longest) noexcept override;

    void inject(LinesFault fault) noexcept { fault_.store(fault); }
    // Emulates a contact that opened and closed again between two polls.
    void touch(std::uint8_t inputs) noexcept { touched_.fetch_or(inputs); }
    // Sets the pressed tool pedals: kLineBurr, kLineSuction.
    void press(std::uint8_t pedals) noexcept { pressed_.store(pedals); }
    [[nodiscard]] std::uint8_t driven() const noexcept { return driven_.load(); }  // LineOutput
    // Makes SIGUSR1 press the emergency stop and SIGUSR2 release it. Start-up.
    void apply_signals();

private:
    std::atomic<LinesFault> fault_{LinesFault::none};
    std::atomic<std::uint8_t> touched_{0}, driven_{0}, pressed_{0};
    bool by_signal_ = false;
};

class SimLines final : public Lines {
public:
    explicit SimLines(const LineLogicSettings& settings = {}) : worker_(settings, board_) {}

    LinesInfo open() override;
    bool read(LinesSample& newest, Instant now) noexcept TACT_RT override;
    void write(const LinesCommand& command, Instant now) noexcept TACT_RT override;
    void drop() noexcept TACT_RT override { worker_.drop(); }
    [[nodiscard]] LinesHealth health() const noexcept TACT_RT override { return worker_.health(); }

    void inject(LinesFault fault) noexcept { board_.inject(fault); }
    [[nodiscard]] SimBoard& board() noexcept { return board_; }

private:
    SimBoard board_;
    LineWorker worker_;
    bool opened_ = false;
};

}  // namespace tact
