#include "gui/window/systems.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "gui/docking/contour_child.hpp"
#include "gui/docking/docking_content.hpp"
#include "gui/docking/docking_system.hpp"
#include "gui/drilling/bone_content.hpp"
#include "gui/drilling/drilling_system.hpp"
#include "gui/field/field_content.hpp"
#include "gui/field/field_system.hpp"
#include "gui/surface/surface_content.hpp"
#include "gui/surface/surface_system.hpp"

namespace tact {
namespace {

std::unique_ptr<SceneSystem> make_docking(const GuiOptions& options) {
    return std::make_unique<DockingSystem>(options.contours);
}

RefineContour refine_docking(std::shared_ptr<const SceneContent> content) {
    return refine_by_child(std::move(content));
}

std::unique_ptr<SceneSystem> make_surface(const GuiOptions& options) {
    static_cast<void>(options);
    return std::make_unique<SurfaceSystem>();
}

std::unique_ptr<SceneSystem> make_drilling(const GuiOptions& options) {
    return std::make_unique<DrillingSystem>(DrillingOptions{
        options.report, options.particles, options.near_burr, options.mute, options.training});
}

std::unique_ptr<SceneSystem> make_field(const GuiOptions& options) {
    static_cast<void>(options);
    return std::make_unique<FieldSystem>();
}

std::unique_ptr<SceneStart> start_drilling(const SceneContent& content) {
    return std::make_unique<DrillStart>(content);
}

constexpr std::array kRows{
    SystemRow{SceneKind::docking, KeyWhen::bodies, make_docking, read_docking, nullptr, refine_docking},
    SystemRow{SceneKind::surface, KeyWhen::always, make_surface, read_surface_content, nullptr, nullptr},
    SystemRow{SceneKind::drilling, KeyWhen::bone, make_drilling, read_bone_content, start_drilling, nullptr},
    SystemRow{SceneKind::field, KeyWhen::always, make_field, read_field_content, nullptr, nullptr},
};

}  // namespace

std::span<const SystemRow> system_rows() { return kRows; }

const SystemRow& system_row(SceneKind kind) {
    const auto* const found =
        std::find_if(kRows.begin(), kRows.end(), [kind](const SystemRow& row) { return row.kind == kind; });
    return found != kRows.end() ? *found : kRows.front();
}

}  // namespace tact
