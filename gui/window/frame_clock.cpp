#include "gui/window/frame_clock.hpp"

#include <time.h>

#include <numeric>

namespace tact {

void FrameClock::begin(double due_s) {
    constexpr double kLate = 1.5;  // periods
    const Instant now = Monotonic::now();
    if (frame_ > 0) {
        frame_s_ = to_s(now - started_);
        window_.add(frame_s_);
        run_.add(now - started_);
        if (due_s_ > 0.0 && frame_s_ > kLate * due_s_) ++late_;
    }
    due_s_ = due_s;
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

void FrameClock::fill(FrameMetrics& f) const {
    const auto of_run = [this](double p) {
        return static_cast<float>(1e-9 * static_cast<double>(run_.percentile_ns(p)));
    };
    f.frames = run_.total();
    f.late = late_;
    f.due_s = due_s_;
    f.window = static_cast<std::uint32_t>(window_.size());
    f.p50_s = window_.percentile_s(0.5);
    f.p99_s = window_.percentile_s(0.99);
    f.most_s = window_.most_s();
    f.run_p50_s = of_run(0.5);
    f.run_p99_s = of_run(0.99);
    f.run_most_s = static_cast<float>(1e-9 * static_cast<double>(run_.max_ns()));
}

double FrameClock::work_s() const { return std::accumulate(part_s_.begin(), part_s_.end(), 0.0); }

void FrameClock::pace(double fps_max) const {
    if (!(fps_max > 0.0)) return;
    const std::int64_t until_ns = to_ns(started_) + static_cast<std::int64_t>(1e9 / fps_max);
    const timespec until{static_cast<time_t>(until_ns / 1'000'000'000),
                         static_cast<long>(until_ns % 1'000'000'000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until,
                    nullptr);  // a signal may end it early
}

double FrameClock::process_cpu_s() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace tact
