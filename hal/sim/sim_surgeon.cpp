#include "hal/sim/sim_surgeon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ipc/base/random.hpp"

namespace tact {
namespace {

constexpr double kWaitS = 0.7;    // until the force has faded in
constexpr double kForgetS = 0.5;  // without power
constexpr double kSeekM_S = 0.04, kMoveM_S = 0.06;
constexpr double kSeekPressN = 0.8, kFeltN = 0.3, kFeltS = 0.02;
constexpr double kSuctionTubeContactN = 0.1, kSuctionTubePressN = 0.25, kSuctionTubeAboveM = 5e-4;
constexpr double kDownS = 0.8, kStrokesS = 4.4;                   // of a series; then it lifts
constexpr double kStrokeHz = 0.9, kStroke = 0.55, kAside = 0.45;  // amplitudes in radii of the bowl
constexpr double kLiftM = 6e-3;
constexpr double kFeedM_S = 5e-4, kBowlFirstM = 3e-3, kWidenM_S = 3e-4;
// Distance of the suction tube from the middle: at the start, and in bowl radii while the burr approaches.
constexpr double kBesideM = 5e-3, kBesideFrom = 0.95, kBesideTo = 1.4, kInTheMiddle = 0.3;
constexpr double kAsideM = 8e-3;  // after a miss, times the root of the number of misses
constexpr double kStiffnessN_M = 250.0, kDampingN_S_M = 8.0, kSidewaysMostN = 3.0, kUpMostN = 2.0;
constexpr double kTurnStiffnessN_M = 0.3, kTurnDampingN_M_S = 0.01;
// Tool orientations: the shaft, along +z of the tool, leans to the side of its hand.
const Vec3 kBurrLeanRad(0.12, 0.42, 0.0), kSuctionTubeLeanRad(0.15, -0.6, 0.0);

double bowl_m(double worked_s) { return std::min(kBowlFirstM + kWidenM_S * worked_s, SimSurgeon::kBowlM); }

}  // namespace

SimSurgeon::SimSurgeon(const SimSurgeonSettings& settings) noexcept : settings_(settings) {
    const Vec3 rim = kBesideM * Vec3(-0.94, -0.34, 0.0);
    begin_m_ = settings.suction_tube ? Vec3(settings.at_m + rim) : settings.at_m;
    spot_m_ = target_m_ = begin_m_;
    series_ = series(0);
}

Pose SimSurgeon::begin() const noexcept {
    return {begin_m_, quat_from_rotation_vector(settings_.suction_tube ? kSuctionTubeLeanRad : kBurrLeanRad)};
}

SimSurgeon::Series SimSurgeon::series(std::uint64_t number) const noexcept {
    SeededRandom random(settings_.seed * 0x9E3779B97F4A7C15ULL + number);
    const double turn = std::numbers::pi * random.uniform();
    return {.along = Vec3(std::cos(turn), std::sin(turn), 0.0),
            .across = Vec3(-std::sin(turn), std::cos(turn), 0.0),
            .press_n = std::lerp(0.8, kPressMostN, random.uniform())};
}

void SimSurgeon::towards(const Vec3& goal_m, double h_s) noexcept {
    const Vec3 way_m = goal_m - target_m_;
    const double far_m = way_m.norm(), most_m = kMoveM_S * h_s;
    target_m_ += far_m > most_m ? Vec3(most_m / far_m * way_m) : way_m;
}

void SimSurgeon::seek(double h_s, const Vec3& at_m) noexcept {
    works_ = false;
    press_n_ = settings_.suction_tube ? kSuctionTubePressN : kSeekPressN;
    if (back_) {
        towards(spot_m_, h_s);
        back_ = (target_m_ - spot_m_).norm() > 1e-4;
        return;
    }
    if (contact_n_ > (settings_.suction_tube ? kSuctionTubeContactN : kFeltN)) {
        met_ = true;
        met_m_ = at_m;
        return;
    }
    target_m_.z() -= kSeekM_S * h_s;
    if (target_m_.z() > begin_m_.z() - kReachM) return;
    ++missed_;
    back_ = true;
    const double turn = missed_ * std::numbers::pi * (3.0 - std::sqrt(5.0));  // golden angle
    spot_m_ = begin_m_ + kAsideM * std::sqrt(missed_) * Vec3(std::cos(turn), std::sin(turn), 0.0);
}

void SimSurgeon::work(double h_s) noexcept {
    const double clock_s = on_s_ - kWaitS;
    const auto number = static_cast<std::uint64_t>(clock_s / kSeriesS);
    if (number != number_) series_ = series(number_ = number);
    const double tau_s = clock_s - static_cast<double>(number) * kSeriesS;
    const bool lifted = tau_s > kDownS + kStrokesS, strokes = !lifted && tau_s > kDownS;
    if (strokes) worked_s_ += h_s;
    const double bowl = bowl_m(worked_s_), deep_m = std::min(kFeedM_S * worked_s_, kDepthM);
    Vec3 goal_m = Vec3::Zero();  // from the first contact with bone
    const double s = std::clamp((tau_s - kDownS) / kStrokesS, 0.0, 1.0);
    if (settings_.suction_tube) {
        // The burr is on the opposite side.
        const double beside = lifted ? kInTheMiddle : std::lerp(kBesideFrom, kBesideTo, s);
        goal_m = std::max(beside * bowl, lifted ? 0.0 : kBesideM) * series_.across;
    } else {
        goal_m =
            bowl * (kStroke * std::sin(2.0 * std::numbers::pi * kStrokeHz * kStrokesS * s) * series_.along +
                    kAside * (2.0 * s - 1.0) * series_.across);
    }
    const double r = std::min(goal_m.norm() / kBowlM, 1.2);
    goal_m.z() = -deep_m * (1.0 - 0.6 * r * r);
    works_ = settings_.suction_tube || !lifted;
    if (settings_.suction_tube) {
        goal_m.z() += kSuctionTubeAboveM;
        press_n_ = kSuctionTubePressN;
    } else {
        press_n_ = series_.press_n;
        if (lifted) goal_m.z() = kLiftM;
    }
    const Vec3 middle_m = settings_.suction_tube ? Vec3(met_m_ + (settings_.at_m - begin_m_)) : met_m_;
    towards(Vec3(middle_m.x(), middle_m.y(), met_m_.z()) + goal_m, h_s);
}

void SimSurgeon::step(double h_s, const Vec3& at_m, const Vec3& contact_n, bool powered) noexcept {
    contact_n_ += std::min(h_s / kFeltS, 1.0) * (contact_n.z() - contact_n_);
    if (!powered) {
        off_s_ += h_s;
        if (off_s_ < kForgetS) return;  // a short watchdog drop
        on_s_ = worked_s_ = 0.0;
        met_ = works_ = back_ = false;
        spot_m_ = begin_m_;
        missed_ = 0;
        press_n_ = kUpMostN;
        towards(begin_m_, h_s);
        return;
    }
    off_s_ = 0.0;
    on_s_ += h_s;
    if (on_s_ < kWaitS) return;
    if (!met_)
        seek(h_s, at_m);
    else
        work(h_s);
}

Wrench SimSurgeon::pull(const Pose& pose, const Twist& twist) const noexcept {
    Vec3 force_n = kStiffnessN_M * (target_m_ - pose.p_m);
    const double sideways_n = std::hypot(force_n.x(), force_n.y());
    if (sideways_n > kSidewaysMostN) force_n.head<2>() *= kSidewaysMostN / sideways_n;
    force_n.z() = std::clamp(force_n.z(), -press_n_, kUpMostN);
    const Vec3 lean = rotation_vector_rad(begin().q * pose.q.conjugate());
    return {force_n - kDampingN_S_M * twist.linear_m_s,
            kTurnStiffnessN_M * lean - kTurnDampingN_M_S * twist.angular_rad_s};
}

}  // namespace tact
