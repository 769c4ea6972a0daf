#include "gui/window/session_saver.hpp"

#include <utility>

#include "gui/base/output_folder.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {

StatusText SessionSaver::save(Session session, bool bone) {
    if (saving_) return {Grade::watch, "a session is being saved already"};
    try {
        file_ = new_output("session", kSessionEnding);
        if (bone) {
            session.bone = file_;
            session.bone.replace_extension(".bone");
            bone_.start(program_, {"--bone", session.bone.string(), "--session", session_, "--seconds", "0.3",
                                   "--wait", "5", "--quiet"});
        }
        saving_ = std::move(session);
        return {Grade::unknown, "saving the session"};
    } catch (const StartupError& e) {
        return {Grade::bad, e.what()};
    }
}

void SessionSaver::write() {
    // A bone that is as baked has no file.
    if (!std::filesystem::exists(saving_->bone)) saving_->bone.clear();
    const std::string text = session_text(*saving_, file_);
    static_cast<void>(read_session_text(text, file_));  // what cannot be read back is not saved
    write_whole_file(file_, text);
}

std::optional<StatusText> SessionSaver::poll() {
    if (!saving_) return std::nullopt;
    if (const auto copied = bone_.poll(); copied && !copied->good()) {
        saving_.reset();
        return StatusText{Grade::bad,
                          "the session was not saved, because its bone was not: " + copied->output};
    }
    if (bone_.running()) return std::nullopt;
    StatusText said{Grade::good, "saved the session as " + file_.string()};
    try {
        write();
    } catch (const StartupError& e) {
        said = {Grade::bad, e.what()};
    }
    saving_.reset();
    return said;
}

}  // namespace tact
