// Cost of the shared-memory types: publish and read of each state topic, push and next of each ring.
#include <benchmark/benchmark.h>

#include <memory>

#include "ipc/topics/regions.hpp"

namespace tact {
namespace {

template <class T>
void publish(benchmark::State& state) {
    const auto latest = std::make_unique<Latest<T>>();
    T value{};
    for (auto _ : state) {
        ++value.taken_at_ns;
        latest->publish(value);
    }
    state.counters["bytes"] = sizeof(T);
}

template <class T>
void read(benchmark::State& state) {
    const auto latest = std::make_unique<Latest<T>>();
    T value{};
    latest->publish(value);
    bool all = true;
    for (auto _ : state) {
        all &= latest->read(value);
        benchmark::DoNotOptimize(value);
    }
    if (!all) state.SkipWithError("a read without a writer failed");
    state.counters["bytes"] = sizeof(T);
}

template <class T, std::uint64_t Capacity>
void push(benchmark::State& state) {
    const auto ring = std::make_unique<Ring<T, Capacity>>();
    T value{};
    for (auto _ : state) {
        if constexpr (requires { value.step; })
            ++value.step;
        else
            ++value.taken_at_ns;
        ring->push(value);
    }
    state.counters["bytes"] = sizeof(T);
}

template <class T, std::uint64_t Capacity>
void push_and_next(benchmark::State& state) {
    const auto ring = std::make_unique<Ring<T, Capacity>>();
    RingCursor cursor;
    T value{};
    for (auto _ : state) {
        ring->push(value);
        benchmark::DoNotOptimize(ring->next(cursor, value));
    }
    if (cursor.missed != 0) state.SkipWithError("records were missed");
}

BENCHMARK(publish<ToolTopic>);
BENCHMARK(publish<HealthTopic>);
BENCHMARK(publish<LevelsTopic>);
BENCHMARK(publish<BodiesTopic>);
BENCHMARK(publish<LatenessTopic>);
BENCHMARK(publish<LoadTopic>);
BENCHMARK(read<ToolTopic>);
BENCHMARK(read<HealthTopic>);
BENCHMARK(read<LevelsTopic>);
BENCHMARK(read<BodiesTopic>);
BENCHMARK(push<EventTopic, 1024>);
BENCHMARK(push<TraceTopic, 16384>);
BENCHMARK(push<CycleTopic, 32768>);
BENCHMARK(push<HandTopic, 32768>);
BENCHMARK(push_and_next<EventTopic, 1024>);
BENCHMARK(push_and_next<TraceTopic, 16384>);

}  // namespace
}  // namespace tact
