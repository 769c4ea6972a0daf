// Schedule of the cycles, and the effect of a late one: pure arithmetic, no clock.
//
// A cycle that ends after the next one was due is an overrun; the missed periods are skipped and counted.
// The loop never catches up in a burst.
#pragma once

#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/base/rt.hpp"

namespace tact {

class Pacer {
public:
    Pacer(Duration period, Instant first) noexcept : period_(period), planned_(first) {}

    [[nodiscard]] Instant planned() const noexcept { return planned_; }
    // The cycle planned at planned() ended. True: it overran.
    bool ended(Instant end) noexcept TACT_RT {
        planned_ += period_;
        if (end <= planned_) return false;
        const std::int64_t missed = (end - planned_) / period_ + 1;
        planned_ += missed * period_;
        skipped_ += static_cast<std::uint64_t>(missed);
        ++overruns_;
        return true;
    }
    void restart(Instant first) noexcept {
        planned_ = first;
        overruns_ = skipped_ = 0;
    }
    [[nodiscard]] std::uint64_t overruns() const noexcept { return overruns_; }
    [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

private:
    Duration period_;
    Instant planned_;
    std::uint64_t overruns_ = 0;
    std::uint64_t skipped_ = 0;
};

}  // namespace tact
