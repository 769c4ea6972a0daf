// Every driver loses its device at a hundred seeded random instants of a running servo: before it is armed, during
// calibration, while the force ramps in and with force on, between cycles and in the middle of one. The next command
// has no force, the fault names the device and the fix, nothing arms by itself when the device comes back, no cycle
// becomes long, and the servo touches neither heap nor mutex.
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <random>
#include <set>

#include "hal/registry.hpp"
#include "ipc/topics/text.hpp"
#include "rt/servo/rt_guard.hpp"
#include "rt/servo/servo.hpp"
#include "rt/start/visual_paths.hpp"
#include "tests/support/spring_model.hpp"
#include "tests/support/unplug_stations.hpp"

namespace tact {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr int kEach = 50;  // instants before there is a force, and as many with force on
constexpr std::uint32_t kSeed = 20261128;
// A busy machine pauses the test at random; a driver that waits would do so at most instants.
constexpr int kLongCyclesMax = kEach / 2;

// Keeps the last command on its way to the driver.
class SpyDevice final : public HapticDevice {
public:
    explicit SpyDevice(HapticDevice& inner) : inner_(inner) {}
    DeviceInfo open() override { return inner_.open(); }
    IoStatus read(DeviceSample& newest, Instant now) noexcept override {
        const IoStatus status = inner_.read(newest, now);
        sample = newest;
        return status;
    }
    IoStatus write(const DeviceCommand& c, Instant now) noexcept override {
        command = c;
        return inner_.write(c, now);
    }
    void relax() noexcept override { inner_.relax(); }
    [[nodiscard]] bool commands_nothing() const {
        return !command.enable && command.wrench_dev.force_n.isZero(0.0) &&
               command.wrench_dev.torque_n_m.isZero(0.0);
    }

    DeviceSample sample;
    DeviceCommand command;

private:
    HapticDevice& inner_;
};

// A spring to a place that circles, so that there is a force all the time; pulls the plug in its step on demand.
class CirclingSpring final : public ForceModel {
public:
    explicit CirclingSpring(UnplugStation& station) : station_(station) {}
    bool pull_plug = false;

    [[nodiscard]] KnobSpec knob() const noexcept override { return spring_.knob(); }
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept override {
        return spring_.items(fidelity);
    }
    void reset(const ToolState& tool) noexcept override { spring_.reset(tool); }
    [[nodiscard]] ModelBodies bodies() const noexcept override { return spring_.bodies(); }
    StepResult step(const ToolState& tool, const Budget& budget) noexcept override {
        if (pull_plug) {
            pull_plug = false;
            rt_guard::abort_on_violation(false);  // the emulated plug allocates; a real one is outside
            station_.unplug();
            rt_guard::abort_on_violation(rt_guard::install());
        }
        angle_ += 0.006;
        spring_.rest_world_m = 0.02 * Vec3(std::cos(angle_), std::sin(angle_), 0.0);
        return spring_.step(tool, budget);
    }

private:
    UnplugStation& station_;
    SpringModel spring_;
    double angle_ = 0.0;
};

class Rig {
public:
    explicit Rig(const UnplugCase& tested)
        : station(tested.make()), spy(station->device()), model(*station), region(new RtRegion{}) {
        const HandParts hand{&spy, &model, station->device().open()};
        static_cast<void>(station->clock().now());
        ServoSettings settings;
        settings.visual_paths = kMeshPaths;
        settings.watchdogs.timing_latches = false;  // faults of the device latch nevertheless
        settings.dry_cycles = 1;
        settings.model_deadline = false;
        station->pass(milliseconds(1));
        servo = std::make_unique<Servo>(ServoParts{station->clock(), {&hand, 1}, *region, mailbox}, settings);
        rt_guard::abort_on_violation(rt_guard::install());
        servo->warm_up();
    }
    ~Rig() { rt_guard::abort_on_violation(false); }
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    void cycle() {
        station->pass(milliseconds(1) - std::exchange(passed_, Duration{0}));
        cycle_now();
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) cycle();
    }
    void pass_part(Duration part) {
        station->pass(part);
        passed_ = part;
    }
    void order(CommandKind kind) {
        mailbox.orders.push({++sequence_, 0.0, static_cast<std::uint32_t>(kind), 0});
    }
    [[nodiscard]] RunState state() const { return servo->state().run.state; }
    // As a person does, until it has a force. False: a minute of cycles was not enough.
    bool bring_to_force() {
        for (int i = 0; i < 60'000; ++i) {
            if (i % 50 == 0 && state() == RunState::fault) order(CommandKind::reset_fault);
            if (i % 50 == 5 && state() == RunState::ready) order(CommandKind::arm);
            cycle();
            if (state() == RunState::active && spy.command.wrench_dev.force_n.norm() > 0.05) return true;
        }
        return false;
    }
    [[nodiscard]] std::vector<EventTopic> faults() const {
        RingCursor cursor;
        EventTopic e{};
        std::vector<EventTopic> all;
        while (region->events.next(cursor, e))
            if (e.code == static_cast<std::uint16_t>(EventCode::fault_latched)) all.push_back(e);
        return all;
    }

    std::unique_ptr<UnplugStation> station;
    SpyDevice spy;
    CirclingSpring model;
    std::unique_ptr<RtRegion> region;
    ServoMailbox mailbox;
    std::unique_ptr<Servo> servo;
    Duration last_cycle{0};

private:
    void cycle_now() {
        const Instant begin = Monotonic::now();
        servo->cycle();
        last_cycle = Monotonic::now() - begin;
    }

    std::uint64_t sequence_ = 0;
    Duration passed_{0};
};

class Unplug : public testing::TestWithParam<UnplugCase> {
protected:
    // Pulls the plug, and checks the next command and the fault.
    void pull(Rig& rig, std::mt19937& random) {
        const std::size_t faults_before = rig.faults().size();
        const bool in_cycle = random() % 2 == 0;
        const Duration part = microseconds(random() % 1000);
        if (in_cycle) {
            rig.model.pull_plug = true;
            rig.cycle();
        } else {
            rig.pass_part(part);
            rig.station->unplug();
        }
        const Instant gone_at = rig.station->clock().now();
        if (rig.station->silent_loss) {
            const WatchdogSettings limits;
            while (rig.state() != RunState::fault) {
                ASSERT_LT(to_s(rig.station->clock().now() - gone_at), 10.0);
                rig.cycle();
                const Duration age = rig.servo->state().now - rig.spy.sample.taken_at;
                ASSERT_TRUE(age <= limits.sample_age_max || rig.spy.commands_nothing());
            }
        } else {
            rig.cycle();
            if (rig.last_cycle > milliseconds(1)) ++long_cycles;
            ASSERT_LE(long_cycles, kLongCyclesMax);
        }
        EXPECT_TRUE(rig.spy.commands_nothing());
        EXPECT_EQ(rig.state(), RunState::fault);
        const std::vector<EventTopic> faults = rig.faults();
        ASSERT_EQ(faults.size(), faults_before + 1);
        const EventTopic& fault = faults.back();
        EXPECT_EQ(fault.detail, 1U);
        EXPECT_TRUE(says(event_text(fault), {"of the first hand", "device"})) << event_text(fault);
        EXPECT_TRUE(says(fault_fix(fault), {"cable", "tact probe", "reset", "arm"})) << fault_fix(fault);
        for (int i = 0; i < 20; ++i) {
            rig.cycle();
            ASSERT_TRUE(rig.spy.commands_nothing());
        }
        if (!rig.station->silent_loss) {
            EXPECT_EQ(rig.spy.sample.notice, DeviceNotice::gone);
        }
    }
    // The device comes back: nothing happens until a person acts.
    void come_back(Rig& rig, std::mt19937& random, std::uint32_t cycles) {
        rig.cycles(static_cast<int>(random() % (cycles / 2)));
        rig.station->plug();
        for (std::uint32_t i = 0; i < cycles; ++i) {
            rig.cycle();
            ASSERT_EQ(rig.state(), RunState::fault);
            ASSERT_TRUE(rig.spy.commands_nothing());
            ASSERT_FALSE(rig.station->powered());
            ASSERT_EQ(rig.station->force_n(), 0.0);
        }
        rig.order(CommandKind::arm);  // not enough: the fault must be reset first
        rig.cycles(5);
        ASSERT_EQ(rig.state(), RunState::fault);
        ASSERT_TRUE(rig.spy.commands_nothing());
    }

    int long_cycles = 0;
};

TEST_P(Unplug, at_a_hundred_random_instants_the_force_is_zero_at_once_and_only_a_person_arms_again) {
    const bool own_process = GetParam().driver == std::string("sim-process");
    const std::uint32_t span = own_process ? 40 : 900;  // cycles
    int before_force = 0, with_force = 0;
    std::uint32_t seed = kSeed;
    const auto with_force_on = [&](Rig& rig, std::mt19937& random) {
        ASSERT_TRUE(rig.bring_to_force());
        rig.cycles(static_cast<int>(random() % (span / 3)));
        if (rig.state() != RunState::active) return;  // of the device with its own process, on a busy machine
        ASSERT_GT(rig.spy.command.wrench_dev.force_n.norm(), 0.01);
        ASSERT_NO_FATAL_FAILURE(pull(rig, random));
        ++with_force;
    };
    for (; with_force < kEach || before_force < kEach; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        ASSERT_LT(seed, kSeed + 20 * kEach) << "the machine is too busy";
        std::mt19937 random(seed);
        Rig rig(GetParam());
        if (before_force < kEach) {
            // After the start: ready, waiting for its calibration, or in the ramp.
            if (random() % 4 != 0) rig.order(CommandKind::arm);
            rig.cycles(static_cast<int>(random() % span));
            if (rig.state() == RunState::fault) continue;  // as above
            ASSERT_NO_FATAL_FAILURE(pull(rig, random));
            ++before_force;
            ASSERT_NO_FATAL_FAILURE(come_back(rig, random, own_process ? 4 : 700));
            if (rig.station->final_loss) continue;
        }
        ASSERT_NO_FATAL_FAILURE(with_force_on(rig, random));
        if (rig.state() != RunState::fault) continue;
        ASSERT_NO_FATAL_FAILURE(come_back(rig, random, own_process ? 4 : 700));
    }
    std::printf(
        "seeds %u to %u: %d instants before there was a force, %d with force; %d of their cycles longer than "
        "1 ms\n",
        kSeed, seed - 1, before_force, with_force, long_cycles);
}

INSTANTIATE_TEST_SUITE_P(Drivers, Unplug, testing::ValuesIn(kUnplugCases), [](const auto& tested) {
    std::string name = tested.param.driver;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST(UnplugCases, every_driver_of_the_table_is_tested) {
    std::set<std::string> table, tested;
    for (const DeviceEntry& d : device_drivers()) table.insert(d.name);
    for (const UnplugCase& c : kUnplugCases) tested.insert(c.driver);
    EXPECT_EQ(table, tested);
}

}  // namespace
}  // namespace tact
