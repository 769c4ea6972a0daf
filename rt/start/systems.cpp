#include "rt/start/systems.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>

#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/structure.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/force/field/field_model.hpp"
#include "rt/force/pointer_model.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "rt/start/resume_bone.hpp"
#include "rt/start/start_bodies.hpp"
#include "rt/start/start_drill.hpp"
#include "rt/start/visual_paths.hpp"

namespace tact {
namespace {

// Null: the system has no model for the hand.
using Model = std::unique_ptr<ForceModel>;

template <class Published, class Topic>
Model published(std::unique_ptr<Published> model, Latest<Topic>& topic) {
    model->publish_to(topic);
    return model;
}

Model make_docking(const SystemInput& in, SharedScene* /*shared*/, std::uint32_t hand) {
    if (hand > 0) return nullptr;
    const StartOptions& o = in.options;
    DockingSettings s{.start_offset_m = o.start_offset_a * kAngstromM,
                      .start_rotation_rad = o.start_rotation_deg * kDegreeRad,
                      .seed = o.seed,
                      .flexible = o.flexible == "on"};
    if (!o.poses.empty()) {
        std::vector<std::string> names;
        const SceneMeta meta = read_meta(in.scene);
        for (std::uint32_t i = 0; i < meta.body_count; ++i) names.push_back(read_structure(in.scene, i).name);
        s.bodies = read_start_bodies(o.poses, names);
    }
    if (o.copies > 1) s.more_bodies = copies_about(read_grid(in.scene), o.copies);
    return published(load_docking_model(in.scene, s), in.region.shapes);
}

Model make_surface(const SystemInput& in, SharedScene* /*shared*/, std::uint32_t hand) {
    if (hand > 0) return nullptr;
    SurfaceSettings s = in.options.surface;
    s.radius_m = 1e-3 * in.options.tool_radius_mm;
    for (std::size_t i = 0; i < kSurfaceModeNames.size(); ++i)
        if (in.config.surface.mode == kSurfaceModeNames[i]) s.mode = static_cast<SurfaceMode>(i);
    if (has_touch_tool(in.scene))
        return published(load_tool_model(in.scene, s, expected_period_s(in.config)), in.region.touch);
    return published(load_surface_model(in.scene, s), in.region.touch);
}

Model make_drill(const SystemInput& in, SharedScene* shared, std::uint32_t hand) {
    return load_drill(in.scene, in.config, in.options.seed, dynamic_cast<DrillScene&>(*shared), hand);
}

Model make_field(const SystemInput& in, SharedScene* /*shared*/, std::uint32_t hand) {
    return hand > 0 ? nullptr : load_field_model(in.scene);
}

void resume(const SystemInput& in, DrillBone& bone) {
    const std::string& file = in.options.resume;
    if (!in.options.resume_identity.empty() && file_identity(file) != in.options.resume_identity)
        throw StartupError("starting with the bone of " + file,
                           "the file changed since this run was recorded",
                           "restore the file, or record another run");
    const DrilledBoneSummary sum = resume_bone(file, in.scene, bone);
    spdlog::info("bone drilled before: {} cuts, {:.1f} % of its bricks changed", sum.strokes,
                 100.0 *
                     static_cast<double>(std::count_if(bone.revision.begin(), bone.revision.end(),
                                                       [](std::uint32_t r) { return r != 0; })) /
                     static_cast<double>(bone.revision.size()));
    if (sum.bytes_left_out > 0)
        spdlog::warn("{}: the last {} bytes were not written whole and are left out", file,
                     sum.bytes_left_out);
}

std::unique_ptr<SharedScene> share_bone(const SystemInput& in) {
    auto shared = std::make_unique<DrillScene>(in.scene, in.config, in.region);
    if (!in.options.resume.empty()) resume(in, shared->bone());
    return shared;
}

std::string summary_of_drilling(const RtRegion& region) {
    DrillTopic t{};
    if (!region.drill.read(t)) return {};
    return fmt::format("{:.1f} mm3 of bone removed",
                       1e9 * static_cast<double>(t.removed_levels) * t.level_m3);
}

constexpr std::array kSystems{
    System{
        .kind = SceneKind::docking, .name = "docking", .visual_paths = kDockingPaths, .make = make_docking},
    System{
        .kind = SceneKind::surface, .name = "surface", .visual_paths = kSurfacePaths, .make = make_surface},
    System{.kind = SceneKind::drilling,
           .name = "drilling",
           .visual_paths = kBonePaths,
           .make = make_drill,
           .share = share_bone,
           .drive = drill_switch,
           .summary = summary_of_drilling},
    System{.kind = SceneKind::field, .name = "field", .visual_paths = kSurfacePaths, .make = make_field},
};

}  // namespace

std::span<const System> systems() { return kSystems; }

const System& system_of(SceneKind kind) {
    for (const System& s : kSystems)
        if (s.kind == kind) return s;
    throw StartupError("choosing the force model", "this controller does not support this kind of scene",
                       "use the controller of the version that baked the scene");
}

SceneSystem::SceneSystem(const SystemInput& input)
    : input_(input),
      system_(system_of(read_meta(input.scene).kind)),
      shared_(system_.share != nullptr ? system_.share(input) : nullptr) {
    if (!input.options.resume.empty() && shared_ == nullptr)
        throw StartupError("starting with the bone of " + input.options.resume, "this scene has no bone",
                           "remove --resume, or give the scene in which the bone was drilled");
}

std::unique_ptr<ForceModel> SceneSystem::make_model(std::uint32_t hand) const {
    std::unique_ptr<ForceModel> model = system_.make(input_, shared_.get(), hand);
    if (model == nullptr) model = std::make_unique<PointerModel>();
    return model;
}

DriveInput SceneSystem::drive(std::uint32_t hand) const {
    return system_.drive != nullptr ? system_.drive(input_.config, hand) : DriveInput{};
}

std::string SceneSystem::summary() const {
    return system_.summary != nullptr ? system_.summary(input_.region) : std::string{};
}

}  // namespace tact
