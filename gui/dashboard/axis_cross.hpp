// The cross of axes in a corner of the 3D view: those of the scene, or the sides of a patient (L R P A H F) where they are
// known.
//
// Thread   any
#pragma once

#include <vector>

#include "gui/dashboard/dashboard_state.hpp"

namespace tact {

struct AxisEnd {
    const char* name;
    int axis;           // 0, 1, 2; both ends of one have its colour
    bool negative;      // R, A or F
    float x, y, depth;  // of a cross of length 1; x to the right, y up, depth towards the eye
};

// The farthest first, so that near ones are drawn over them.
[[nodiscard]] std::vector<AxisEnd> axis_cross(const float (&eye_axes)[3][3], const SceneState& scene);

}  // namespace tact
