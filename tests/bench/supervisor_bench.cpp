// From the last beat of a servo that hogs its processor to the enable line's fall, with the threads and priorities
// of tact-rt: five milliseconds of silence, a look of the supervisor, a look of the lines.
//
// A fall later than 10 ms is counted. It is an error where TACT_ASSERT_TIMES is set and real-time priorities are
// permitted, and only there: on a machine that others use it says something of them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/real_loop.hpp"

namespace tact {
namespace {

constexpr double kMostS = 10e-3;

bool may_use_fifo() {
    bool may = false;
    std::thread([&may] {
        may = raise_to_fifo(pthread_self(), "the bench", kSupervisorPriority).empty();
    }).join();
    return may;
}

void drop(benchmark::State& state) {
    RealLoop loop(std::chrono::milliseconds(5), kServoPriority);
    const bool fifo = may_use_fifo();
    double worst_s = 0.0, late = 0.0;
    for (auto _ : state) {
        std::uint64_t before = loop.drops();
        for (; !loop.brought_up(); before = loop.drops()) usleep(1000);
        loop.stand(Stand::spinning);
        while (loop.enabled() || loop.drops() == before) usleep(50);
        const double took_s = to_s(Monotonic::now() - loop.beat());
        loop.stand(Stand::none);
        worst_s = std::max(worst_s, took_s);
        late += took_s > kMostS ? 1.0 : 0.0;
        state.SetIterationTime(took_s);
    }
    state.counters["worst_ms"] = 1e3 * worst_s;
    state.counters["over_10_ms"] = late;
    state.counters["fifo"] = fifo ? 1.0 : 0.0;
    if (fifo && late > 0.0 && std::getenv("TACT_ASSERT_TIMES") != nullptr)
        state.SkipWithError("the enable line fell later than 10 ms after the last beat");
}

BENCHMARK(drop)->UseManualTime()->Iterations(20)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tact
