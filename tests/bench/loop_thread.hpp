// Runs measured work as the servo loop would: in a thread like the servo's, each step at its planned instant.
//
// Why   steps that follow each other at once find warm caches and an awake core; the steps of a loop come after a sleep,
//       in which others had both.
#pragma once

#include <cmath>
#include <functional>

#include "ipc/base/pacer.hpp"
#include "ipc/base/servo_clock.hpp"

namespace tact {

inline constexpr int kServoPriority = 80;                                   // FIFO; 0: ordinary scheduling
inline constexpr Duration kServoSpinTail = std::chrono::microseconds(100);  // the default of deploy/tact.toml

struct LoopThread {
    bool fifo = false;  // whether the priority was permitted
    int core = -1;      // pinned to it; -1: not pinned
};
// Blocks until the work is done and passes on what it throws. FIFO and the last core, where permitted and the priority is not
// 0. Throws StartupError: no thread can be started.
LoopThread run_as_loop(int priority, const std::function<void()>& work);

// The steps of one pass.
class LoopPace {
public:
    // 0: each step follows the one before at once.
    explicit LoopPace(double period_s)
        : period_(std::llround(1e9 * period_s)), pacer_(period_, clock_.now() + 10 * period_) {}
    // Until the next step is due. The periods that a step took too long for are skipped, as in the loop.
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
