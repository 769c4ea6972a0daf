#include "gui/app/frame_clock.hpp"

#include <time.h>

#include <numeric>

namespace tact {

void FrameClock::begin() {
    const Instant now = Monotonic::now();
    if (frame_ > 0) frame_s_ = to_s(now - started_);
    started_ = mark_ = now;
    part_s_.fill(0.0);
    ++frame_;
    recent_.push_back(now);
    while (now - recent_.front() > std::chrono::seconds(1)) recent_.pop_front();
    if (recent_.size() > 1)
        fps_ = static_cast<double>(recent_.size() - 1) / to_s(now - recent_.front());
    else
        fps_ = 0.0;
}

void FrameClock::end_part(FramePart part) {
    const Instant now = Monotonic::now();
    part_s_[static_cast<std::size_t>(part)] += to_s(now - mark_);
    mark_ = now;
}

double FrameClock::work_s() const { return std::accumulate(part_s_.begin(), part_s_.end(), 0.0); }

void FrameClock::pace(double fps_max) const {
    if (!(fps_max > 0.0)) return;
    const std::int64_t until_ns = to_ns(started_) + static_cast<std::int64_t>(1e9 / fps_max);
    const timespec until{static_cast<time_t>(until_ns / 1'000'000'000),
                         static_cast<long>(until_ns % 1'000'000'000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until,
                    nullptr);  // a signal ends it early, which is right
}

double FrameClock::process_cpu_s() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace tact
