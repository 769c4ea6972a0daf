// Makes the kernel divide a core more finely than its own tick does.
//
// Why     With a tick of 4 ms (250 Hz) and no high-resolution tick, the scheduler decides 25 times in a tenth of a second:
//         the share of one of two parties then varies by a tenth from window to window under any law. A program that
//         wakes every millisecond and sleeps again at once causes a decision each time (measured, Linux 6.18: time
//         slices of 1 ms instead of 4; it takes a hundredth of the core).
// Equal   it runs in all runs of an experiment, or in none
// Rights  needs FIFO scheduling; without them running() is false
// Life    ended by the destructor, and by the kernel if tact dies
#pragma once

#include <sys/types.h>

namespace tact::launch {

class TickSource {
public:
    explicit TickSource(int core);
    ~TickSource();
    TickSource(const TickSource&) = delete;
    TickSource& operator=(const TickSource&) = delete;
    [[nodiscard]] bool running() const { return pid_ > 0; }
    [[nodiscard]] pid_t pid() const { return pid_; }

private:
    pid_t pid_ = -1;
};

}  // namespace tact::launch
