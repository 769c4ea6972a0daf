// A position x quantized in steps s is within s/2 of x, so the difference of two samples, D_i = x_k - x_i over
// the time t_i, is within s of the true one. A hand at constant speed v has |D_i - v t_i| <= s for every i: v
// lies in all intervals
//     [(D_i - s) / t_i, (D_i + s) / t_i].
// The window grows backwards while these intervals intersect. The estimate is the least-squares speed over the window,
// clamped to the intersection. At constant speed the window reaches its full length, and the estimate and v lie in
// one interval of width 2 s / t.
//
// Under an acceleration a, the intervals intersect as long as a parabola fits between two lines: v - v' = u =
// sqrt(2 a s) on the one side, u t - a t^2 / 2 >= -s on the other, so up to t = (2 + sqrt 2) sqrt(s / a). At
// that length the lag far exceeds the quantization error, so only the newer half of a window that was cut is used.
// Root mean square error for a hand at 2 cm and 2 Hz, steps of 0.03 mm, 1 kHz (2026-11-21): 5.8 mm/s with the newer
// half, 9.6 with the whole window, 4.9 with a third but worse at uneven times; plain
// differences and a 30 Hz low-pass 11.8 each. At 0.5 Hz: 1.9, differences 11.5, low-pass 1.7.
//
// The published window stops when the straight line to the oldest sample misses another sample by more than s. Both
// ends of that line have an error of up to half a step, so this also happens at constant speed, and windows become
// shorter and noisier than necessary.
#include "hal/arm/velocity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact {

// A little more than the step, against rounding errors.
VelocityWindow::VelocityWindow(double step, const VelocitySettings& settings)
    : step_(std::max(std::abs(step), std::numeric_limits<double>::min()) * (1.0 + 1e-9)),
      settings_(settings) {}

void VelocityWindow::reset() noexcept {
    count_ = 0;
    per_s_ = 0.0;
    window_ = Duration(0);
}

// At sample rates above kSamples per window, replaces the previous sample so that the ring still spans the window.
void VelocityWindow::keep(double position, Instant at) noexcept {
    const Duration spacing = settings_.span_max / static_cast<std::int64_t>(kSamples);
    const bool crowded = count_ >= 2 && at - back(1).at < spacing;
    if (!crowded) {
        newest_ = (newest_ + 1) % kSamples;
        count_ = std::min(count_ + 1, kSamples);
    }
    samples_[newest_] = {position, at};
}

double VelocityWindow::push(double position, Instant at) noexcept {
    if (!std::isfinite(position)) return per_s_;
    if (count_ > 0) {
        if (at <= back(0).at) return per_s_;
        if (at - back(0).at > settings_.gap_max) reset();
    }
    keep(position, at);
    if (count_ < 2) return per_s_ = 0.0;
    Fit fit = line(position, at, count_ - 1);
    if (fit.cut) fit = line(position, at, (fit.samples + 1) / 2);
    window_ = fit.window;
    return per_s_ = fit.per_s;
}

VelocityWindow::Fit VelocityWindow::line(double position, Instant at, std::size_t most) const noexcept {
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    double n = 1.0, t_sum = 0.0, d_sum = 0.0, tt_sum = 0.0, td_sum = 0.0;  // the newest sample is at 0, 0
    Fit fit;
    for (std::size_t age = 1; age <= most; ++age) {
        const Duration back_by = at - back(age).at;
        if (age > 1 && back_by > settings_.span_max) break;
        const double t = to_s(back_by), d = position - back(age).position, rate = 1.0 / t;
        const double low_here = std::max(low, (d - step_) * rate);
        const double high_here = std::min(high, (d + step_) * rate);
        fit.cut = low_here > high_here;
        if (fit.cut) break;
        low = low_here;
        high = high_here;
        n += 1.0;
        t_sum += t;
        d_sum += d;
        tt_sum += t * t;
        td_sum += t * d;
        fit.window = back_by;
        fit.samples = age;
    }
    const double spread = n * tt_sum - t_sum * t_sum;
    const double slope = spread > 0.0 ? (n * td_sum - t_sum * d_sum) / spread : 0.0;
    fit.per_s = std::clamp(slope, low, high);
    return fit;
}

ArmVelocity::ArmVelocity(const ArmKinematics& arm, const VelocitySettings& settings) : arm_(&arm) {
    windows_.fill(VelocityWindow(1.0, settings));
}

void ArmVelocity::reset() noexcept {
    for (VelocityWindow& w : windows_) w.reset();
    rad_s_.setZero();
}

Twist ArmVelocity::push(const Counts6& counts, const Joint6& q, Instant at) noexcept {
    for (std::size_t i = 0; i < 6; ++i) {
        const auto j = static_cast<Eigen::Index>(i);
        const double rad_per_count = arm_->parameters().rad_per_count[j];
        if (rad_per_count != 0.0) rad_s_[j] = rad_per_count * windows_[i].push(counts[i], at);
    }
    return arm_->twist(q, rad_s_);
}

}  // namespace tact
