#include "deploy/tact/signals.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "ipc/base/error.hpp"

namespace tact::launch {

Signals::Signals() {
    sigset_t ours;
    sigemptyset(&ours);
    for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&ours, s);
    signal(SIGPIPE, SIG_IGN);  // a closed terminal must not prevent tact from ending its children
    sigprocmask(SIG_BLOCK, &ours, &before_);
    fd_ = signalfd(-1, &ours, SFD_CLOEXEC | SFD_NONBLOCK);
    if (fd_ < 0)
        throw StartupError("setting up signals", std::strerror(errno),
                           "close programs that hold many files open");
}

Signals::~Signals() {
    close(fd_);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
}

int Signals::wait(int timeout_ms) {
    pollfd p{.fd = fd_, .events = POLLIN, .revents = 0};
    ::poll(&p, 1, timeout_ms);
    int asked = 0;
    signalfd_siginfo info{};
    while (read(fd_, &info, sizeof info) == static_cast<ssize_t>(sizeof info))
        if (info.ssi_signo != SIGCHLD && asked == 0) asked = static_cast<int>(info.ssi_signo);
    return asked;
}

}  // namespace tact::launch
