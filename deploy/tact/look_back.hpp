// Looks back at the last seconds of a run while it goes on: has its flight recorder save them, and shows the file in a second window. From there a person
// can go on at a past moment: the run then changes to it, as to another scene.
//
// Thread   the launcher's only thread; never waits
#pragma once

#include <filesystem>
#include <optional>
#include <set>

#include "deploy/tact/child.hpp"
#include "deploy/tact/run_options.hpp"

namespace tact::launch {

class LookBack {
public:
    // into: the folder of requests to this run.
    LookBack(const RunOptions& options, std::filesystem::path into, std::filesystem::path scene)
        : options_(options), into_(std::move(into)), scene_(std::move(scene)) {}

    // recorder: the process of the flight recorder. Throws StartupError: it looks back already, or the recorder cannot be reached.
    void begin(double ago_s, pid_t recorder);
    // Shows the recording as soon as it is there. Throws StartupError if it does not come.
    void poll();
    void stop();

private:
    [[nodiscard]] std::optional<std::filesystem::path> new_recording();
    void show(const std::filesystem::path& recording);

    const RunOptions& options_;
    const std::filesystem::path into_, scene_;
    std::optional<double> ago_s_;  // while the recording is awaited
    std::set<std::filesystem::path> before_;
    Instant asked_at_{}, grown_at_{};
    std::uintmax_t bytes_ = 0;
    std::optional<Child> replay_;
};

}  // namespace tact::launch
