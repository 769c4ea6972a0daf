#include "gui/input/rate_control.hpp"

#include <algorithm>
#include <cmath>

namespace tact {
namespace {

double rate_bounded(double value, double least, double most, double otherwise) {
    return std::isfinite(value) ? std::clamp(value, least, most) : otherwise;
}

double frame_of(double frame_s) { return rate_bounded(frame_s, 0.0, RateMotion::kFrameMost_s, 0.0); }
double speed_of(double speed) {
    return rate_bounded(speed, InputChoice::kSpeedLeast, InputChoice::kSpeedMost, 1.0);
}

}  // namespace

double shaped(double deflection, const InputChoice& choice) noexcept {
    if (!std::isfinite(deflection)) return 0.0;
    const double zone = rate_bounded(choice.dead_zone, InputChoice::kDeadZoneLeast,
                                     InputChoice::kDeadZoneMost, InputChoice{}.dead_zone),
                 curve = rate_bounded(choice.curve, InputChoice::kCurveLeast, InputChoice::kCurveMost,
                                      InputChoice{}.curve);
    const double size = std::min(std::abs(deflection), 1.0);
    if (size <= zone) return 0.0;
    return std::copysign(std::pow((size - zone) / (1.0 - zone), curve), deflection);
}

Deflection shaped(const Deflection& raw, const InputChoice& choice) noexcept {
    Deflection out;
    for (int i = 0; i < 3; ++i) {
        out.move[i] = shaped(raw.move[i], choice);
        out.turn[i] = shaped(raw.turn[i], choice);
    }
    return out;
}

RateMotion hand_motion(const Deflection& d, double speed, double frame_s) noexcept {
    const double time = speed_of(speed) * frame_of(frame_s);
    return {time * RateMotion::kHand_m_s * d.move, time * RateMotion::kHandTurn_rad_s * d.turn};
}

RateMotion view_motion(const Deflection& d, double speed, double frame_s) noexcept {
    const double time = speed_of(speed) * frame_of(frame_s);
    const Vec3 each(RateMotion::kViewPan_1_s, RateMotion::kViewPan_1_s, RateMotion::kViewZoom_1_s);
    return {time * each.cwiseProduct(d.move), time * RateMotion::kViewTurn_rad_s * d.turn};
}

InputSample RestGate::pass(const InputSample& sample) {
    if (!sample.present || sample.connection != connection_) open_ = false;
    connection_ = sample.connection;
    if (sample.present && sample.deflection.rests() && sample.buttons == 0) open_ = true;
    if (open_) return sample;
    InputSample rest;
    rest.present = sample.present;
    rest.connection = sample.connection;
    return rest;
}

}  // namespace tact
