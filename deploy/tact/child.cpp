#include "deploy/tact/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "ipc/base/error.hpp"
#include "ipc/base/parent_death.hpp"

extern "C" char** environ;

namespace tact::launch {
namespace {

// The arguments and variables of the child, built before fork(): nothing is allocated after it.
struct Image {
    std::vector<std::string> words, variables;
    std::vector<char*> argv, envp;

    Image(const std::string& program, const ChildSettings& settings) {
        words.push_back(program);
        words.insert(words.end(), settings.arguments.begin(), settings.arguments.end());
        for (char** v = environ; *v != nullptr; ++v) {
            const std::string_view entry(*v);
            bool replaced = false;
            for (const auto& [key, value] : settings.environment)
                replaced |= entry.substr(0, entry.find('=')) == key;
            if (!replaced) variables.emplace_back(entry);
        }
        for (const auto& [key, value] : settings.environment)
            if (!value.empty()) variables.emplace_back(key).append("=").append(value);
        for (auto& w : words) argv.push_back(w.data());
        for (auto& v : variables) envp.push_back(v.data());
        argv.push_back(nullptr);
        envp.push_back(nullptr);
    }
};

[[noreturn]] void exec_program(const Image& image, const ChildSettings& settings, const cpu_set_t* cores,
                               pid_t parent, int report_fd) {
    const auto give_up = [report_fd]() {
        const int why = errno;
        [[maybe_unused]] const auto n = write(report_fd, &why, sizeof why);
        _exit(127);
    };
    setpgid(0, 0);
    if (!end_with_parent(parent, SIGTERM)) _exit(127);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    signal(SIGPIPE, SIG_DFL);
    if (cores != nullptr && sched_setaffinity(0, sizeof *cores, cores) != 0) give_up();
    if (settings.output_fd >= 0) {
        if (dup2(settings.output_fd, STDOUT_FILENO) < 0 || dup2(settings.output_fd, STDERR_FILENO) < 0)
            give_up();
    }
    if (settings.keep_fd >= 0) fcntl(settings.keep_fd, F_SETFD, 0);
    execve(image.argv[0], image.argv.data(), image.envp.data());
    give_up();
    _exit(127);
}

}  // namespace

std::string Ending::text() const {
    std::string t;
    if (by_signal) {
        const char* const what = sigdescr_np(number);
        t = "was killed by signal " + std::to_string(number) + " (" + (what != nullptr ? what : "unknown") +
            ")";
    } else {
        t = "ended with exit code " + std::to_string(number);
    }
    if (forced) t += " because it did not end on request";
    return t;
}

Child::Child(std::string name, const std::filesystem::path& program, const ChildSettings& settings)
    : name_(std::move(name)), grace_(settings.grace) {
    const Image image(program.string(), settings);
    cpu_set_t cores;
    CPU_ZERO(&cores);
    for (const int c : settings.cores) CPU_SET(static_cast<std::size_t>(c), &cores);
    std::array<int, 2> report{};
    if (pipe2(report.data(), O_CLOEXEC) != 0)
        throw StartupError("starting " + name_, std::strerror(errno),
                           "close programs that hold many files open");
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ == 0)
        exec_program(image, settings, settings.cores.empty() ? nullptr : &cores, parent, report[1]);
    const int fork_error = errno;
    close(report[1]);
    int why = 0;
    ssize_t got = 0;
    if (pid_ > 0) {
        do got = read(report[0], &why, sizeof why);  // exec closes the other end
        while (got < 0 && errno == EINTR);
    }
    close(report[0]);
    if (pid_ < 0)
        throw StartupError("starting " + name_, std::strerror(fork_error),
                           "raise the limit of processes (ulimit -u)");
    if (got > 0) {
        waitpid(pid_, nullptr, 0);
        throw StartupError("starting " + program.string(), std::strerror(why),
                           "check that the file exists and is executable");
    }
}

Child::~Child() {
    if (ending_) return;
    kill(-pid_, SIGKILL);
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

// A stopped child would not handle SIGTERM. A running child gets no SIGCONT, which would cancel a pending SIGSTOP, such
// as that of a debugger or of a leak checker at exit.
void Child::wake() const {
    siginfo_t halted{};
    if (waitid(P_PID, static_cast<id_t>(pid_), &halted, WSTOPPED | WNOHANG | WNOWAIT) == 0 &&
        halted.si_pid == pid_)
        kill(pid_, SIGCONT);
}

const std::optional<Ending>& Child::poll() {
    if (ending_) return ending_;
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
        ending_ = Ending{.by_signal = WIFSIGNALED(status),
                         .number = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status),
                         .asked = stop_at_.has_value(),
                         .forced = killed_};
    } else if (stop_at_ && !killed_) {
        wake();
        if (Monotonic::now() < *stop_at_ + grace_) return ending_;
        killed_ = true;
        kill(-pid_, SIGKILL);
    }
    return ending_;
}

void Child::stop() {
    if (poll() || stop_at_) return;
    stop_at_ = Monotonic::now();
    kill(pid_, SIGTERM);
    wake();
}

const std::optional<Ending>& Child::wait(Duration limit) {
    const Instant end = Monotonic::now() + limit;
    while (!poll() && Monotonic::now() < end) ::poll(nullptr, 0, 5);
    return ending_;
}

std::filesystem::path find_in_path(const std::string& name) {
    const char* const path = std::getenv("PATH");
    std::string_view rest = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
    while (!rest.empty()) {
        const auto end = rest.find(':');
        std::filesystem::path candidate = std::filesystem::path(rest.substr(0, end)) / name;
        if (candidate.is_absolute() && access(candidate.c_str(), X_OK) == 0) return candidate;
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    }
    return {};
}

std::filesystem::path find_program(const std::string& name, const std::filesystem::path& folder) {
    std::error_code ignored;
    const auto where =
        folder.empty() ? std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() : folder;
    if (access((where / name).c_str(), X_OK) == 0) return where / name;
    if (folder.empty())
        if (auto found = find_in_path(name); !found.empty()) return found;
    throw StartupError(
        "looking for the program " + name,
        "the program is not in " + where.string() + (folder.empty() ? " nor in PATH" : ""),
        "build the program: cmake --preset release && cmake --build --preset release --target " + name);
}

}  // namespace tact::launch
