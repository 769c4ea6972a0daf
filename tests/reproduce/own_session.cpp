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

namespace tact::launch {
namespace {

constexpr char kNice[] = "-20";

Precedence take_precedence() {
    if (setpriority(PRIO_PROCESS, 0, -20) != 0) return Precedence::none;
    // On a kernel without autogroup, setpriority() above suffices.
    const int fd = open("/proc/self/autogroup", O_WRONLY | O_CLOEXEC);
    if (fd < 0) return Precedence::session;
    const bool written = write(fd, kNice, sizeof kNice - 1) == static_cast<ssize_t>(sizeof kNice - 1);
    close(fd);
    return written ? Precedence::session : Precedence::none;
}

}  // namespace

const char* precedence_text(Precedence p) {
    return p == Precedence::session ? "all at nice -20" : "all at ordinary priority";
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
