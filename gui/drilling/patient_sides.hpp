// The patient's sides for the cross of axes in the 3D view.
//
// Thread   any
#pragma once

#include <optional>

#include "gui/dashboard/dashboard_state.hpp"
#include "ipc/scene/bone/patient_frame.hpp"

namespace tact {

// Left, back and head are the rows of the matrix that turns model axes into the patient's.
inline void show_sides(const std::optional<PatientFrame>& patient, SceneState& scene) {
    scene.patient = patient.has_value();
    for (int i = 0; i < 3 && patient; ++i)
        for (int k = 0; k < 3; ++k) scene.patient_axes[i][k] = static_cast<float>(patient->axes(i, k));
}

}  // namespace tact
