#include "hal/io/line_worker.hpp"

namespace tact {

LineWorker::LineWorker(const LineLogicSettings& settings, LinePort& port) noexcept
    : settings_(settings), logic_(settings), port_(port) {}

LinesInfo LineWorker::open() {
    LinePortInfo info = port_.open();
    settings_.fitted = info.inputs;
    logic_ = LineLogic(settings_);
    counts_.up = true;
    driven_ = 0;
    return {.name = std::move(info.name), .inputs = info.inputs, .outputs = info.outputs};
}

void LineWorker::lose(Instant now) noexcept {
    ++counts_.errors;
    if (counts_.up) ++counts_.losses;
    counts_.up = false;
    driven_ = 0;
    reopen_at_ = now + kReopenEvery;
}

LineReading LineWorker::look(Instant now) noexcept {
    if (!counts_.up && now >= reopen_at_) {
        counts_.up = port_.reopen();
        if (counts_.up) ++counts_.reopened;
        reopen_at_ = now + kReopenEvery;
    }
    if (!counts_.up) return {};
    const LineReading in = port_.read();
    if (!in.good) {
        static_cast<void>(port_.write(0));  // outputs may still work although inputs fail
        lose(now);
    }
    return in;
}

std::uint8_t LineWorker::wanted(const LinesCommand& command, Instant now) noexcept {
    std::uint8_t out = driven_ & kLineWatchdog;
    if (command.heartbeat != heartbeat_) {
        heartbeat_ = command.heartbeat;
        out ^= kLineWatchdog;
        ++counts_.toggles;
    }
    if (command.enable && logic_.state() == LinesState::permitted) out |= kLineEnable;
    const bool bright = (now.time_since_epoch() / kBlinkHalf) % 2 == 0;
    if (command.lamp == Lamp::lit || (command.lamp == Lamp::blinking && bright)) out |= kLineLamp;
    return out;
}

void LineWorker::round(Instant now) noexcept {
    LinesCommand command;
    static_cast<void>(command_.read(command));
    const LineReading in = look(now);
    const std::uint64_t drops = drops_.load(std::memory_order_relaxed);
    counts_.drops = drops;
    logic_.look(in, command.rearm, drops, (driven_ & kLineEnable) != 0, now);
    if (in.good) {
        const std::uint8_t out = wanted(command, now);
        if (out != driven_) {
            driven_ = out;
            if (!port_.write(out)) lose(now);  // the next reading reports it
        }
    }
    publish(in, now);
}

void LineWorker::end() noexcept {
    if (counts_.up) static_cast<void>(port_.write(0));
    driven_ = 0;
}

void LineWorker::publish(const LineReading& in, Instant now) noexcept {
    ++counts_.looks;
    counts_.trips = logic_.trips();
    LinesSample s;
    s.taken_at = now;
    s.sequence = ++sequence_;
    s.trips = logic_.trips();
    s.state = logic_.state();
    s.cause = logic_.cause();
    s.inputs = in.good ? in.closed : std::uint8_t{0};
    s.outputs = driven_;
    sample_.publish(s);
    health_.publish(counts_);
}

LinesHealth LineWorker::health() const noexcept {
    LinesHealth h;
    static_cast<void>(health_.read(h));
    return h;
}

}  // namespace tact
