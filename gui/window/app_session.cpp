#include <utility>

#include "gui/window/app_parts.hpp"
#include "ipc/base/error.hpp"

namespace tact {

void GuiApp::follow_session() {
    state_.browser.can_save = content_ && controller_.attached();
    if (std::exchange(state_.browser.session_wanted, false) && state_.browser.can_save) {
        Session session;
        session.scene = content_->path;
        session.scene_checksum = content_->checksum;
        system().add_to(session);
        session.window = window_state_text(window_state());
        tell(session_saver_.save(std::move(session), state_.situation.bone));
    }
    const auto saved = session_saver_.poll();
    if (!saved) return;
    tell(*saved);
    if (saved->grade == Grade::good) browser_.remember(session_saver_.file());
}

}  // namespace tact
