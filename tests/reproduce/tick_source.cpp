#include "tests/reproduce/tick_source.hpp"

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>

#include "ipc/base/parent_death.hpp"

namespace tact::launch {

TickSource::TickSource(int core) {
    // FIFO scheduling is requested before the fork, to detect a refusal. The child keeps it; this process returns to
    // ordinary scheduling.
    const sched_param high{.sched_priority = 1}, ordinary{.sched_priority = 0};
    if (sched_setscheduler(0, SCHED_FIFO, &high) != 0) return;
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ == 0) {
        prctl(PR_SET_NAME, "tick_source");
        if (!end_with_parent(parent, SIGKILL)) _exit(0);
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(static_cast<std::size_t>(core), &one);
        sched_setaffinity(0, sizeof one, &one);
        const timespec pause{.tv_sec = 0, .tv_nsec = 1'000'000};
        while (getppid() == parent) clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
        _exit(0);
    }
    sched_setscheduler(0, SCHED_OTHER, &ordinary);
}

TickSource::~TickSource() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

}  // namespace tact::launch
