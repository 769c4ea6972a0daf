#include "rt/start/start_model.hpp"

#include <spdlog/spdlog.h>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/pointer_model.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "rt/start/start_bodies.hpp"
#include "rt/start/start_drill.hpp"

namespace tact {
namespace {

DockingSettings docking_settings(const StartOptions& o, const SceneFile& scene) {
    DockingSettings s{.start_offset_m = o.start_offset_a * kAngstromM,
                      .start_rotation_rad = o.start_rotation_deg * kDegreeRad,
                      .seed = o.seed};
    if (!o.poses.empty()) {
        std::vector<std::string> names;
        const SceneMeta meta = read_meta(scene);
        for (std::uint32_t i = 0; i < meta.body_count; ++i) names.push_back(read_structure(scene, i).name);
        s.bodies = read_start_bodies(o.poses, names);
    }
    if (o.copies > 1) s.more_bodies = copies_about(read_grid(scene), o.copies);
    return s;
}

std::unique_ptr<ForceModel> load_tool_in_bone(const SceneFile& scene, SceneBone& bone,
                                              DrillSettings settings) {
    const SceneMeta meta = read_meta(scene);
    if (fit_to_voxels(settings, meta, bone.bone().octree.bricks()))
        spdlog::warn("{} of {:.2f} mm is felt, as thin as the voxels allow",
                     settings.tool.cuts ? "a shaft" : "a suction tube", 2e3 * settings.tool.shaft_radius_m);
    return std::make_unique<DrillModel>(meta, bone.bone(), settings);
}

}  // namespace

std::unique_ptr<ForceModel> load_model(const SceneFile& scene, SceneBone* bone, const StartOptions& o,
                                       const RtConfig& config) {
    if (read_meta(scene).kind == SceneKind::surface) {
        SurfaceSettings settings = o.surface;
        settings.radius_m = 1e-3 * o.tool_radius_mm;
        for (std::size_t i = 0; i < kSurfaceModeNames.size(); ++i)
            if (config.surface.mode == kSurfaceModeNames[i]) settings.mode = static_cast<SurfaceMode>(i);
        if (has_touch_tool(scene)) return load_tool_model(scene, settings);
        return load_surface_model(scene, settings);
    }
    if (bone != nullptr) return load_tool_in_bone(scene, *bone, burr_settings(config, o.seed));
    return load_docking_model(scene, docking_settings(o, scene));
}

std::unique_ptr<ForceModel> load_second(const SceneFile& scene, SceneBone* bone, const StartOptions& o,
                                        const RtConfig& config) {
    if (bone == nullptr) return std::make_unique<PointerModel>();
    return load_tool_in_bone(scene, *bone, suction_tube_settings(config, o.seed));
}

}  // namespace tact
