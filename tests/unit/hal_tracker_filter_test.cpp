// The 1 euro filter and its prediction against closed forms: step, noise, lag, a sine.
#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "hal/tracker/head_filter.hpp"
#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"

namespace tact::hal_tracker_filter_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr Duration kPeriod = microseconds(4000);
constexpr double kPeriodS = 0.004;

// Without adaptation both filters are plain low-passes with simple theory.
HeadFilterSettings fixed(double cutoff_hz) { return {{cutoff_hz, 0.0, 1.2}, {cutoff_hz, 0.0, 1.2}}; }
Pose at_x(double x_m) { return {Vec3(x_m, 0.0, 0.0), Quat::Identity()}; }
Pose turned(double angle_rad) { return {Vec3::Zero(), quat_from_rotation_vector(Vec3(0.0, angle_rad, 0.0))}; }
double angle(const Pose& p) { return rotation_vector_rad(p.q).y(); }
double share(double cutoff_hz) { return 1.0 - std::exp(-kTurn * cutoff_hz * kPeriodS); }

double normal(SeededRandom& random) {
    return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(kTurn * random.uniform());
}

TEST(HeadFilter, the_step_response_is_exponential_for_any_sample_times) {
    SeededRandom random(1);
    for (const bool even : {true, false}) {
        HeadFilter filter(fixed(2.0));
        Instant t = instant_from_ns(1'000'000'000);
        filter.add(t, {});
        const Instant start = t;
        const Pose step{Vec3(0.1, 0.0, 0.0), quat_from_rotation_vector(Vec3(0.0, 0.5, 0.0))};
        for (int i = 0; i < 100; ++i) {
            t += even ? kPeriod : Duration(static_cast<std::int64_t>(1e5 + 1e7 * random.uniform()));
            filter.add(t, step);
            const double answer = 1.0 - std::exp(-kTurn * 2.0 * to_s(t - start));
            ASSERT_NEAR(filter.pose().p_m.x(), 0.1 * answer, 1e-12);
            ASSERT_NEAR(angle(filter.pose()), 0.5 * answer, 1e-9);
        }
    }
}

// For white noise, y += a (x - y) multiplies the variance by a / (2 - a).
TEST(HeadFilter, noise_at_rest_is_reduced_as_in_theory) {
    HeadFilter filter(fixed(1.15));
    SeededRandom random(2);
    Instant t{};
    double sum = 0.0;
    constexpr int kSamples = 200'000;
    for (int i = 0; i < kSamples; ++i, t += kPeriod) {
        filter.add(t, at_x(1e-3 * normal(random)));
        if (i > 1000) sum += filter.pose().p_m.x() * filter.pose().p_m.x();
    }
    const double a = share(1.15);
    EXPECT_NEAR(std::sqrt(sum / (kSamples - 1000)), 1e-3 * std::sqrt(a / (2.0 - a)),
                0.05 * 1e-3 * std::sqrt(a / 2.0));
}

// On a ramp the low-pass lags by v dt (1 - a) / a; its derivative is exact.
TEST(HeadFilter, in_steady_motion_the_lag_matches_theory_and_the_twist_is_exact) {
    HeadFilterSettings settings;  // with adaptation: the cut-off settles at min + beta v
    HeadFilter filter(settings);
    constexpr double kSpeed = 0.2, kSpin = 0.8;
    Instant t{};
    double s = 0.0;
    for (int i = 0; i < 2000; ++i, t += kPeriod, s += kPeriodS) {
        filter.add(t, {Vec3(kSpeed * s, 0.0, 0.0), quat_from_rotation_vector(Vec3(0.0, kSpin * s, 0.0))});
    }
    s -= kPeriodS;
    const auto lag_s = [](const OneEuroSettings& e, double speed) {
        const double a = share(e.min_cutoff_hz + e.beta_hz_per_speed * speed);
        return kPeriodS * (1.0 - a) / a;
    };
    EXPECT_NEAR(kSpeed * s - filter.pose().p_m.x(), kSpeed * lag_s(settings.position, kSpeed), 1e-9);
    const Quat behind = quat_from_rotation_vector(Vec3(0.0, kSpin * s, 0.0)) * filter.pose().q.conjugate();
    EXPECT_NEAR(rotation_vector_rad(behind).y(), kSpin * lag_s(settings.rotation, kSpin), 1e-9);
    EXPECT_NEAR(filter.twist().linear_m_s.x(), kSpeed, 1e-9);
    EXPECT_NEAR(filter.twist().angular_rad_s.y(), kSpin, 1e-9);
}

// A sine through the low-pass F = a / (1 - (1 - a) z^-1) and the prediction 1 + h (1 - z^-1) / dt, with
// z = exp(i w dt), against the sine h later.
TEST(HeadFilter, the_prediction_error_on_a_sine_matches_its_transfer_function) {
    using Complex = std::complex<double>;
    constexpr double kAmplitude = 0.05, kAheadS = 0.03;
    for (const double hz : {0.5, 1.0, 2.0}) {
        const double w = kTurn * hz, a = share(10.0);
        const Complex back = std::exp(Complex(0.0, -w * kPeriodS));
        const Complex low_pass = a / (1.0 - (1.0 - a) * back);
        const Complex ahead = std::exp(Complex(0.0, w * kAheadS));
        const double predicted = std::abs(low_pass * (1.0 + kAheadS * (1.0 - back) / kPeriodS) - ahead);
        const double held = std::abs(low_pass - ahead);
        HeadFilter filter(fixed(10.0));
        Instant t{};
        double worst = 0.0, worst_held = 0.0, s = 0.0;
        for (int i = 0; i < 2500; ++i, t += kPeriod, s += kPeriodS) {
            filter.add(t, at_x(kAmplitude * std::sin(w * s)));
            if (i < 500) continue;
            const double then = kAmplitude * std::sin(w * (s + kAheadS));
            worst = std::max(worst, std::abs(filter.at(t + milliseconds(30)).p_m.x() - then));
            worst_held = std::max(worst_held, std::abs(filter.pose().p_m.x() - then));
        }
        EXPECT_NEAR(worst, kAmplitude * predicted, 0.01 * kAmplitude * predicted);
        EXPECT_NEAR(worst_held, kAmplitude * held, 0.01 * kAmplitude * held);
        EXPECT_LT(worst, 0.75 * worst_held);
    }
}

// The defaults in typical use: noise of 0.8 mm and 0.15 degrees at 240 Hz, display 30 ms later.
TEST(HeadFilter, the_defaults_beat_the_raw_pose_at_rest_and_in_motion) {
    constexpr double kNoiseM = 0.8e-3, kNoiseRad = 0.15 * kDegreeRad, kRateHz = 240.0, kAheadS = 0.03;
    const auto rms = [&](double amplitude, double hz) {
        SeededRandom random(3);
        HeadFilter filter;
        struct {
            double p = 0.0, r = 0.0, raw_p = 0.0, raw_r = 0.0;
        } sum;
        int n = 0;
        for (int i = 0; i < 7200; ++i) {
            const double s = i / kRateHz;
            const auto truth = [&](double at_s) { return amplitude * std::sin(kTurn * hz * at_s); };
            const Vec3 noise_m = kNoiseM * Vec3(normal(random), normal(random), normal(random));
            const Vec3 noise_rad = kNoiseRad * Vec3(normal(random), normal(random), normal(random));
            // Rotation in rad is six times the translation in m: 0.05 m and 17 degrees.
            const Pose raw{Vec3(truth(s), 0.0, 0.0) + noise_m,
                           quat_from_rotation_vector(noise_rad) *
                               quat_from_rotation_vector(Vec3(0.0, 6.0 * truth(s), 0.0))};
            const Instant t = instant_from_ns(std::llround(1e9 * s));
            filter.add(t, raw);
            if (i < 240) continue;
            ++n;
            const Pose shown = filter.at(t + milliseconds(30));
            const double then = truth(s + kAheadS);
            sum.p += std::pow(shown.p_m.x() - then, 2);
            sum.raw_p += std::pow(raw.p_m.x() - then, 2);
            sum.r += std::pow(angle(shown) - 6.0 * then, 2);
            sum.raw_r += std::pow(angle(raw) - 6.0 * then, 2);
        }
        return std::array{std::sqrt(sum.p / sum.raw_p), std::sqrt(sum.r / sum.raw_r)};
    };
    const auto rest = rms(0.0, 1.0), slow = rms(0.05, 0.5), brisk = rms(0.05, 1.0);
    // Error ratios when the defaults were chosen (position, rotation): 0.58, 0.64 at rest; 0.71, 0.49 at 0.5 Hz;
    // 0.55, 0.41 at 1 Hz.
    for (const auto& ratio : {rest, slow, brisk}) {
        EXPECT_LT(ratio[0], 0.85);
        EXPECT_LT(ratio[1], 0.85);
        EXPECT_GT(ratio[0], 0.3);
        EXPECT_GT(ratio[1], 0.3);
    }
}

TEST(HeadFilter, predicts_no_farther_than_its_horizon_and_never_backwards) {
    HeadFilter filter;
    Instant t{};
    for (int i = 0; i < 200; ++i, t += kPeriod) filter.add(t, at_x(0.2 * i * kPeriodS));
    t -= kPeriod;
    const double speed = filter.twist().linear_m_s.x();
    EXPECT_NEAR(filter.at(t + milliseconds(20)).p_m.x(), filter.pose().p_m.x() + 0.020 * speed, 1e-12);
    EXPECT_NEAR(filter.at(t + std::chrono::hours(1)).p_m.x(), filter.pose().p_m.x() + 0.050 * speed, 1e-12);
    EXPECT_EQ(filter.at(t - milliseconds(20)).p_m.x(), filter.pose().p_m.x());
}

TEST(HeadFilter, restarts_after_a_gap_and_ignores_old_samples) {
    HeadFilter filter;
    Instant t{};
    for (int i = 0; i < 50; ++i, t += kPeriod) filter.add(t, at_x(0.01 * i));
    const Pose before = filter.pose();
    filter.add(t - kPeriod, at_x(9.0));  // same time as the newest sample
    filter.add(t - milliseconds(100), at_x(9.0));
    EXPECT_EQ(filter.pose().p_m, before.p_m);
    filter.add(t + milliseconds(300), at_x(-1.0));
    EXPECT_EQ(filter.pose().p_m.x(), -1.0);
    EXPECT_EQ(filter.twist().linear_m_s, Vec3(Vec3::Zero()));
}

TEST(HeadFilter, the_sign_of_a_quaternion_does_not_matter) {
    HeadFilter one, other;
    Instant t{};
    for (int i = 0; i < 100; ++i, t += kPeriod) {
        Pose p = turned(0.05 * i);  // up to 5 rad: w changes its sign
        one.add(t, p);
        if (i % 2 == 1) p.q.coeffs() = -p.q.coeffs();
        other.add(t, p);
    }
    EXPECT_NEAR((one.twist().angular_rad_s - other.twist().angular_rad_s).norm(), 0.0, 1e-9);
    EXPECT_NEAR(rotation_vector_rad(one.pose().q * other.pose().q.conjugate()).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace tact::hal_tracker_filter_test
