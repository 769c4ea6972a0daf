#include "rt/force/drilling/drill_speed.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace tact {
namespace {

// ns, 2026-11-29, AVX-512: fit to steps of a burr of 40 mm at five levels and 2 kHz.
constexpr double kDrillStepNs = 2400.0, kBallNs = 100.0, kBlockNs = 11.0, kPartNs = 6.6, kSumNs = 60.0,
                 kCutNs = 60.0, kChangedNs = 480.0, kWalkedNs = 17.0;
constexpr int kFits = 20;
constexpr double kCommon = 0.01;  // how strongly factors are drawn to the common one
constexpr double kSpeedLeast = 0.05, kSpeedMost = 100.0;
constexpr std::size_t kStepsTelling = 20;

// walk, parts, voxels, cut; by the constants.
Eigen::Vector4d times_ns(const DrillWork& w) {
    return {kDrillStepNs + kBallNs * w.balls + kBlockNs * w.blocks, kPartNs * w.parts, kSumNs * w.summed,
            kCutNs * w.cut + kChangedNs * w.changed + kWalkedNs * w.walked};
}
Eigen::Vector4d factors(const DrillSpeed& s) { return {s.walk, s.parts, s.voxels, s.cut}; }

}  // namespace

Duration drill_cost(const DrillWork& work, const DrillSpeed& speed) noexcept {
    return Duration(std::llround(factors(speed).dot(times_ns(work))));
}

// Least sum of relative errors, by reweighted least squares.
DrillSpeed fit_speed(std::span<const TimedWork> steps) {
    Eigen::Vector4d f = Eigen::Vector4d::Ones();
    for (int fit = 0; fit < kFits && !steps.empty(); ++fit) {
        Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
        Eigen::Vector4d right = Eigen::Vector4d::Zero();
        for (const TimedWork& step : steps) {
            const Eigen::Vector4d x = times_ns(step.work);
            const double ns = step.measured_ns, off_ns = std::abs(ns - f.dot(x));
            const double weight = 1.0 / (ns * std::max(off_ns, 0.01 * ns));
            square += weight * x * x.transpose();
            right += weight * ns * x;
        }
        const double common = std::clamp(right.sum() / square.sum(), kSpeedLeast, kSpeedMost);
        for (int k = 0; k < 4; ++k) {
            const double pull = std::max(kCommon * square(k, k), 1e-12 * square.sum());
            square(k, k) += pull;
            right[k] += pull * common;
        }
        f = square.ldlt().solve(right);
        f = f.cwiseMax(common / DrillSpeed::kApart).cwiseMin(common * DrillSpeed::kApart);
    }
    return {f[0], f[1], f[2], f[3]};
}

std::vector<TimedWork> telling_steps(const std::vector<TimedWork>& steps, double step_s) {
    std::vector<TimedWork> some;
    std::copy_if(steps.begin(), steps.end(), std::back_inserter(some),
                 [step_s](const TimedWork& s) { return 1e-9 * s.measured_ns < step_s; });
    return some.size() >= kStepsTelling ? some : steps;
}

}  // namespace tact
