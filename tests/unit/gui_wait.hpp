// Waits for what another thread or process is to bring about.
#pragma once

#include <chrono>
#include <thread>

#include "ipc/base/clock.hpp"

namespace tact::test {

// Long, as a loaded machine under sanitizers is slow; reached only when something is wrong.
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
