// Makes the kernel share a core out more finely than its own tick does.
//
// Why     with a tick of 4 ms (250 Hz) and no high-resolution one, who runs is decided 25 times in a
//         tenth of a second: the share of one of two parties then flickers by a tenth from window to
//         window, whatever any law does. A program that wakes every millisecond and at once sleeps again
//         makes it decide then (measured, Linux 6.18: turns of 1 ms instead of 4; it takes a hundredth of
//         the core).
// Equal   it runs in all runs of an experiment, or in none
// Rights  needs FIFO scheduling; without them running() is false
// Life    ended by the destructor, and by the kernel where tact dies
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
