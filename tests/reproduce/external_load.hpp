// Another program on the same core, as in the experiment of the paper: computes random numbers in an endless loop, with
// a table larger than the caches near the core.
//
// Session   the same as that of tact, so that it gets the fair share of one more process. In a separate session, the
//           kernel, which groups processes by session, gave it half of the core at full rendering detail and almost
//           nothing at coarse detail (Linux 6.18, 2026-11-20).
// Lifetime  until stop() or the destructor; the kernel ends it if tact dies
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
    // Fraction of the core used while it ran; valid after stop().
    [[nodiscard]] double share() const { return share_; }

private:
    pid_t pid_ = -1;
    Instant begun_at_ = Monotonic::now();
    double share_ = 0.0;
};

}  // namespace tact::launch
