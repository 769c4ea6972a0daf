#include <spdlog/spdlog.h>

#include <filesystem>
#include <utility>

#include "gui/window/app_parts.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_switch.hpp"

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

// A window that continues with one more structure can go back to the session before, and from there to this one: both are in the
// launcher's folder until another structure is added.
void GuiApp::follow_taking_back() {
    AddedStructure& added = state_.added;
    if (!added_examined_ && content_) {
        added_examined_ = true;
        std::error_code none;
        const auto is = [&](const char* name) {
            return !options_.scene_switch.empty() && options_.session_opened &&
                   options_.session_opened->scene_checksum == content_->checksum &&
                   std::filesystem::equivalent(options_.session_file,
                                               std::filesystem::path(options_.scene_switch) / name, none);
        };
        const auto there = [&](const char* name) {
            return std::filesystem::exists(std::filesystem::path(options_.scene_switch) / name, none);
        };
        added.can_take_back = is(kAddedSession) && there(kShownSession);
        added.can_add_again = is(kShownSession) && there(kAddedSession);
    }
    const bool back = std::exchange(added.take_back_wanted, false) && added.can_take_back,
               again = std::exchange(added.add_again_wanted, false) && added.can_add_again;
    if (!back && !again) return;
    tell({Grade::unknown, back ? "taking back the added structure" : "adding the structure again"});
    browser_.open_scene(std::filesystem::path(options_.scene_switch) / (back ? kShownSession : kAddedSession),
                        state_.browser);
}

void GuiApp::follow_session() {
    follow_added_scene();
    follow_taking_back();
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
