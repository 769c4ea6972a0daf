// A child process of tact: finds the program beside tact, monitors it, and ends it in order.
//
// Own group    the child leads its own process group, so that a Ctrl-C at the terminal reaches only tact, which then
//              ends its children in order. If tact is killed, the kernel sends them SIGTERM.
// Ending       stop() sends SIGTERM; poll() resumes a stopped child and sends SIGKILL after the grace period. A child
//              is reaped once and its ending kept.
// Thread       all calls on one thread; the program must be single-threaded when a child is started.
// Not shared   tact-gui uses gui/base/child_job with posix_spawn(), because fork() would copy the page tables of a
//              large multi-threaded program. posix_spawn() can set neither the parent-death signal nor the cores, which
//              children need here.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/clock.hpp"

namespace tact::launch {

struct Ending {
    bool by_signal = false;
    int number = 0;       // exit code or signal
    bool asked = false;   // stop() was called before
    bool forced = false;  // SIGKILL was needed
    [[nodiscard]] bool clean() const { return !by_signal && number == 0; }
    [[nodiscard]] std::string text() const;  // "ended with exit code 1", "was killed by signal 9 (Killed)"
};

struct ChildSettings {
    std::vector<std::string> arguments;
    std::vector<std::pair<std::string, std::string>>
        environment;         // additional variables; an empty value removes a variable
    std::vector<int> cores;  // empty: the cores of tact
    int output_fd = -1;      // target of standard output and error; -1: those of tact
    int keep_fd = -1;        // stays open in the child under the same number
    Duration grace = std::chrono::seconds(3);
};

class Child {
public:
    // Throws StartupError if the program cannot be started.
    Child(std::string name, const std::filesystem::path& program, const ChildSettings& settings);
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();  // kills and reaps a running child

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] pid_t pid() const { return pid_; }
    // The ending, once the child has ended. Also sends the SIGCONT and SIGKILL that are due after stop().
    const std::optional<Ending>& poll();
    void stop();                                        // sends SIGTERM; later calls do nothing
    const std::optional<Ending>& wait(Duration limit);  // polls until the end of the child or of `limit`

private:
    void wake() const;

    std::string name_;
    Duration grace_;
    pid_t pid_ = -1;
    std::optional<Ending> ending_;
    std::optional<Instant> stop_at_;
    bool killed_ = false;
};

// The program of that name in `folder`; if `folder` is empty, beside the running tact, else in PATH. The StartupError
// names the places searched.
std::filesystem::path find_program(const std::string& name, const std::filesystem::path& folder = {});
// Searches PATH only; empty if not found.
std::filesystem::path find_in_path(const std::string& name);

}  // namespace tact::launch
