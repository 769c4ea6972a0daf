// Shortens the time slices of a core below the kernel's tick.
//
// Why       With a tick of 4 ms (250 Hz) and no high-resolution tick, the scheduler decides 25 times in a tenth of a
//           second. The share of one of two parties then varies by a tenth between windows, whatever the law. A program
//           that wakes every millisecond and sleeps again immediately causes a decision each time (measured with Linux
//           6.18: time slices of 1 ms instead of 4 ms, at a cost of 1 % of the core).
// Equal     it runs in all runs of an experiment or in none
// Rights    requires the right to FIFO scheduling; without it running() is false
// Lifetime  until the destructor; the kernel ends it if tact dies
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
