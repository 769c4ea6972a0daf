// Where one frame lies in another, from points that were touched in both: tracker to screen, the hand's world to tracker.
//
// Method   least squares over rigid motions (Umeyama 1991), no scaling: metres stay metres
// Needs    three pairs or more that are no line; refused with the reason otherwise, never guessed
// Residual what is left of each pair, in metres; the worst one is named, and one that spoils the others
// Errors   as values with words, for a panel to show
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
    Vec3 from_m;  // in the frame that is to be placed, as that of the screen's glass
    Vec3 to_m;    // the same point in the frame it is placed in, as the tracker's
};

// What is left of the pairs is good, to be looked at, or refused. Both the root mean square and the worst have to be within
// 2 and 4 mm for green: about what a magnetic tracker leaves at arm's length, and less than an eye sees beside a tool. Within 5
// and 10 mm it can be worked with: amber.
inline constexpr double kGreenRmsM = 2e-3, kGreenWorstM = 4e-3, kAmberRmsM = 5e-3, kAmberWorstM = 10e-3;
enum class FitGrade : std::uint8_t { none, green, amber, red };
[[nodiscard]] FitGrade fit_grade(double rms_m, double worst_m);
[[nodiscard]] const char* fit_grade_text(FitGrade grade);  // "green", ...

struct RegistrationLimits {
    double spread_m_min =
        0.02;                   // root mean square of the points about their middle, along their longest axis
    double flatness_min = 0.1;  // second axis over the longest: below it is a line
    double residual_m_max = kAmberWorstM;  // of the worst pair
    double residual_m_rms = kAmberRmsM;
};

struct Registration {
    bool good = false;
    std::string refusal;  // why not, and what to do; empty if good
    Pose T_to_from;
    std::vector<double> residual_m;  // of each pair; empty where no motion was found
    double residual_m_rms = 0.0;
    double residual_m_max = 0.0;
    std::size_t worst_pair = 0;
    // By which the first frame's points had to be stretched to lie best on the second's; 1 where lengths agree.
    double stretch = 1.0;
    // The one without which the others fit: it is off them by at least 3 mm and three times what is left of their worst.
    std::optional<std::size_t> outlier;

    [[nodiscard]] FitGrade grade() const {
        return residual_m.empty() ? FitGrade::none : fit_grade(residual_m_rms, residual_m_max);
    }
};

[[nodiscard]] Registration register_points(std::span<const PointPair> pairs,
                                           const RegistrationLimits& limits = {});

// Where the tip of a pointer lies on its sensor, from poses of the sensor while the tip stood in one place and the pointer
// was turned about it, in two directions at least.
struct PivotFit {
    bool good = false;
    std::string refusal;
    Vec3 tip_sensor_m = Vec3::Zero();
    double residual_m_rms = 0.0;
};
[[nodiscard]] PivotFit fit_pivot(std::span<const Pose> T_frame_sensor);

}  // namespace tact
