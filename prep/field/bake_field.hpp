// Bakes a potential field: the grid, and the gain at which its gradient is a force that a hand can hold.
//
// Force     F = -gain * grad(phi). The gain gives force_n_max at the largest gradient inside the box (central
//           differences), or less if the stiffness would otherwise exceed stiffness_n_m_max anywhere in the box.
// Drawing   the equipotential surfaces that enclose the lowest and the highest tenth of the values
// Place     the box's longest edge is size_m wide in hand space, and its centre is the centre of the workspace
// Fails by  StartupError; Cancelled when `progress` returns false. Writes no file.
// Repeats   the same input gives the same sections.
#pragma once

#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/field/field.hpp"
#include "ipc/scene/file/scene_meta.hpp"

namespace tact {

struct FieldInput {
    std::string title, unit;
    DensityGrid grid;               // values in `unit`
    std::vector<std::string> note;  // lines "key: value"
    double size_m = 0.15;
    double force_n_max = 2.0;
    double stiffness_n_m_max = 800.0;
    double probe_radius_m = 0.002;         // in hand space
    std::uint32_t vertices_max = 200'000;  // of the drawn surfaces
};

struct BakedField {
    SceneMeta meta{};
    FieldMeta field{};
    std::string note;
    std::size_t vertices = 0;  // of the drawn surfaces
};

[[nodiscard]] BakedField bake_field(const FieldInput& input, SceneWriter& out, const Progress& progress = {});

}  // namespace tact
