// Another program on the same core: random-number arithmetic without end, as in the paper's experiment, over a
// table that is larger than the caches near the core.
//
// Session  that of tact, so that it gets the share of one more process. In a session of its own, where the
//          kernel groups processes by session, it got half of the core beside a full picture and starved
//          beside a coarse one (Linux 6.18, 2026-11-20).
// Life     ended by stop() or the destructor, and by the kernel where tact dies.
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
    // Of its core, while it ran; once it was stopped.
    [[nodiscard]] double share() const { return share_; }

private:
    pid_t pid_ = -1;
    Instant begun_at_ = Monotonic::now();
    double share_ = 0.0;
};

}  // namespace tact::launch
