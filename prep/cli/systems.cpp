#include "prep/cli/systems.hpp"

#include <algorithm>
#include <stdexcept>

#include "prep/docking/dock_command.hpp"
#include "prep/docking/report_docking.hpp"
#include "prep/drilling/drill_command.hpp"
#include "prep/drilling/report_drilling.hpp"
#include "prep/field/field_command.hpp"
#include "prep/field/report_field.hpp"
#include "prep/surface/report_surface.hpp"
#include "prep/surface/touch_command.hpp"

namespace tact {
namespace {

constexpr PrepSystem kSystems[] = {
    {SceneKind::docking, add_dock, report_docking, add_examine_dock},
    {SceneKind::surface, add_touch, report_surface, nullptr},
    {SceneKind::drilling, add_drill, report_drilling, add_examine_drill},
    {SceneKind::field, add_field, report_field, nullptr},
};

}  // namespace

std::span<const PrepSystem> prep_systems() { return kSystems; }

const PrepSystem& prep_system(SceneKind kind) {
    const auto* const system = std::find_if(std::begin(kSystems), std::end(kSystems),
                                            [&](const PrepSystem& s) { return s.kind == kind; });
    if (system == std::end(kSystems))
        throw std::logic_error("scene kind without a row in prep/cli/systems.cpp");
    return *system;
}

}  // namespace tact
