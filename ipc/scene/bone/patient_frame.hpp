// Where the bone of a drilling scene lies in the patient, as the scan says.
//
// Frame    patient: mm from the scan's origin, x to the left, y to the back, z up (LPS)
// Section  PATI: 12 doubles, the axes column by column, then the origin. Absent if the scan states no orientation
// Thread   any
// Errors   StartupError: axes that are no rotation (a reflection would exchange left and right), a far origin
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "ipc/base/pose.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

struct PatientFrame {
    static constexpr double kFarMm = 1e5;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns: the model's x, y, z in the patient
    Vec3 origin_mm = Vec3::Zero();                       // model (0, 0, 0) in the patient

    [[nodiscard]] Vec3 patient_mm(const Vec3& model_m) const { return origin_mm + 1e3 * (axes * model_m); }
    [[nodiscard]] Vec3 model_m(const Vec3& patient_mm) const {
        return 1e-3 * (axes.transpose() * (patient_mm - origin_mm));
    }
};

// Where a direction in the patient points: L or R, P or A, H or F, the strongest first; components below a tenth of it are
// left out.
std::string patient_letters(const Vec3& direction);

void write_patient_frame(SceneWriter& out, const PatientFrame& frame);
std::optional<PatientFrame> read_patient_frame(const SceneFile& file);

}  // namespace tact
