#include "hal/io/pumped_lines.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <utility>

#include "ipc/base/quiet_thread.hpp"

namespace tact {

PumpedLines::PumpedLines(const LineLogicSettings& settings, std::unique_ptr<LinePort> port, Duration every)
    : port_(std::move(port)), worker_(settings, *port_), every_(every) {}

PumpedLines::~PumpedLines() {
    leave_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
}

LinesInfo PumpedLines::open() {
    if (thread_.joinable()) return info_;
    info_ = worker_.open();
    thread_ = start_quiet_thread([this] { live(); });
    return info_;
}

void PumpedLines::live() noexcept {
    pthread_setname_np(pthread_self(), "lines");
    sched_param param{};
    param.sched_priority = kPriority;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);  // without the right: ordinary scheduling
    while (!leave_.load(std::memory_order_relaxed)) {
        const Instant begin = Monotonic::now();
        worker_.round(begin);
        // A slow adapter is polled again at once, but never without a pause for threads of lower priority.
        port_->wait(std::max(begin + every_ - Monotonic::now(), Duration(std::chrono::microseconds(100))));
    }
    worker_.end();
}

bool PumpedLines::read(LinesSample& newest, Instant /*now*/) noexcept { return worker_.read(newest); }

void PumpedLines::write(const LinesCommand& command, Instant /*now*/) noexcept { worker_.write(command); }

}  // namespace tact
