// How much the speed of the processor changes meanwhile, by a loop that shares nothing with the program that a bench measures.
//
// Spread   time of a fixed loop without memory accesses: its 95th over its 5th percentile. 1: constant. Other programs of the
//          host, a throttled clock or a shared physical core raise it
// Thread   any; blocks for the length of a sample
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/base/clock.hpp"
#include "tests/bench/percentiles.hpp"

namespace tact {

class CoreSpeed {
public:
    // A quiet machine's: a level that fits stays, and figures of runs one after the other can be compared.
    static constexpr double kQuietSpread = 1.1;

    void sample(Duration length) {
        const Instant end = Monotonic::now() + length;
        for (Instant begin = Monotonic::now(); begin < end;) {
            count();
            const Instant now = Monotonic::now();
            note(to_s(now - begin));
            begin = now;
        }
    }
    void note(double loop_s) { loops_s_.push_back(loop_s); }
    [[nodiscard]] double spread() const {  // at least one sample
        return percentile(loops_s_, 0.95) / percentile(loops_s_, 0.05);
    }

private:
    // About 0.2 ms: each step waits for the one before.
    static void count() {
        volatile std::uint64_t sink = 1;
        std::uint64_t x = sink;
        for (int i = 0; i < 150'000; ++i) x = x * 6364136223846793005ULL + 1442695040888963407ULL;
        sink = x;
    }
    std::vector<double> loops_s_;
};

}  // namespace tact
