// Waits for signals synchronously, without a signal handler.
//
// SIGINT, SIGTERM, SIGHUP and SIGCHLD are blocked during the life of the object and read from it one by one. Only one
// object may exist at a time.
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

    // Waits for a signal or the timeout. SIGCHLD only ends the wait; returns 0 without a request to end.
    int wait(int timeout_ms);

private:
    sigset_t before_{};
    int fd_ = -1;
};

}  // namespace tact::launch
