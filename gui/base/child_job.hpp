// Runs a program in the background: start it, poll it once a frame, never wait for it.
//
// Fails by  outcome: a nonzero exit code and the last lines of the program's output
// Ends      the destructor kills a program that still runs. If this process is killed, the program continues:
//           this is right for a save, which the user requested, takes bounded time, and is written completely or
//           not at all. A program of use to this process alone takes an option that ends it with this process
//           (tact-prep contour --ends-with): posix_spawn() cannot set this, and fork() would copy the page
//           tables of a large process.
// Thread    one; start() takes a few hundred microseconds
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace tact {

struct ChildOutcome {
    int exit_code = 0;   // 128 + signal number if a signal ended it
    std::string output;  // the last kOutputMax bytes of standard output and error
    [[nodiscard]] bool good() const { return exit_code == 0; }
};

class ChildJob {
public:
    static constexpr std::size_t kOutputMax = 65536;

    ChildJob() = default;
    ChildJob(const ChildJob&) = delete;
    ChildJob& operator=(const ChildJob&) = delete;
    ~ChildJob();

    // The program: a path, or a name searched beside this program and then in PATH. Throws StartupError if it cannot
    // be started or another one still runs.
    void start(const std::string& program, const std::vector<std::string>& arguments);
    [[nodiscard]] bool running() const { return pid_ > 0; }
    // Returns the outcome once, after the program has ended.
    [[nodiscard]] std::optional<ChildOutcome> poll();
    // Output so far, at most the last kOutputMax bytes.
    [[nodiscard]] std::string output() const;
    // Requests its end (SIGTERM); poll() reports when it has ended.
    void cancel() const;

private:
    pid_t pid_ = 0;
    int output_fd_ = -1;
};

}  // namespace tact
