// Pose of one frame in another, from points touched in both: tracker to screen, the hand's world to tracker.
//
// Method   least squares over rigid motions (Umeyama 1991), no scaling: metres stay metres
// Needs    three pairs or more, not on a line; otherwise refused with the reason
// Residual of each pair, in metres; the result names the worst pair, and an outlier
// Errors   as values with text, for a panel to show
// Thread   any; it allocates
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

struct PointPair {
    Vec3 from_m;  // in the frame to be located, such as the screen's glass
    Vec3 to_m;    // the same point in the reference frame, such as the tracker's
};

// Grades of the residuals. Green: root mean square within 2 mm and worst within 4 mm, about what a magnetic tracker
// leaves at arm's length, and less than an eye notices beside a tool. Amber: within 5 and 10 mm, usable. Red:
// refused.
inline constexpr double kGreenRmsM = 2e-3, kGreenWorstM = 4e-3, kAmberRmsM = 5e-3, kAmberWorstM = 10e-3;
enum class FitGrade : std::uint8_t { none, green, amber, red };
[[nodiscard]] FitGrade fit_grade(double rms_m, double worst_m);
[[nodiscard]] const char* fit_grade_text(FitGrade grade);  // "green", ...

struct RegistrationLimits {
    double spread_m_min = 0.02;  // root mean square of the points about their mean, along their longest axis
    double flatness_min = 0.1;   // second axis over the longest: below it, a line
    double residual_m_max = kAmberWorstM;  // of the worst pair
    double residual_m_rms = kAmberRmsM;
};

struct Registration {
    bool good = false;
    std::string refusal;  // why not, and what to do; empty if good
    Pose T_to_from;
    std::vector<double> residual_m;  // of each pair; empty if no motion was found
    double residual_m_rms = 0.0;
    double residual_m_max = 0.0;
    std::size_t worst_pair = 0;
    // Scale of the first frame's points that fits the second's best; 1 if lengths agree.
    double stretch = 1.0;
    // The pair without which the others fit: its residual is at least 3 mm and three times their worst.
    std::optional<std::size_t> outlier;

    [[nodiscard]] FitGrade grade() const {
        return residual_m.empty() ? FitGrade::none : fit_grade(residual_m_rms, residual_m_max);
    }
};

[[nodiscard]] Registration register_points(std::span<const PointPair> pairs,
                                           const RegistrationLimits& limits = {});

// Position of a pointer's tip on its sensor, from poses of the sensor while the tip stood in one place and the
// pointer was tilted about it, in at least two directions.
struct PivotFit {
    bool good = false;
    std::string refusal;
    Vec3 tip_sensor_m = Vec3::Zero();
    double residual_m_rms = 0.0;
};
[[nodiscard]] PivotFit fit_pivot(std::span<const Pose> T_frame_sensor);

}  // namespace tact
