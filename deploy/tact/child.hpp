// A program that tact started: found beside tact, watched, and ended in order.
//
// Own group    the child is the leader of its own process group, so that a Ctrl-C at the terminal reaches
//              tact alone, which then ends its children in order. If tact itself is killed, the kernel sends
//              them SIGTERM.
// Ending       stop() asks with SIGTERM; poll() wakes a child that is halted, and follows with SIGKILL once
//              the grace is over. A child is reaped once and its ending kept.
// Thread       all on one thread; the program must be single-threaded when a child is started.
// Not shared   tact-gui has gui/base/child_job: posix_spawn(), as fork() would copy the page tables of a big program with
//              threads; it can set neither the signal of the parent's death nor cores, which children here need.
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
    bool asked = false;   // stop() came first
    bool forced = false;  // and SIGKILL was needed
    [[nodiscard]] bool clean() const { return !by_signal && number == 0; }
    [[nodiscard]] std::string text() const;  // "ended with exit code 1", "was killed by signal 9 (Killed)"
};

struct ChildSettings {
    std::vector<std::string> arguments;
    std::vector<std::pair<std::string, std::string>>
        environment;         // added; an empty value removes the variable
    std::vector<int> cores;  // empty: as tact itself
    int output_fd = -1;      // where standard output and error go; -1: as tact's own
    int keep_fd = -1;        // stays open in the child under the same number
    Duration grace = std::chrono::seconds(3);
};

class Child {
public:
    // Throws StartupError where the program cannot be started.
    Child(std::string name, const std::filesystem::path& program, const ChildSettings& settings);
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();  // kills and reaps what is still running

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] pid_t pid() const { return pid_; }
    // The ending, once there is one. Also sends the SIGCONT and the SIGKILL that are due after stop().
    const std::optional<Ending>& poll();
    void stop();                                        // SIGTERM now; again: nothing
    const std::optional<Ending>& wait(Duration limit);  // polls until ended or the time is over

private:
    void wake() const;

    std::string name_;
    Duration grace_;
    pid_t pid_ = -1;
    std::optional<Ending> ending_;
    std::optional<Instant> stop_at_;
    bool killed_ = false;
};

// The program of that name in `folder`, or where that is empty beside the running tact, else in PATH; throws
// StartupError with where it looked.
std::filesystem::path find_program(const std::string& name, const std::filesystem::path& folder = {});
// In PATH alone; empty: not there.
std::filesystem::path find_in_path(const std::string& name);

}  // namespace tact::launch
