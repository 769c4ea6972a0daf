// A thread that blocks all signals: the main thread handles them.
//
// Thread  any, at start-up; throws std::system_error like std::thread
#pragma once

#include <pthread.h>
#include <signal.h>

#include <thread>
#include <utility>

namespace tact {

template <class Run>
[[nodiscard]] std::thread start_quiet_thread(Run&& run) {
    // The new thread inherits the mask.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread thread(std::forward<Run>(run));
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

}  // namespace tact
