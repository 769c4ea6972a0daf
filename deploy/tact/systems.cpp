#include "deploy/tact/systems.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "deploy/tact/docking/docking.hpp"
#include "deploy/tact/drilling/drilling.hpp"
#include "deploy/tact/field/field.hpp"
#include "deploy/tact/surface/surface.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact::launch {

std::span<const System> systems() {
    static const System all[] = {
        {SceneKind::docking, add_docking_commands, add_docking_demo, docking_controller_options(),
         docking_info, open_docking_run, docking_summary},
        {SceneKind::surface, add_touch, add_touch_demo, surface_controller_options(), surface_info,
         open_surface_run, surface_summary},
        {SceneKind::drilling, add_drill, add_drill_demo, drilling_controller_options(), drilling_info,
         open_drilling_run, drilling_report_summary},
        {SceneKind::field, add_field, add_field_demo, {}, field_info, open_field_run, field_summary},
    };
    return all;
}

const System& system_of(SceneKind kind) {
    const std::span<const System> all = systems();
    const auto system = std::find_if(all.begin(), all.end(), [&](const System& s) { return s.kind == kind; });
    if (system == all.end()) throw std::logic_error("scene kind without a row in deploy/tact/systems.cpp");
    return *system;
}

const System& system_of(const SceneFile& scene) { return system_of(read_meta(scene).kind); }

}  // namespace tact::launch
