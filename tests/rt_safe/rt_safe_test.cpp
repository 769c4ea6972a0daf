// The servo cycle under the interposer: a heap call or mutex lock inside a cycle aborts. Real docking model, emulated
// device, all commands and all fault paths.
#include <gtest/gtest.h>

#include <cstdlib>
#include <mutex>

#include "hal/sim/sim_device.hpp"
#include "hal/sim/sim_lines.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/servo/rt_guard.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/visual_paths.hpp"
#include "tests/support/board_bus.hpp"
#include "tests/support/small_scene.hpp"

namespace tact {
namespace {

bool guarded() {
    static const bool installed = rt_guard::install();
    return installed;
}

// Hides the unused block from the compiler, which would remove both calls.
[[gnu::noinline]] void touch_the_heap() {
    void* volatile block = std::malloc(32);
    std::free(block);
}

[[gnu::noinline]] void touch_the_heap_by_new() {
    int* volatile block = new int[100];
    delete[] block;
}

TEST(RtSafeDeathTest, the_guard_detects_heap_calls_and_locks) {
    if (!guarded()) GTEST_SKIP() << "a sanitizer owns malloc here";
    const auto inside = [](auto what) {
        rt_guard::abort_on_violation(true);
        const RtSection section;
        what();
    };
    EXPECT_DEATH(inside([] { touch_the_heap(); }), "inside a servo cycle: malloc");
    EXPECT_DEATH(inside([] { touch_the_heap_by_new(); }), "inside a servo cycle: malloc");
    EXPECT_DEATH(inside([] { std::string(100, 'x').append("y"); }), "inside a servo cycle");
    EXPECT_DEATH(inside([] {
                     std::mutex m;
                     m.lock();
                 }),
                 "inside a servo cycle: pthread_mutex_lock");
}

TEST(RtSafe, calls_are_counted_only_inside_a_cycle) {
    if (!guarded()) GTEST_SKIP() << "a sanitizer owns malloc here";
    const rt_guard::Counts before = rt_guard::counts();
    touch_the_heap();
    EXPECT_EQ(rt_guard::counts().allocations, before.allocations);
    {
        const RtSection section;
        touch_the_heap();
    }
    EXPECT_EQ(rt_guard::counts().allocations, before.allocations + 2);
}

TEST(RtSafe, a_whole_run_with_every_command_and_every_fault_touches_neither_heap_nor_mutex) {
    const std::vector<std::byte> bytes = small_scene().to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "small scene");
    const auto make_model = [&](std::uint64_t seed) -> std::unique_ptr<ForceModel> {
        return load_docking_model(scene, {.start_offset_m = 5e-10, .start_rotation_rad = 0.3, .seed = seed});
    };
    const auto region = std::make_unique<RtRegion>();
    SimSettings sim;
    sim.hand.script = "wander";
    Latest<MouseTarget> pointer{};  // as of a window that leads the hand for a while
    sim.mouse = &pointer;
    SimDevice device(sim);
    ManualClock clock;
    clock.advance(std::chrono::seconds(10));
    ServoMailbox mailbox;
    SimLines lines;
    static_cast<void>(lines.open());
    std::unique_ptr<ForceModel> model = make_model(1);
    const HandParts hand{&device, model.release(), device.open()};
    ServoSettings settings;
    settings.visual_paths = kMeshPaths;
    settings.watchdogs.timing_latches = true;
    settings.chain.passivity = true;
    settings.model_deadline = true;  // always passed on the machine's clock: the step takes its shortest path
    Servo servo({clock, {&hand, 1}, *region, mailbox, &lines}, settings);

    rt_guard::abort_on_violation(guarded());
    servo.warm_up();
    std::uint64_t sequence = 0;
    const auto order = [&](CommandKind kind, double value = 0.0, std::uint32_t index = 0) {
        mailbox.orders.push({++sequence, value, static_cast<std::uint32_t>(kind), index});
    };
    const auto cycles = [&](int n) {
        for (int i = 0; i < n && !servo.finished(); ++i) servo.cycle();
    };
    const auto recover = [&] {
        device.inject(SimFault::none);
        static_cast<void>(device.open());
        lines.inject(LinesFault::none);
        cycles(600);  // lost lines are searched twice per second
        order(CommandKind::reset_fault);
        cycles(2);
        order(CommandKind::arm);
        cycles(50);
        ASSERT_EQ(servo.state().run.state, RunState::active);
    };
    cycles(50);
    order(CommandKind::arm);
    cycles(1200);
    for (int i = 0; i < 20; ++i) {
        MouseTarget target{};
        target.arrived_ns = to_ns(clock.now());
        target.pos_dev_m[i % 3] = 0.02;
        target.quat_dev_tool_xyzw[3] = 1.0;
        target.holds = i < 15 ? 1 : 0;
        pointer.publish(target);
        cycles(17);
    }
    for (const SimFault fault :
         {SimFault::unplugged, SimFault::frozen, SimFault::amplifier, SimFault::wild_pose}) {
        device.inject(fault);
        cycles(20);
        ASSERT_EQ(servo.state().run.state, RunState::fault);
        recover();
    }
    for (const LinesFault fault : {LinesFault::stop_pressed, LinesFault::pedal_released,
                                   LinesFault::amplifier_off, LinesFault::unplugged}) {
        lines.inject(fault);
        cycles(150);
        ASSERT_EQ(servo.state().run.state, RunState::fault);
        recover();
    }
    lines.drop();
    cycles(5);
    ASSERT_EQ(servo.state().run.state, RunState::fault);
    recover();
    clock.advance(std::chrono::milliseconds(8));
    cycles(5);
    ASSERT_EQ(servo.state().run.state, RunState::fault);
    recover();
    device.inject(SimFault::hand_off);
    cycles(100);
    device.inject(SimFault::none);
    for (int kind = 0; kind < 22; ++kind) {
        for (const double value : {0.5, -1.0, 800.0}) {
            order(static_cast<CommandKind>(kind), value, 1);
            cycles(3);
        }
    }
    // Copies are added, change hands a hundred times, are moved, fixed and removed, with wrong ids in
    // between.
    const auto order_body = [&](CommandKind kind, std::uint32_t body, double value = 0.0) {
        ServoOrder o{++sequence, value, static_cast<std::uint32_t>(kind), 0, body};
        for (double& p : o.pos_model_m) p = 27e-10;
        mailbox.orders.push(o);
        cycles(4);
    };
    for (int i = 0; i < 20; ++i) order_body(CommandKind::add_body, 0);
    for (std::uint32_t i = 0; i < 100; ++i) {
        order_body(CommandKind::select_body, 1 + i * 7 % 20);
        cycles(static_cast<int>(i % 30));
        order_body(CommandKind::place_body, 1 + i * 3 % 20);
        order_body(CommandKind::fix_body, 1 + i * 5 % 20, i % 2);
    }
    for (std::uint32_t i = 1; i < 20; ++i) order_body(CommandKind::remove_body, i);
    order_body(CommandKind::select_body, kNoBody);
    HousekeepingReport gui{};
    gui.gui_attached = 1;
    gui.gui_heartbeat_ns = to_ns(clock.now());
    gui.gui_vertices_max = 5000;
    mailbox.housekeeping.publish(gui);
    cycles(1200);  // also goes silent
    std::unique_ptr<ForceModel> fresh = make_model(2);
    ASSERT_TRUE(mailbox.model.offer(fresh));
    cycles(300);
    mailbox.model.collect().reset();
    mailbox.stop_signal = 15;
    cycles(1000);
    rt_guard::abort_on_violation(false);
    EXPECT_TRUE(servo.finished());
    HealthTopic health{};
    ASSERT_TRUE(region->health.read(health));
    if (guarded()) {
        EXPECT_EQ(health.locks, 0U);
    }
    delete servo.state().hand[0].model;
}

// The real driver under the servo, its board and bus in lockstep between the cycles: calibrated by a person, armed, every
// fault of the board, unplugged and replugged; armed again only by the person.
TEST(RtSafe, a_run_with_the_board_of_an_arm_and_all_its_faults_touches_neither_heap_nor_mutex) {
    const std::vector<std::byte> bytes = small_scene().to_bytes();
    const SceneFile scene = SceneFile::from_bytes(bytes, "small scene");
    auto owned_bus = std::make_unique<emu::BoardBus>(emu::usual<emu::BoardSettings>());
    emu::BoardBus& bus = *owned_bus;
    PhantomUsbSettings driver = emu::usual<PhantomUsbSettings>();
    driver.thread = false;
    PhantomUsb device(driver, std::move(owned_bus));
    const DeviceInfo info = device.open();
    const auto region = std::make_unique<RtRegion>();
    ManualClock clock;
    clock.wait_until(bus.now());
    ServoMailbox mailbox;
    std::unique_ptr<ForceModel> model = load_docking_model(scene, {});
    const HandParts hand{&device, model.release(), info};
    ServoSettings settings;
    settings.visual_paths = kMeshPaths;
    settings.watchdogs.timing_latches = false;  // faults of the device latch nevertheless
    settings.dry_cycles = 1;
    Servo servo({clock, {&hand, 1}, *region, mailbox}, settings);
    rt_guard::abort_on_violation(guarded());
    servo.warm_up();
    std::uint64_t sequence = 0;
    const auto order = [&](CommandKind kind) {
        mailbox.orders.push({++sequence, 0.0, static_cast<std::uint32_t>(kind), 0});
    };
    const auto cycles = [&](int n) {
        for (int i = 0; i < n; ++i) {
            bus.advance(std::chrono::milliseconds(1));
            device.pump().round(Duration{0});
            clock.wait_until(bus.now());
            servo.cycle();
            device.pump().round(Duration{0});
        }
    };
    const auto amplifier_on = [&] { return bus.board().amplifier().state() == phantom::AmplifierState::on; };
    const auto health = [&] {
        HealthTopic h{};
        EXPECT_TRUE(region->health.read(h));
        return h;
    };
    const auto arm_again = [&] {
        order(CommandKind::reset_fault);
        cycles(20);
        EXPECT_EQ(servo.state().run.state, RunState::ready);
        order(CommandKind::arm);
        cycles(1000);
        EXPECT_EQ(servo.state().run.state, RunState::active);
        EXPECT_TRUE(amplifier_on());
    };
    cycles(150);
    EXPECT_EQ(health().device_notice[0], static_cast<std::uint8_t>(DeviceNotice::hold_reset_pose));
    order(CommandKind::arm);
    cycles(150);
    EXPECT_EQ(servo.state().run.state, RunState::armed);  // no hand is on the arm before it is calibrated
    EXPECT_FALSE(amplifier_on());
    cycles(3000);
    EXPECT_EQ(servo.state().run.state, RunState::active);
    EXPECT_TRUE(amplifier_on());
    EXPECT_EQ(health().device_notice[0], 0);
    EXPECT_NEAR(static_cast<double>(health().delay_p50_ns), 1e6, 1e5);
    // 3 N s/m over half a period plus a delay of one period.
    EXPECT_NEAR(health().stiffness_n_m_max, 2000.0, 200.0);

    for (const std::uint16_t cause : {phantom::status::kSafetyOpen, phantom::status::kOverTemperature}) {
        bus.board().faults().causes = cause;
        cycles(3);
        EXPECT_EQ(servo.state().run.state, RunState::fault);
        EXPECT_FALSE(amplifier_on());
        bus.board().faults().causes = 0;
        cycles(300);
        EXPECT_EQ(servo.state().run.state, RunState::fault);
        arm_again();
    }
    bus.board().faults().deaf = true;  // until its watchdog trips
    cycles(20);
    EXPECT_EQ(servo.state().run.state, RunState::fault);
    EXPECT_EQ(servo.state().run.reason, RunReason::device_fault);
    EXPECT_EQ(health().device_notice[0], static_cast<std::uint8_t>(DeviceNotice::watchdog_tripped));
    bus.board().faults().deaf = false;
    cycles(300);
    EXPECT_EQ(servo.state().run.state, RunState::fault);
    EXPECT_FALSE(amplifier_on());
    arm_again();
    bus.board().faults().corrupt = 2;
    cycles(20);
    EXPECT_EQ(servo.state().run.state, RunState::active);
    bus.board().faults().corrupt = 3;
    cycles(20);
    EXPECT_EQ(servo.state().run.state, RunState::fault);
    arm_again();
    cycles(100);
    EXPECT_EQ(health().device_bus[0].lost, 5U);
    EXPECT_EQ(health().device_bus[0].checksum + health().device_bus[0].refused, 5U);
    EXPECT_EQ(health().device_bus[1], BusCounts{});
    bus.unplug();
    cycles(2);
    EXPECT_EQ(servo.state().run.state, RunState::fault);
    EXPECT_EQ(health().device_notice[0], static_cast<std::uint8_t>(DeviceNotice::gone));
    bus.plug();
    cycles(4000);  // reopened and calibrated again
    EXPECT_EQ(servo.state().run.state, RunState::fault);
    EXPECT_FALSE(amplifier_on());
    arm_again();
    rt_guard::abort_on_violation(false);
    device.relax();
    delete servo.state().hand[0].model;
}

}  // namespace
}  // namespace tact
