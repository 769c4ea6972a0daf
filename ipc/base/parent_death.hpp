// A process that ends with the one that started it.
//
// Called   in the child, first of all; async-signal-safe, so also between fork() and exec(), which keeps it
// Thread   the parent is the thread that forked: the signal comes already when that one ends
#pragma once

#include <sys/prctl.h>
#include <sys/types.h>
#include <unistd.h>

namespace tact {

// From now on the kernel sends `signal` here when the parent is gone. False: it is gone already, and no
// signal will come.
[[nodiscard]] inline bool end_with_parent(pid_t parent, int signal) noexcept {
    prctl(PR_SET_PDEATHSIG, static_cast<unsigned long>(signal));
    return getppid() == parent;  // in this order: whoever goes between the lines is seen by one of them
}

}  // namespace tact
