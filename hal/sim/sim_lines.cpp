#include "hal/sim/sim_lines.hpp"

#include <signal.h>
#include <time.h>

namespace tact {

namespace {

// Per process, not per board: a signal may arrive after a board's end.
std::atomic<bool> stop_by_signal{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_line_signal(int number) { stop_by_signal.store(number == SIGUSR1); }

}  // namespace

void SimBoard::apply_signals() {
    struct sigaction action {};
    action.sa_handler = &on_line_signal;
    action.sa_flags = SA_RESTART;
    for (const int number : {SIGUSR1, SIGUSR2}) sigaction(number, &action, nullptr);
    by_signal_ = true;
}

LinePortInfo SimBoard::open() {
    driven_.store(0);
    return {.name = "emulated lines", .inputs = kInputs, .outputs = kOutputs};
}

bool SimBoard::reopen() noexcept {
    if (fault_.load() == LinesFault::unplugged) return false;
    driven_.store(0);
    return true;
}

LineReading SimBoard::read() noexcept {
    const bool stopped = by_signal_ && stop_by_signal.load();
    const LinesFault fault = stopped ? LinesFault::stop_pressed : fault_.load();
    LineReading in{.good = true, .closed = kInputs, .touched = touched_.exchange(0)};
    const bool enabled = (driven_.load() & kLineEnable) != 0;
    const auto open = [&in](int bits) { in.closed = static_cast<std::uint8_t>(in.closed & ~bits); };
    open((kLineBurr | kLineSuction) & ~pressed_.load());
    if (fault == LinesFault::amplifier_off || (fault != LinesFault::amplifier_on && !enabled))
        open(kLineAmplifier);
    switch (fault) {
        case LinesFault::stop_pressed:
            open(kLineStopA | kLineStopB);
            break;
        case LinesFault::stop_a_open:
            open(kLineStopA);
            break;
        case LinesFault::stop_b_open:
            open(kLineStopB);
            break;
        case LinesFault::pedal_released:
            open(kLineDeadMan);
            break;
        case LinesFault::read_error:
        case LinesFault::unplugged:
            return {};
        case LinesFault::none:
        case LinesFault::amplifier_off:
        case LinesFault::amplifier_on:
            break;
    }
    return in;
}

bool SimBoard::write(std::uint8_t outputs) noexcept {
    if (fault_.load() != LinesFault::unplugged) driven_.store(outputs);
    return true;
}

void SimBoard::wait(Duration longest) noexcept {
    const timespec time{.tv_sec = longest.count() / 1'000'000'000,
                        .tv_nsec = longest.count() % 1'000'000'000};
    nanosleep(&time, nullptr);
}

LinesInfo SimLines::open() {
    opened_ = true;
    return worker_.open();
}

bool SimLines::read(LinesSample& newest, Instant now) noexcept {
    if (opened_) worker_.round(now);
    return worker_.read(newest);
}

void SimLines::write(const LinesCommand& command, Instant /*now*/) noexcept { worker_.write(command); }

}  // namespace tact
