// Waits for a change made by another thread or process.
#pragma once

#include <chrono>
#include <thread>

#include "ipc/base/clock.hpp"

namespace tact::test {

// Long, because a loaded machine is slow under sanitizers; reached only by a failing test.
template <class F>
bool wait_for(F&& happened) {
    const Instant until = Monotonic::now() + std::chrono::seconds(120);
    while (Monotonic::now() < until) {
        if (happened()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

}  // namespace tact::test
