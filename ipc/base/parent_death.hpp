// Ends a process together with its parent.
//
// Call     first in the child; async-signal-safe, so also between fork() and exec(), which keeps the
//          setting
// Thread   the parent is the thread that forked: the signal is sent as soon as that thread ends
#pragma once

#include <sys/prctl.h>
#include <sys/types.h>
#include <unistd.h>

namespace tact {

// From this call on, the kernel sends `signal` when the parent ends. False: the parent has already ended,
// and no signal will come.
[[nodiscard]] inline bool end_with_parent(pid_t parent, int signal) noexcept {
    prctl(PR_SET_PDEATHSIG, static_cast<unsigned long>(signal));
    return getppid() == parent;  // in this order: one of the two lines detects every death
}

}  // namespace tact
