// A clock that advances only when it is told to, and calls a function after each step of at most a millisecond: a
// round of a pump, a tick of an emulated device.
//
// Thread   one
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>

#include "ipc/base/clock.hpp"

namespace tact {

class SteppingClock final : public Clock {
public:
    Instant now() noexcept override { return now_; }
    void wait_until(Instant t) noexcept override {
        while (now_ < t) {
            now_ = std::min(t, now_ + std::chrono::milliseconds(1));
            if (step) step();
        }
    }
    void jump(Instant t) noexcept { now_ = t; }

    std::function<void()> step;

private:
    Instant now_ = instant_from_ns(1'000'000'000);
};

}  // namespace tact
