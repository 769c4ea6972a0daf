// Where one frame lies in another, from points that were touched in both: tracker to screen, tracker to
// device.
//
// Method   least squares over rigid motions (Umeyama 1991), no scaling: metres stay metres
// Needs    three pairs or more that are no line; refused with the reason otherwise, never guessed
// Residual what is left of the pairs, in metres; the worst one is named
// Errors   as values with words, for a command or a panel to show
// Thread   any but the servo's: it allocates
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/pose.hpp"

namespace tact {

struct PointPair {
    Vec3 from_m;  // in the frame that is to be placed, as the tracker's
    Vec3 to_m;    // the same point in the frame it is placed in, as the screen's
};

struct RegistrationLimits {
    double spread_m_min =
        0.02;                   // root mean square of the points about their middle, along their longest axis
    double flatness_min = 0.1;  // second axis over the longest: below it is a line
    double residual_m_max = 0.01;  // of the worst pair
};

struct Registration {
    bool good = false;
    std::string refusal;  // why not, and what to do; empty if good
    Pose T_to_from;
    double residual_m_rms = 0.0;
    double residual_m_max = 0.0;
    std::size_t worst_pair = 0;
};

[[nodiscard]] Registration register_points(std::span<const PointPair> pairs,
                                           const RegistrationLimits& limits = {});

}  // namespace tact
