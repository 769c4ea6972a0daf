// From the last beat of a servo that hogs its processor to the enable line's fall, with the threads and priorities
// of tact-rt: five milliseconds of silence, a look of the supervisor, a look of the lines.
//
// A fall later than 10 ms is counted. It is an error where TACT_ASSERT_TIMES is set and real-time priorities are
// permitted, and only there: on a machine that others use it says something of them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "tests/support/real_loop.hpp"

namespace tact {
namespace {

constexpr double kMostS = 10e-3;
constexpr Duration kLetGo = std::chrono::milliseconds(100);  // many looks of the supervisor

bool may_use_fifo() {
    bool may = false;
    std::thread([&may] {
        may = raise_to_fifo(pthread_self(), "the bench", kSupervisorPriority).empty();
    }).join();
    return may;
}

// From the last beat to the fall; nothing where the servo had itself let go (a fault, on a busy host) before it was
// made to stand: then there is nothing to drop.
std::optional<double> fall_s(RealLoop& loop) {
    std::uint64_t before = loop.drops();
    for (; !loop.brought_up(); before = loop.drops()) usleep(1000);
    loop.stand(Stand::spinning);
    std::optional<double> took_s;
    for (Instant down = Instant::max(); !took_s && Monotonic::now() - down < kLetGo; usleep(50)) {
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
    const bool fifo = may_use_fifo();
    double worst_s = 0.0, late = 0.0;
    for (auto _ : state) {
        std::optional<double> fell_s;
        while (!fell_s) fell_s = fall_s(loop);
        const double took_s = *fell_s;
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
