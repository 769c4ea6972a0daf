#include "tests/bench/bench_servo.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "ipc/base/histogram.hpp"

namespace tact {

namespace {

struct Round {
    Duration period, spin_tail;
    std::uint64_t cycles;
    int priority;
    DurationHistogram lateness{};
    std::uint64_t overruns = 0;
    bool fifo = false;
    int core = -1;
};

void measure(Round& round) {
    const LoopThread thread = run_as_loop(round.priority, [&round] {
        ServoClock clock(round.spin_tail);
        Pacer pacer(round.period, clock.now() + 10 * round.period);
        for (std::uint64_t i = 0; i < round.cycles; ++i) {
            const Instant planned = pacer.planned();
            clock.wait_until(planned);
            const Instant now = clock.now();
            round.lateness.add(now - planned);
            static_cast<void>(pacer.ended(now));
        }
        round.overruns = pacer.overruns();
    });
    round.fifo = thread.fifo;
    round.core = thread.core;
}

LatenessMetrics metrics(const DurationHistogram& h) {
    const auto us = [&](double p) { return static_cast<double>(h.percentile_ns(p)) * 1e-3; };
    return {us(0.5), us(0.99), us(0.999), static_cast<double>(h.max_ns()) * 1e-3, h.total()};
}

// Locks memory and keeps processors out of deep idle states while it exists.
class RealTimeSetup {
public:
    RealTimeSetup()
        : locked_(mlockall(MCL_CURRENT) == 0),
          latency_fd_(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
        const std::int32_t zero = 0;
        if (latency_fd_ >= 0 && write(latency_fd_, &zero, sizeof zero) != sizeof zero) {
            close(latency_fd_);
            latency_fd_ = -1;
        }
    }
    ~RealTimeSetup() {
        if (latency_fd_ >= 0) close(latency_fd_);
        if (locked_) munlockall();
    }
    RealTimeSetup(const RealTimeSetup&) = delete;
    RealTimeSetup& operator=(const RealTimeSetup&) = delete;

private:
    bool locked_;
    int latency_fd_;
};

}  // namespace

ServoBench bench_servo(const ServoBenchSettings& settings) {
    const RealTimeSetup setup;
    const auto cycles = static_cast<std::uint64_t>(settings.seconds / to_s(settings.period));
    Round spun{settings.period, settings.spin_tail, cycles, settings.priority};
    Round asleep{settings.period, Duration{0}, cycles, settings.priority};
    measure(spun);
    measure(asleep);
    return {.lateness = metrics(spun.lateness),
            .lateness_asleep = metrics(asleep.lateness),
            .overruns = spun.overruns,
            .fifo = spun.fifo,
            .core = spun.core};
}

}  // namespace tact
