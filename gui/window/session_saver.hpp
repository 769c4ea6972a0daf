// Saves a session into the output folder; before that, where there is bone, a tact-record copies it as it is at this moment.
//
// Thread   frame thread
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "gui/base/child_job.hpp"
#include "gui/dashboard/status_text.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact {

class SessionSaver {
public:
    // tact-record: a path, or a name as of ChildJob.
    explicit SessionSaver(std::string session, std::string program = "tact-record")
        : session_(std::move(session)), program_(std::move(program)) {}

    // bone: the controller drills. poll() reports the end.
    [[nodiscard]] StatusText save(Session session, bool bone);
    // Once, after a session was saved, or why it was not.
    [[nodiscard]] std::optional<StatusText> poll();
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }  // of the last save()

private:
    void write();

    std::string session_, program_;
    ChildJob bone_;
    std::filesystem::path file_;
    std::optional<Session> saving_;  // until its bone is copied
};

}  // namespace tact
