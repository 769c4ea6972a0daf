// A program run beside the frame loop: started, looked at once a frame, never waited for.
//
// Fails by  outcome: an exit code that is not 0, and the last lines that the program printed
// Ends      with this object: a program still running is killed. Where this process is killed the program
//           goes on: right for a save, which is asked for, bounded, and whole or absent; what is of use
//           to this process alone is told to end with it by its own option (tact-prep contour
//           --ends-with). posix_spawn() could not set that, and fork() would copy the page tables of a
//           big program.
// Thread    one; start() takes some hundred microseconds
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace tact {

struct ChildOutcome {
    int exit_code = 0;   // 128 + signal where one ended it
    std::string output;  // the last kOutputMax bytes of standard output and error
    [[nodiscard]] bool good() const { return exit_code == 0; }
};

class ChildJob {
public:
    static constexpr std::size_t kOutputMax = 4096;

    ChildJob() = default;
    ChildJob(const ChildJob&) = delete;
    ChildJob& operator=(const ChildJob&) = delete;
    ~ChildJob();

    // The program: a path, or a name that is looked for beside this program and then in PATH. Throws
    // StartupError where it cannot be started or another is still running.
    void start(const std::string& program, const std::vector<std::string>& arguments);
    [[nodiscard]] bool running() const { return pid_ > 0; }
    // The outcome, once, when the program has ended.
    [[nodiscard]] std::optional<ChildOutcome> poll();
    // What it printed up to now, the last kOutputMax bytes.
    [[nodiscard]] std::string output() const;
    // Asks it to end (SIGTERM); poll() tells when it has.
    void cancel() const;

private:
    pid_t pid_ = 0;
    int output_fd_ = -1;
};

}  // namespace tact
