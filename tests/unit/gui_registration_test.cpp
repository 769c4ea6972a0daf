// Registration from point pairs: exact data, noise compared with theory, refused input.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <numbers>

#include "gui/stereo/registration.hpp"
#include "ipc/base/random.hpp"

namespace tact::gui_registration_test {
namespace {

double normal(SeededRandom& random) {
    return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) *
           std::cos(2.0 * std::numbers::pi * random.uniform());
}

std::vector<PointPair> seen_from(const Pose& T_to_from, const std::vector<Vec3>& from_m) {
    std::vector<PointPair> pairs;
    for (const Vec3& p : from_m) pairs.push_back({p, T_to_from * p});
    return pairs;
}

const std::vector<Vec3>& corners() {  // of a screen: coplanar
    static const std::vector<Vec3> points{
        {-0.25, -0.15, 0.0}, {0.25, -0.15, 0.0}, {-0.25, 0.15, 0.0}, {0.25, 0.15, 0.0}};
    return points;
}

double apart_rad(const Quat& a, const Quat& b) { return rotation_vector_rad(a * b.conjugate()).norm(); }

RC_GTEST_PROP(Registration, exact_pairs_give_the_exact_pose, (std::uint64_t seed)) {
    SeededRandom random(seed);
    const Pose T{random.direction() * random.uniform(), random.rotation()};
    std::vector<Vec3> points = corners();
    if (random.uniform() < 0.5) points.emplace_back(0.1, 0.1, 0.2 * random.uniform());
    if (random.uniform() < 0.5) points.resize(3);
    const Registration r = register_points(seen_from(T, points));
    RC_ASSERT(r.good);
    RC_ASSERT((r.T_to_from.p_m - T.p_m).norm() < 1e-12);
    RC_ASSERT(apart_rad(r.T_to_from.q, T.q) < 1e-7);
    RC_ASSERT(r.residual_m_max < 1e-12);
}

// Noise of variance s^2 per axis leaves a mean square residual of 3 s^2 (1 - 2 / N) (Sibson 1979).
TEST(Registration, the_residual_of_noisy_pairs_agrees_with_theory) {
    SeededRandom random(4);
    constexpr double kNoiseM = 1e-3;
    constexpr int kPoints = 8, kTries = 2000;
    double sum = 0.0;
    for (int t = 0; t < kTries; ++t) {
        const Pose T{random.direction(), random.rotation()};
        std::vector<Vec3> points;
        for (int i = 0; i < kPoints; ++i)
            points.emplace_back(0.3 * random.uniform(), 0.3 * random.uniform(), 0.3 * random.uniform());
        std::vector<PointPair> pairs = seen_from(T, points);
        for (PointPair& p : pairs) p.to_m += kNoiseM * Vec3(normal(random), normal(random), normal(random));
        RegistrationLimits limits;
        limits.residual_m_max = 1.0;
        const Registration r = register_points(pairs, limits);
        ASSERT_TRUE(r.good) << r.refusal;
        sum += r.residual_m_rms * r.residual_m_rms;
    }
    const double expected = 3.0 * kNoiseM * kNoiseM * (1.0 - 2.0 / kPoints);
    EXPECT_NEAR(sum / kTries, expected, 0.03 * expected);
}

TEST(Registration, too_few_close_collinear_and_nan_points_are_refused_with_the_reason) {
    const Pose T{Vec3(0.1, 0.2, 0.3), Quat::Identity()};
    const auto why = [&](const std::vector<Vec3>& points) {
        const Registration r = register_points(seen_from(T, points));
        EXPECT_FALSE(r.good);
        return r.refusal;
    };
    EXPECT_NE(why({{0, 0, 0}, {1, 0, 0}}).find("at least three"), std::string::npos);
    EXPECT_NE(why({}).find("0 pairs"), std::string::npos);
    EXPECT_NE(why({{0, 0, 0}, {0.001, 0, 0}, {0, 0.001, 0}}).find("of each other"), std::string::npos);
    EXPECT_NE(why({{0, 0, 0}, {0.1, 0.001, 0}, {0.2, 0, 0}, {0.4, 0, 0}}).find("on a line"),
              std::string::npos);
    EXPECT_NE(why({{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}}).find("pair 3"),
              std::string::npos);
}

TEST(Registration, points_collinear_only_in_the_second_frame_are_refused) {
    std::vector<PointPair> pairs = seen_from({}, corners());
    for (std::size_t i = 0; i < pairs.size(); ++i)
        pairs[i].to_m = Vec3(0.1 * static_cast<double>(i), 0.0, 0.0);
    const Registration r = register_points(pairs);
    EXPECT_FALSE(r.good);
    EXPECT_NE(r.refusal.find("second frame"), std::string::npos);
}

TEST(Registration, pairs_in_the_wrong_order_are_refused_by_their_residual) {
    std::vector<PointPair> pairs = seen_from({}, corners());
    pairs[2].to_m += Vec3(0.0, 0.0, 0.05);
    Registration r = register_points(pairs);
    EXPECT_FALSE(r.good);
    EXPECT_GT(r.residual_m_max, 0.01);
    pairs = seen_from({}, corners());
    std::swap(pairs[0].to_m, pairs[1].to_m);
    r = register_points(pairs);
    EXPECT_FALSE(r.good);
    EXPECT_NE(r.refusal.find("measure it again"), std::string::npos);
}

// A mirrored set (a left-handed frame) has no rigid motion and must not be accepted.
TEST(Registration, a_mirrored_frame_is_refused) {
    std::vector<PointPair> pairs = seen_from({}, {{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.25}});
    for (PointPair& p : pairs) p.to_m.z() = -p.to_m.z();
    EXPECT_FALSE(register_points(pairs).good);
}

}  // namespace
}  // namespace tact::gui_registration_test
