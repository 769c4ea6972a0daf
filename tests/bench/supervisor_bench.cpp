// Time from the last heartbeat of a servo that blocks its processor to the drop of the enable output, with the threads
// and priorities of tact-rt: five milliseconds without a heartbeat, one check of the supervisor, one sample of the
// digital I/O.
//
// Drops later than 10 ms are counted. They are an error only if TACT_ASSERT_TIMES is set and real-time priorities are
// permitted, because on a shared machine they depend on other users.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "tests/support/real_loop.hpp"

namespace tact {
namespace {

constexpr double kDropMaxS = 10e-3;
constexpr Duration kReleaseTimeout = std::chrono::milliseconds(100);  // many supervisor checks

bool fifo_permitted() {
    bool permitted = false;
    std::thread([&permitted] {
        permitted = raise_to_fifo(pthread_self(), "the benchmark", kSupervisorPriority).empty();
    }).join();
    return permitted;
}

// Time from the last heartbeat to the drop; empty if the servo had already switched the enable output off before it was
// blocked (after a fault, on a busy host).
std::optional<double> drop_time_s(RealLoop& loop) {
    std::uint64_t before = loop.drops();
    for (; !loop.brought_up(); before = loop.drops()) usleep(1000);
    loop.stand(Stand::spinning);
    std::optional<double> took_s;
    for (Instant down = Instant::max(); !took_s && Monotonic::now() - down < kReleaseTimeout; usleep(50)) {
        if (loop.enabled())
            down = Instant::max();
        else if (loop.drops() != before)
            took_s = to_s(Monotonic::now() - loop.beat());
        else
            down = std::min(down, Monotonic::now());
    }
    loop.stand(Stand::none);
    return took_s;
}

void drop(benchmark::State& state) {
    RealLoop loop(std::chrono::milliseconds(5), kServoPriority);
    const bool fifo = fifo_permitted();
    double worst_s = 0.0, late = 0.0;
    for (auto _ : state) {
        std::optional<double> drop_s;
        while (!drop_s) drop_s = drop_time_s(loop);
        const double took_s = *drop_s;
        worst_s = std::max(worst_s, took_s);
        late += took_s > kDropMaxS ? 1.0 : 0.0;
        state.SetIterationTime(took_s);
    }
    state.counters["worst_ms"] = 1e3 * worst_s;
    state.counters["over_10_ms"] = late;
    state.counters["fifo"] = fifo ? 1.0 : 0.0;
    if (fifo && late > 0.0 && std::getenv("TACT_ASSERT_TIMES") != nullptr)
        state.SkipWithError("the enable output dropped later than 10 ms after the last heartbeat");
}

BENCHMARK(drop)->UseManualTime()->Iterations(20)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tact
