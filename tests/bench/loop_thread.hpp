// Runs measured work under the conditions of the servo loop: in a thread configured like the servo thread, with a
// planned start time for each step.
//
// Why   steps without pauses run with warm caches on an active core. The steps of a loop follow a sleep, during which
//       other programs use core and caches.
#pragma once

#include <cmath>
#include <functional>

#include "ipc/base/pacer.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

inline constexpr int kServoPriority = 80;  // of FIFO scheduling; 0: ordinary scheduling
inline constexpr Duration kServoSpinTail = std::chrono::microseconds(100);  // the default of deploy/tact.toml

struct LoopThread {
    bool fifo = false;  // true: FIFO scheduling was permitted
    int core = -1;      // core that the thread is pinned to; -1: not pinned
};
// Blocks until the work is done and rethrows its exceptions. Uses FIFO scheduling on the last core if permitted and the
// priority is not 0. Throws StartupError if no thread can be started.
LoopThread run_as_loop(int priority, const std::function<void()>& work);

// Paces the steps of one pass.
class LoopPace {
public:
    // period_s = 0: no pauses between steps.
    explicit LoopPace(double period_s)
        : period_(std::llround(1e9 * period_s)), pacer_(period_, clock_.now() + 10 * period_) {}
    // Waits for the next start time. Skips the periods missed by a step that took too long, as the loop does.
    void wait() {
        if (period_ <= Duration{0}) return;
        if (begun_) static_cast<void>(pacer_.ended(clock_.now()));
        begun_ = true;
        clock_.wait_until(pacer_.planned());
    }

private:
    Duration period_;
    ServoClock clock_{kServoSpinTail};
    Pacer pacer_;
    bool begun_ = false;
};

}  // namespace tact
