// Time from the last heartbeat of a servo that occupies its processor to the fall of the enable line, with the threads and
// priorities of tact-rt: five milliseconds of silence, a check of the supervisor, a sample of the lines.
//
// Falls later than 10 ms are counted. They are an error only if TACT_ASSERT_TIMES is set and real-time priorities are
// permitted: on a shared machine they depend on its other users.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "tests/support/real_loop.hpp"

namespace tact {
namespace {

constexpr double kMostS = 10e-3;
constexpr Duration kLetGo = std::chrono::milliseconds(100);  // many checks of the supervisor

bool may_use_fifo() {
    bool may = false;
    std::thread([&may] {
        may = raise_to_fifo(pthread_self(), "the bench", kSupervisorPriority).empty();
    }).join();
    return may;
}

// Time from the last heartbeat to the fall; nothing if the servo had already released the line (a fault, on a busy host)
// before it was stopped: then there is nothing to drop.
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
