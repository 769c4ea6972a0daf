// The window's checks of the controller's records: impossible values are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "gui/link/region_checks.hpp"

namespace tact::gui_region_checks_test {
namespace {

BodiesTopic good_bodies() {
    BodiesTopic b{};
    b.count = 2;
    b.active = 1;
    for (BodyPlace& p : b.body) p.quat_model_body_xyzw[3] = 1.0;
    return b;
}

TEST(RegionChecks, accept_the_records_of_a_controller) {
    EXPECT_TRUE(sensible(good_bodies()));
    EXPECT_TRUE(sensible(BodiesTopic{}));
    EXPECT_TRUE(sensible(HealthTopic{}));
    EXPECT_TRUE(sensible(LevelsTopic{}));
    ToolTopic tool{};
    tool.quat_world_tool_xyzw[3] = 1.0;
    EXPECT_TRUE(sensible(tool));
}

TEST(RegionChecks, refuse_an_impossible_touch) {
    TouchTopic good{};
    good.planes = 1;
    good.normal_model[0][1] = 1.0F;
    good.push_n[0] = 0.5F;
    EXPECT_TRUE(sensible(good));
    EXPECT_TRUE(sensible(TouchTopic{}));
    const auto refused = [&](auto spoil) {
        TouchTopic t = good;
        spoil(t);
        return !sensible(t);
    };
    EXPECT_TRUE(refused([](TouchTopic& t) { t.planes = 4; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.proxy_model_m[2] = std::nan(""); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.probe_model_m[0] = 1e9; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.normal_model[0][0] = 1.0F; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.push_n[0] = std::nanf(""); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.radius_model_m = -1.0; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.detail = 3; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.detail_shape = static_cast<DetailShape>(2); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.detail_width = -1.0F; }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.deviation_model_m = std::nanf(""); }));
    EXPECT_TRUE(refused([](TouchTopic& t) { t.state = static_cast<TouchState>(3); }));
}

TEST(RegionChecks, refuse_an_impossible_drill) {
    DrillTopic good{};
    good.level_m3 = 1e-13;
    DrillHand& burr = good.hand[0];
    burr.kind = DrillKind::burr;
    burr.radius_m = burr.tip_radius_m = 3e-3F;
    burr.quat_model_tool_xyzw[3] = 1.0;
    EXPECT_TRUE(sensible(good));
    EXPECT_TRUE(sensible(DrillTopic{}));
    const auto refused = [&](auto spoil) {
        DrillTopic t = good;
        spoil(t);
        return !sensible(t);
    };
    EXPECT_TRUE(refused([](DrillTopic& t) { t.level_m3 = std::nan(""); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.burr_rad_s_most = -1.0F; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.suction_m3_s_most = std::nanf(""); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].kind = static_cast<DrillKind>(3); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].shape = static_cast<DrillShape>(3); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].radius_m = 0.0F; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].pos_model_m[1] = 1e9; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].quat_model_tool_xyzw[3] = 0.0; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].suction = 1.5F; }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[0].depth = std::nanf(""); }));
    EXPECT_TRUE(refused([](DrillTopic& t) { t.hand[1].kind = DrillKind::suction_tube; }));  // without a size
}

TEST(RegionChecks, refuse_an_impossible_head) {
    HeadTopic good{};
    good.quat_screen_head_xyzw[3] = 1.0;
    good.state = 2;
    good.quality = 0.5;
    EXPECT_TRUE(sensible(good));
    const auto refused = [&](const auto& spoil) {
        HeadTopic bad = good;
        spoil(bad);
        EXPECT_FALSE(sensible(bad));
    };
    refused([](HeadTopic& h) { h.pos_screen_m[1] = NAN; });
    refused([](HeadTopic& h) { h.quat_screen_head_xyzw[3] = 0.4; });
    refused([](HeadTopic& h) { h.velocity_screen_m_s[2] = 1e5; });
    refused([](HeadTopic& h) { h.angular_screen_rad_s[0] = INFINITY; });
    refused([](HeadTopic& h) { h.state = 3; });
    refused([](HeadTopic& h) { h.quality = 1.5; });
}

TEST(RegionChecks, refuse_impossible_devices_trackers_and_lateness) {
    EXPECT_TRUE(sensible(DevicesTopic{}));
    EXPECT_TRUE(sensible(TrackerTopic{}));
    EXPECT_TRUE(sensible(LatenessTopic{}));
    const auto device = [](const auto& spoil) {
        DevicesTopic t{};
        t.hand[1].valid = 1;
        spoil(t.hand[1]);
        return sensible(t);
    };
    EXPECT_TRUE(device([](DeviceHand& d) { d.heat = 3.0F; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.heat = NAN; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.winding_c = INFINITY; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.force_n_continuous = -1.0F; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.age_ns = -2; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.read = 4; }));
    EXPECT_FALSE(device([](DeviceHand& d) { d.valid = 2; }));
    TrackerTopic tracker{};
    tracker.link = 5;
    EXPECT_FALSE(sensible(tracker));
    tracker = {};
    tracker.rate_hz = NAN;
    EXPECT_FALSE(sensible(tracker));
    LatenessTopic late{};
    late.counts[7] = 3;
    EXPECT_FALSE(sensible(late));  // counts without any cycle
    late.total = 3;
    EXPECT_TRUE(sensible(late));
    late.counts[8] = ~std::uint64_t{0};
    late.total = 2;  // the sum of the counts overflows
    EXPECT_FALSE(sensible(late));
}

TEST(RegionChecks, refuse_impossible_bodies) {
    const double kNan = std::nan("");
    BodiesTopic b = good_bodies();
    b.count = 17;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.count = 0xFFFFFFFFU;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.active = 2;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[1].pos_model_m[2] = kNan;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[0].pos_model_m[0] = 1e9;
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[0].quat_model_body_xyzw[3] = 0.0;  // not a rotation
    EXPECT_FALSE(sensible(b));
    b = good_bodies();
    b.body[5].pos_model_m[0] = kNan;  // beyond count: not checked
    EXPECT_TRUE(sensible(b));
    for (const float pull_n : {-1.0F, 1e6F, std::nanf("")}) {
        b = good_bodies();
        b.pull_n = pull_n;
        EXPECT_FALSE(sensible(b)) << pull_n;
    }
}

TEST(RegionChecks, refuse_impossible_numbers_and_unterminated_texts) {
    HealthTopic h{};
    h.force_rate_hz = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(sensible(h));
    h = {};
    h.recomputed_fraction_mean = 1.5F;
    EXPECT_FALSE(sensible(h));
    h = {};
    h.recomputed_fraction_least = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(sensible(h));
    h = {};
    h.lateness_max_ns = std::numeric_limits<std::int64_t>::min();
    EXPECT_FALSE(sensible(h));
    h = {};
    h.state = 99;
    EXPECT_FALSE(sensible(h));
    ToolTopic t{};
    t.quat_world_tool_xyzw[3] = 1.0;
    t.force_model_n[1] = std::nan("");
    EXPECT_FALSE(sensible(t));
    LevelsTopic l{};
    l.count = 9;
    EXPECT_FALSE(sensible(l));
    l = {};
    std::memset(l.law, 'x', sizeof l.law);  // no terminating zero
    EXPECT_FALSE(sensible(l));
    l = {};
    l.count = 1;
    l.path[0].level = 1.5F;
    EXPECT_FALSE(sensible(l));
    l.path[0].level = std::nanf("");
    EXPECT_FALSE(sensible(l));
    l.path[0].level = 0.5F;
    EXPECT_TRUE(sensible(l));
    std::memset(l.path[0].path, 'x', sizeof l.path[0].path);
    EXPECT_FALSE(sensible(l));
}

TEST(RegionChecks, find_a_path_by_its_full_name) {
    LevelsTopic l{};
    l.count = 2;
    std::strcpy(l.path[0].path, "gui.mesh2");
    std::strcpy(l.path[1].path, "gui.mesh");
    EXPECT_EQ(find_path(l, kMeshPath), &l.path[1]);
    EXPECT_EQ(find_path(l, "gui.mes"), nullptr);
    l.count = 1;
    EXPECT_EQ(find_path(l, kMeshPath), nullptr);
}

}  // namespace
}  // namespace tact::gui_region_checks_test
