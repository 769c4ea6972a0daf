#include "tests/bench/loop_thread.hpp"

#include <pthread.h>
#include <sched.h>

#include <cstring>
#include <exception>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

struct Work {
    int priority;
    const std::function<void()>& run;
    LoopThread thread{};
    std::exception_ptr thrown{};
};

int last_allowed_core() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    sched_getaffinity(0, sizeof allowed, &allowed);
    int core = -1;
    for (int i = 0; i < CPU_SETSIZE; ++i) {
        if (CPU_ISSET(static_cast<std::size_t>(i), &allowed)) core = i;
    }
    return core;
}

void* start(void* argument) {
    Work& w = *static_cast<Work*>(argument);
    sched_param param{};
    param.sched_priority = w.priority;
    w.thread.fifo = w.priority > 0 && pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
    if (w.thread.fifo) {
        cpu_set_t one;
        CPU_ZERO(&one);
        w.thread.core = last_allowed_core();
        if (w.thread.core >= 0) CPU_SET(static_cast<std::size_t>(w.thread.core), &one);
        if (pthread_setaffinity_np(pthread_self(), sizeof one, &one) != 0) w.thread.core = -1;
    }
    try {
        w.run();
    } catch (...) {
        w.thrown = std::current_exception();
    }
    return nullptr;
}

}  // namespace

LoopThread run_as_loop(int priority, const std::function<void()>& work) {
    Work w{priority, work};
    pthread_t thread{};
    const int error = pthread_create(&thread, nullptr, &start, &w);
    if (error != 0)
        throw StartupError("starting the servo thread of the benchmark", std::strerror(error),
                           "free some memory");
    pthread_join(thread, nullptr);
    if (w.thrown) std::rethrow_exception(w.thrown);
    return w.thread;
}

}  // namespace tact
