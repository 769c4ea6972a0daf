// A thread that takes no signal: they belong to the main thread.
//
// Thread  any, at start-up; std::system_error as std::thread throws it
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
