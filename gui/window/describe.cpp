#include "gui/window/describe.hpp"

#include "ipc/topics/text.hpp"

namespace tact {

SceneState describe(const SceneContent& content) {
    SceneState state;
    state.loaded = true;
    state.file = content.path.filename().string();
    state.title = content.meta.title[0] != '\0' ? content.meta.title : state.file;
    state.contour = content.meta.contour;
    state.map_sigma = content.meta.map_sigma;
    state.contour_sigma = (content.meta.contour - content.meta.map_mean) / content.meta.map_sigma;
    state.resolution_m = content.meta.resolution_m;
    state.vertices_max = content.mesh ? content.mesh->vertices() : 0;
    state.voxels = content.grid.size;
    return state;
}

EventLine describe(const EventTopic& event) {
    EventLine line{event.taken_at_ns, event.code, 1, event_text(event), Grade::good};
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
            line.grade = Grade::watch;
            break;
        default:
            break;
    }
    return line;
}

}  // namespace tact
