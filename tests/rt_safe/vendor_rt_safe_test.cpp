// The driver of a manufacturer's library under the servo and the interposer: armed by a person, with faults of the
// device and its cable at random instants; armed again only by the person.
#include <gtest/gtest.h>

#include <random>

#include "ipc/scene/file/scene_file.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/servo/rt_guard.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/visual_paths.hpp"
#include "tests/support/forcedimension_driver.hpp"
#include "tests/support/small_scene.hpp"

namespace tact {
namespace {

TEST(VendorRtSafe, an_arm_of_force_dimension_and_its_faults_touch_neither_heap_nor_mutex) {
    const bool watched = rt_guard::install();
    FakeFd& fake = fake_fd_library();
    fake.reset();
    FakeFdArm& arm = fake.arms[0];
    const std::vector<std::byte> bytes = small_scene().to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "small scene");
    FdClock clock;
    ForceDimension device(fd_settings(), clock);
    const DeviceInfo info = device.open();
    clock.device = &device;
    const auto region = std::make_unique<RtRegion>();
    ServoMailbox mailbox;
    std::unique_ptr<ForceModel> model = load_docking_model(scene, {});
    const HandParts hand{&device, model.release(), info};
    ServoSettings settings;
    settings.visual_paths = kMeshPaths;
    settings.watchdogs.timing_latches = false;  // faults of the device latch nevertheless
    settings.dry_cycles = 1;
    Servo servo({clock, {&hand, 1}, *region, mailbox}, settings);
    rt_guard::abort_on_violation(watched);
    servo.warm_up();
    std::uint64_t sequence = 0;
    const auto order = [&](CommandKind kind) {
        mailbox.orders.push({++sequence, 0.0, static_cast<std::uint32_t>(kind), 0});
    };
    const auto cycles = [&](int n) {
        for (int i = 0; i < n; ++i) {
            clock.wait_until(clock.now() + std::chrono::milliseconds(1));
            servo.cycle();
        }
    };
    const auto notice = [&] {
        HealthTopic h{};
        EXPECT_TRUE(region->health.read(h));
        return static_cast<DeviceNotice>(h.device_notice[0]);
    };
    const auto force_n = [&] {
        return std::hypot(arm.force_n[0].load(), arm.force_n[1].load(), arm.force_n[2].load());
    };
    const auto arm_again = [&] {
        cycles(200);
        order(CommandKind::reset_fault);
        cycles(20);
        order(CommandKind::arm);
        cycles(1000);
        ASSERT_EQ(servo.state().run.state, RunState::active);
        EXPECT_TRUE(arm.force.load());
    };
    cycles(150);
    EXPECT_FALSE(arm.force.load());
    order(CommandKind::arm);
    cycles(1000);
    ASSERT_EQ(servo.state().run.state, RunState::active);
    EXPECT_TRUE(arm.force.load());
    EXPECT_EQ(notice(), DeviceNotice::none);

    std::mt19937 random(20261128);
    for (int run = 0; run < 24; ++run) {
        SCOPED_TRACE(run);
        cycles(static_cast<int>(random() % 150));
        DeviceNotice expected = DeviceNotice::gone;
        int most = 1;  // rounds until it is detected
        switch (run % 4) {
            case 0:
                arm.plugged = false;
                break;
            case 1:
                fake.fail_force = fd::kErrorCom;
                break;
            case 2:
                arm.force = false;
                arm.force_off_cause = fd::kForceOffButton;
                expected = DeviceNotice::safety_open;
                most = 8;
                break;
            default:
                arm.initialized = false;
                expected = DeviceNotice::not_initialized;
                most = 8;
        }
        cycles(most + 1);
        EXPECT_EQ(servo.state().run.state, RunState::fault);
        EXPECT_EQ(notice(), expected);
        EXPECT_EQ(force_n(), 0.0);
        cycles(static_cast<int>(random() % 700));
        arm.plugged = true;
        arm.initialized = true;
        cycles(1200);  // found again, and the person has not acted yet
        EXPECT_EQ(servo.state().run.state, RunState::fault);
        EXPECT_FALSE(arm.force.load());
        EXPECT_EQ(force_n(), 0.0);
        EXPECT_EQ(notice(), DeviceNotice::none);
        arm_again();
    }
    rt_guard::abort_on_violation(false);
    HealthTopic health{};
    ASSERT_TRUE(region->health.read(health));
    if (watched) {
        EXPECT_EQ(health.locks, 0U);
    }
    device.relax();
    delete servo.state().hand[0].model;
}

}  // namespace
}  // namespace tact
