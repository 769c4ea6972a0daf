// Static and dynamic friction on a plane, against Coulomb's law: hold, break-away, slide, rest.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ipc/base/error.hpp"
#include "tests/unit/force_surface_fixture.hpp"

namespace tact::force_stick_slip_test {
namespace {

using namespace surface_test;

constexpr double kStatic = 0.5, kDynamic = 0.2, kDepthM = 0.002, kStepM = 2e-5;  // 20 mm/s at 1 kHz

SurfaceSettings two_coefficients(double radius_m) {
    SurfaceSettings s = plain(radius_m, kStatic);
    s.dynamic_friction = kDynamic;
    return s;
}

double share(const Vec3& force_n) { return std::hypot(force_n.x(), force_n.z()) / force_n.y(); }

// A hand that is pressed kDepthM into the plate and has pulled nothing yet.
struct Pressed : Hand {
    explicit Pressed(const SurfaceSettings& s) : Hand(plane(), s, {-0.03, s.radius_m + 0.004, 0.001}) {
        (void)lead({-0.03, s.radius_m - kDepthM, 0.001});
    }
    Vec3 drag(double way_m) { return step(place + Vec3(way_m, 0.0, 0.0)); }
};

TEST(StickSlip, the_tool_holds_up_to_the_static_coefficient_and_slides_with_the_dynamic_one) {
    for (const double radius_m : {0.0, 0.003}) {
        Pressed hand(two_coefficients(radius_m));
        const Vec3 begin = hand.proxy();
        // Up to the rim: held.
        const int until_rim = static_cast<int>(0.98 * kStatic * kDepthM / kStepM);
        Vec3 force_n;
        for (int i = 0; i < until_rim; ++i) force_n = hand.drag(kStepM);
        EXPECT_LT((hand.proxy() - begin).norm(), 1e-6) << "radius " << radius_m;
        EXPECT_NEAR(share(force_n), until_rim * kStepM / kDepthM, 0.002) << "radius " << radius_m;
        EXPECT_FALSE(hand.model->slides());
        // Beyond: the friction falls, and no edge of the 20 x 20 squares stops the slide.
        for (int i = 0; i < 60; ++i) {
            force_n = hand.drag(kStepM);
            ASSERT_LE(share(force_n), 1.01 * kStatic) << "radius " << radius_m << ", step " << i;
        }
        for (int i = 0; i < 1500; ++i) {
            force_n = hand.drag(kStepM);
            ASSERT_NEAR(share(force_n), kDynamic, 0.01 * kDynamic) << "radius " << radius_m << ", step " << i;
            ASSERT_TRUE(hand.model->slides());
        }
        EXPECT_GT(hand.proxy().x() - begin.x(), 0.025);
    }
}

TEST(StickSlip, a_tool_at_rest_sticks_again_and_a_short_rest_does_not) {
    for (const double radius_m : {0.0, 0.003}) {
        Pressed hand(two_coefficients(radius_m));
        for (int i = 0; i < 500; ++i) (void)hand.drag(kStepM);
        ASSERT_TRUE(hand.model->slides());
        for (int rest = 0; rest < 20; ++rest) {
            for (int i = 0; i < 15; ++i) (void)hand.drag(0.0);
            ASSERT_NEAR(share(hand.drag(kStepM)), kDynamic, 0.01 * kDynamic) << "radius " << radius_m;
        }
        for (int i = 0; i < 25; ++i) (void)hand.drag(0.0);
        EXPECT_FALSE(hand.model->slides());
        const Vec3 rests = hand.proxy();
        Vec3 force_n;
        const int more = static_cast<int>(0.9 * (kStatic - kDynamic) * kDepthM / kStepM);
        for (int i = 0; i < more; ++i) force_n = hand.drag(kStepM);
        EXPECT_LT((hand.proxy() - rests).norm(), 1e-6) << "radius " << radius_m;
        EXPECT_GT(share(force_n), kDynamic + 0.8 * (kStatic - kDynamic)) << "radius " << radius_m;
    }
}

TEST(StickSlip, a_tool_that_left_the_surface_sticks_where_it_returns) {
    Pressed hand(two_coefficients(0.003));
    for (int i = 0; i < 200; ++i) (void)hand.drag(kStepM);
    ASSERT_TRUE(hand.model->slides());
    (void)hand.step(hand.place + Vec3(0.0, 2.0 * kDepthM, 0.0));
    for (int i = 0; i < 5; ++i) (void)hand.drag(0.0);
    EXPECT_FALSE(hand.model->slides());
}

TEST(StickSlip, the_break_away_has_no_peak) {
    Pressed hand(two_coefficients(0.0));
    Vec3 before = hand.drag(0.0);
    for (int i = 0; i < 400; ++i) {
        const Vec3 now = hand.drag(kStepM);
        EXPECT_LT((now - before).norm(), 2.5 * kStiffness * kStepM + 2.0 * SurfaceModel::kLagN + 1e-3)
            << "step " << i;
        before = now;
    }
}

TEST(StickSlip, a_dynamic_coefficient_above_the_static_one_is_refused_by_name) {
    SurfaceSettings s = plain(0.0, 0.2);
    s.dynamic_friction = 0.3;
    try {
        check_surface_settings(s);
        FAIL() << "accepted";
    } catch (const StartupError& e) {
        EXPECT_NE(std::string(e.what()).find("dynamic friction"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace tact::force_stick_slip_test
