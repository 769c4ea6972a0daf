#include "tests/bench/bench_servo.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>

#include "ipc/base/error.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/base/pacer.hpp"
#include "ipc/base/servo_clock.hpp"

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

int last_allowed_core() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    sched_getaffinity(0, sizeof allowed, &allowed);
    int core = -1;
    for (int i = 0; i < CPU_SETSIZE; ++i) {
        if (CPU_ISSET(static_cast<std::size_t>(i), &allowed)) core = i;
    }
    return core;
}

void* run_round(void* argument) {
    Round& r = *static_cast<Round*>(argument);
    sched_param param{};
    param.sched_priority = r.priority;
    r.fifo = r.priority > 0 && pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
    if (r.fifo) {
        cpu_set_t one;
        CPU_ZERO(&one);
        r.core = last_allowed_core();
        if (r.core >= 0) CPU_SET(static_cast<std::size_t>(r.core), &one);
        if (pthread_setaffinity_np(pthread_self(), sizeof one, &one) != 0) r.core = -1;
    }
    ServoClock clock(r.spin_tail);
    Pacer pacer(r.period, clock.now() + 10 * r.period);
    for (std::uint64_t i = 0; i < r.cycles; ++i) {
        const Instant planned = pacer.planned();
        clock.wait_until(planned);
        const Instant now = clock.now();
        r.lateness.add(now - planned);
        static_cast<void>(pacer.ended(now));
    }
    r.overruns = pacer.overruns();
    return nullptr;
}

void measure(Round& round) {
    pthread_t thread{};
    const int error = pthread_create(&thread, nullptr, &run_round, &round);
    if (error != 0)
        throw StartupError("starting the bench's servo thread", std::strerror(error), "free some memory");
    pthread_join(thread, nullptr);
}

LatenessMetrics metrics(const DurationHistogram& h) {
    const auto us = [&](double p) { return static_cast<double>(h.percentile_ns(p)) * 1e-3; };
    return {us(0.5), us(0.99), us(0.999), static_cast<double>(h.max_ns()) * 1e-3, h.total()};
}

// Locks memory and keeps processors awake during the benchmark only.
class Fitted {
public:
    Fitted()
        : locked_(mlockall(MCL_CURRENT) == 0),
          latency_fd_(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
        const std::int32_t zero = 0;
        if (latency_fd_ >= 0 && write(latency_fd_, &zero, sizeof zero) != sizeof zero) {
            close(latency_fd_);
            latency_fd_ = -1;
        }
    }
    ~Fitted() {
        if (latency_fd_ >= 0) close(latency_fd_);
        if (locked_) munlockall();
    }
    Fitted(const Fitted&) = delete;
    Fitted& operator=(const Fitted&) = delete;

private:
    bool locked_;
    int latency_fd_;
};

}  // namespace

ServoBench bench_servo(const ServoBenchSettings& settings) {
    const Fitted fitted;
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
