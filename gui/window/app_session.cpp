#include <spdlog/spdlog.h>

#include <utility>

#include "gui/window/app_parts.hpp"
#include "ipc/base/error.hpp"

namespace tact {

// The session of the scene that is shown, as it is now.
Session GuiApp::present_session() const {
    Session session;
    session.scene = std::filesystem::absolute(content_->path);
    session.scene_checksum = content_->checksum;
    systems_[shown_]->add_to(session);
    session.window = window_state_text(window_state());
    return session;
}

// A scene with more structures is baked: continues in it with the bodies as they are now, not as they were before.
void GuiApp::follow_added_scene() {
    if (const std::string scene = std::exchange(state_.browser.added_scene, {}); !scene.empty() && content_)
        scene_extender_.start(present_session(), scene, options_.scene_switch);
    const auto extended = scene_extender_.poll();
    if (!extended) return;
    if (extended->error.empty()) return browser_.open_scene(extended->session, state_.browser);
    spdlog::warn("{}", extended->error);
    state_.browser.message = extended->error;
    state_.browser.message_grade = Grade::bad;
}

void GuiApp::follow_session() {
    follow_added_scene();
    state_.browser.can_save = content_ && controller_.attached();
    if (std::exchange(state_.browser.session_wanted, false) && state_.browser.can_save) {
        tell(session_saver_.save(present_session(), state_.situation.bone));
    }
    const auto saved = session_saver_.poll();
    if (!saved) return;
    tell(*saved);
    if (saved->grade == Grade::good) browser_.remember(session_saver_.file());
}

}  // namespace tact
