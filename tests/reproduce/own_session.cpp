#include "tests/reproduce/own_session.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>

#include "deploy/tact/files.hpp"
#include "deploy/tact/signals.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/parent_death.hpp"
#include "ipc/shm/region.hpp"

namespace tact::launch {
namespace {

// A kernel before 6.6 lets a program that slept go first, for 3 ms at nice 0 and for 3 ms x 88761 / 1024 = 0.26 s at nice
// -20. So the session has the priority, and its programs are ordinary ones within it; where sessions have none, the
// programs get as much as costs them 9 ms.
constexpr char kSessionNice[] = "-20";
constexpr int kProgramNice = -5;

bool sessions_share_the_core() {
    return read_small("/proc/sys/kernel/sched_autogroup_enabled").starts_with('1');
}

bool raise_session() {
    const FileDescriptor file(open("/proc/self/autogroup", O_WRONLY | O_CLOEXEC));
    constexpr ssize_t kLength = sizeof kSessionNice - 1;
    return file.get() >= 0 && write(file.get(), kSessionNice, kLength) == kLength;
}

Precedence take_precedence() {
    if (sessions_share_the_core()) return raise_session() ? Precedence::session : Precedence::none;
    return setpriority(PRIO_PROCESS, 0, kProgramNice) == 0 ? Precedence::programs : Precedence::none;
}

}  // namespace

const char* precedence_text(Precedence p) {
    switch (p) {
        case Precedence::session:
            return "session at nice -20";
        case Precedence::programs:
            return "all at nice -5";
        case Precedence::none:
            break;
    }
    return "all at ordinary priority";
}

int in_own_session(const std::function<int(Precedence)>& work) {
    std::fflush(nullptr);
    Signals signals;
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0)
        throw StartupError("starting the experiment", std::strerror(errno),
                           "raise the limit of processes (ulimit -u)");
    if (child == 0) {
        if (!end_with_parent(parent, SIGTERM)) _exit(130);
        setsid();
        int code = 1;
        try {
            code = work(take_precedence());
        } catch (const std::exception& e) {
            std::fprintf(stderr, "tact: %s\n", e.what());
        }
        std::fflush(nullptr);
        _exit(code);
    }
    for (;;) {
        const int number = signals.wait(200);
        if (number != 0) kill(child, number);
        int status = 0;
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child) return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
}

}  // namespace tact::launch
