#include "gui/window/describe.hpp"

#include "ipc/topics/text.hpp"

namespace tact {

SceneState describe(const SceneContent& content) {
    SceneState state;
    state.loaded = true;
    state.file = content.path.filename().string();
    state.title = content.meta.title[0] != '\0' ? content.meta.title : state.file;
    state.vertices_max = content.mesh ? content.mesh->vertices() : 0;
    return state;
}

EventLine describe(const EventTopic& event, const LevelsTopic* levels) {
    EventLine line{event.taken_at_ns, event.code, 1, event_text(event, levels), Grade::good};
    switch (static_cast<EventCode>(event.code)) {
        case EventCode::fault_latched:
            line.grade = Grade::bad;
            break;
        case EventCode::overrun:
        case EventCode::force_limited:
        case EventCode::torque_limited:
        case EventCode::slew_limited:
        case EventCode::gui_detached:
        case EventCode::gui_silent:
        case EventCode::input_refused:
        case EventCode::device_watchdog:
            line.grade = Grade::watch;
            break;
        default:
            break;
    }
    return line;
}

}  // namespace tact
