// The button Record: a tact-record of the window's session, from now until the button, the window or the run ends.
//
// A recording that begins in the middle of a run is replayed, but not to the bit (ipc/record/RECORDING.md).
// Thread   frame thread
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "gui/base/child_job.hpp"
#include "gui/dashboard/status_text.hpp"

namespace tact {

class RunRecorder {
public:
    // tact-record: a path, or a name as of ChildJob.
    explicit RunRecorder(std::string session, std::string program = "tact-record")
        : session_(std::move(session)), program_(std::move(program)) {}

    [[nodiscard]] bool running() const { return job_.running(); }
    // Starts, or ends the recording.
    [[nodiscard]] StatusText toggle();
    // Once, after a recording has ended: its file, or why there is none.
    [[nodiscard]] std::optional<StatusText> poll();
    // Ends a recording and waits for its file, as the window closes.
    void finish();

private:
    std::string session_, program_;
    ChildJob job_;
    std::filesystem::path file_;
};

}  // namespace tact
