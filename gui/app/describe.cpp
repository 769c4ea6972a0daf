#include "gui/app/describe.hpp"

#include "ipc/topics/text.hpp"

namespace tact {

SceneFacts describe(const SceneContent& content) {
    SceneFacts facts;
    facts.loaded = true;
    facts.file = content.path.filename().string();
    facts.title = content.meta.title[0] != '\0' ? content.meta.title : facts.file;
    facts.contour = content.meta.contour;
    facts.map_sigma = content.meta.map_sigma;
    facts.contour_sigma = (content.meta.contour - content.meta.map_mean) / content.meta.map_sigma;
    facts.resolution_m = content.meta.resolution_m;
    facts.vertices_max = content.mesh ? content.mesh->vertices() : 0;
    facts.bodies = content.bodies.size();
    for (const Structure& s : content.bodies) facts.atoms += s.size();
    facts.voxels = content.grid.size;
    facts.surface = content.meta.kind == SceneKind::surface;
    facts.bone = content.meta.kind == SceneKind::drilling;
    if (content.bone) {
        facts.voxels = content.bone->volume.bricks.size;
        facts.voxel_m = content.bone->volume.bricks.voxel_m;
    }
    return facts;
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
