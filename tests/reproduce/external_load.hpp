// Another program on the same core: endless random-number arithmetic, as in the paper's experiment, over a table that is
// larger than the caches near the core.
//
// Session  that of tact, so that it gets the fair share of one more process. In a session of its own, where the kernel
//          groups processes by session, it got half of the core beside a display at full detail and starved beside one
//          at coarse detail (Linux 6.18, 2026-11-20).
// Life     ended by stop() or the destructor, and by the kernel if tact dies.
#pragma once

#include <sys/types.h>

#include "ipc/base/clock.hpp"

namespace tact::launch {

class ExternalLoad {
public:
    explicit ExternalLoad(int core);  // throws StartupError
    ~ExternalLoad() { stop(); }
    ExternalLoad(const ExternalLoad&) = delete;
    ExternalLoad& operator=(const ExternalLoad&) = delete;
    [[nodiscard]] pid_t pid() const { return pid_; }
    void stop() noexcept;
    // Fraction of its core while it ran; valid after stop().
    [[nodiscard]] double share() const { return share_; }

private:
    pid_t pid_ = -1;
    Instant begun_at_ = Monotonic::now();
    double share_ = 0.0;
};

}  // namespace tact::launch
