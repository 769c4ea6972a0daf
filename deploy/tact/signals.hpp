// Signals as something to wait for, so that the launcher needs no handler.
//
// SIGINT, SIGTERM, SIGHUP and SIGCHLD are blocked while an object lives and are taken from it in turn. One
// object at a time.
#pragma once

#include <signal.h>

#include <vector>

namespace tact::launch {

class Signals {
public:
    Signals();
    ~Signals();
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    // Waits until a signal comes or the time is over. SIGCHLD only wakes; 0: no request to end.
    int wait(int timeout_ms);

private:
    sigset_t before_{};
    int fd_ = -1;
};

}  // namespace tact::launch
