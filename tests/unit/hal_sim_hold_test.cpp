// Emulated sensor and hand move to a position and rest there, for the rehearsal of a calibration.
#include <gtest/gtest.h>

#include "hal/sim/sim_device.hpp"
#include "hal/sim/sim_tracker.hpp"

namespace tact::hal_sim_hold_test {
namespace {

TEST(SimHold, the_sensor_is_measured_at_the_held_position_and_then_on_the_head) {
    SimTracker tracker;
    tracker.open();
    const Vec3 place(0.2, -0.1, 0.5);
    Instant now{};
    TrackerSample sample;
    const auto mean_off_m = [&](const Vec3& from) {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 250; ++i) {
            now += std::chrono::milliseconds(4);
            static_cast<void>(tracker.read(0, sample, now));
            sum += (sample.T_tracker_sensor.p_m - from) / 250.0;
        }
        return sum.norm();
    };
    tracker.hold(place);
    static_cast<void>(mean_off_m(place));
    EXPECT_LT(mean_off_m(place), 5e-4);
    tracker.let_go();
    EXPECT_GT(mean_off_m(place), 0.05);
}

TEST(SimHold, the_hand_comes_to_rest_at_the_held_position_with_any_script) {
    for (const char* const script : {"passive", "wander"}) {
        SimSettings settings;
        settings.hand.script = script;
        SimDevice device(settings);
        device.open();
        const Vec3 place(0.05, -0.06, 0.02);
        device.hold(place);
        Instant now{};
        DeviceSample sample;
        for (int i = 0; i < 2000; ++i) {
            now += std::chrono::milliseconds(1);
            static_cast<void>(device.read(sample, now));
        }
        EXPECT_LT((sample.T_dev_tool.p_m - place).norm(), 1e-3) << script;
    }
}

}  // namespace
}  // namespace tact::hal_sim_hold_test
