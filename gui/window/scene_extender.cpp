#include "gui/window/scene_extender.hpp"

#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_switch.hpp"
#include "ipc/scene/session/extend_session.hpp"

namespace tact {

void SceneExtender::start(Session shown, std::filesystem::path scene, std::filesystem::path folder) {
    if (writing_.valid()) return;
    writing_ = std::async(
        std::launch::async,
        [shown = std::move(shown), scene = std::move(scene), folder = std::move(folder)]() -> Outcome {
            Outcome out{folder / kAddedSession, {}};
            const auto back = folder / kShownSession;
            try {
                const Session more =
                    extended_session(shown, SceneFile::open(shown.scene), SceneFile::open(scene));
                write_whole_file(back, session_text(shown, back));
                write_whole_file(out.session, session_text(more, out.session));
            } catch (const StartupError& e) {
                out.error = e.what();
            }
            return out;
        });
}

std::optional<SceneExtender::Outcome> SceneExtender::poll() {
    if (!writing_.valid() || writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    return writing_.get();
}

}  // namespace tact
