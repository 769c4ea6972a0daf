// Faults of Force Dimension's arms: what the device, its library or its cable can do to the force.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/forcedimension_driver.hpp"

namespace tact {
namespace {

using std::chrono::milliseconds;

struct FdError {
    std::atomic<int>* call;
    int code;
    fd::FaultKind kind;
    bool lost;
};

TEST_F(ForceDimensionTest, every_error_drops_the_force_at_once_and_needs_a_new_enable_edge) {
    using Kind = fd::FaultKind;
    for (const FdError& e : {FdError{&fake().fail_position, fd::kErrorCom, Kind::link, true},
                             FdError{&fake().fail_position, fd::kErrorTimeout, Kind::link, true},
                             FdError{&fake().fail_position, fd::kErrorGeometry, Kind::device, false},
                             FdError{&fake().fail_force, fd::kErrorCom, Kind::link, true},
                             FdError{&fake().fail_force, fd::kErrorBusy, Kind::busy, true},
                             FdError{&fake().fail_force, fd::kErrorNotEnabled, Kind::refused, false},
                             FdError{&fake().fail_force, 999, Kind::refused, false},
                             FdError{&fake().fail_position, fd::kErrorRedundantFail, Kind::device, false}}) {
        SCOPED_TRACE(e.code);
        fake().reset();
        open();
        power();
        *e.call = e.code;
        EXPECT_EQ(cycle(Vec3(1.0, 0.0, 0.0), true), e.lost ? IoStatus::lost : IoStatus::fault);
        EXPECT_EQ(shown(), Vec3::Zero());
        EXPECT_FALSE(arm().force.load());
        EXPECT_EQ(sample.state, DeviceState::fault);
        EXPECT_NE(sample.notice, DeviceNotice::none);
        EXPECT_EQ(device->counts().faults[static_cast<std::size_t>(e.kind)], 1U);
        EXPECT_EQ(device->counts().last_code, e.code);
        // The force stays off over time while enable stays up, also after the device was found again.
        cycles(800, Vec3(1.0, 0.0, 0.0), true);
        EXPECT_EQ(shown(), Vec3::Zero());
        EXPECT_EQ(device->counts().reopened, e.lost ? 1U : 0U);
        EXPECT_EQ(sample.state, DeviceState::fault);
        cycles(200, Vec3(1.0, 0.0, 0.0), false);
        EXPECT_EQ(shown(), Vec3::Zero());
        power();
        EXPECT_EQ(sample.notice, DeviceNotice::none);
        EXPECT_FALSE(std::string(fd::meaning(e.kind).says).empty());
        EXPECT_FALSE(std::string(fd::meaning(e.kind).fixes).empty());
    }
}

TEST_F(ForceDimensionTest, a_force_that_the_device_switches_off_is_a_fault_with_its_cause) {
    struct Row {
        int cause;
        fd::FaultKind kind;
    };
    using Kind = fd::FaultKind;
    for (const Row& row : {Row{1, Kind::button}, Row{2, Kind::velocity}, Row{3, Kind::firmware},
                           Row{4, Kind::force_off}, Row{6, Kind::button}, Row{77, Kind::force_off}}) {
        SCOPED_TRACE(row.cause);
        fake().reset();
        open();
        power();
        cycles(60, Vec3(1.0, 0.0, 0.0), true);
        EXPECT_EQ(sample.state, DeviceState::powered);
        arm().force = false;
        arm().force_off_cause = row.cause;
        cycles(9, Vec3(1.0, 0.0, 0.0), true);
        EXPECT_EQ(sample.state, DeviceState::fault);
        EXPECT_EQ(sample.notice, fd::meaning(row.kind).notice);
        EXPECT_EQ(device->counts().faults[static_cast<std::size_t>(row.kind)], 1U);
        // The person presses the button of the device: still no force without an enable edge.
        arm().force = true;
        cycles(300, Vec3(1.0, 0.0, 0.0), true);
        EXPECT_EQ(shown(), Vec3::Zero());
        cycles(200, Vec3::Zero(), false);
        power();
    }
}

TEST_F(ForceDimensionTest, a_refused_enable_and_a_controller_error_are_faults) {
    open();
    cycles(3, Vec3::Zero(), false);
    fake().fail_enable = fd::kErrorNotAvailable;
    EXPECT_EQ(cycles(2, Vec3(1.0, 0.0, 0.0), true), IoStatus::fault);
    EXPECT_FALSE(arm().force.load());
    EXPECT_TRUE(arm().brakes.load());
    cycles(200, Vec3::Zero(), false);
    power();
    arm().controller_error = 1;
    EXPECT_EQ(cycles(9, Vec3(1.0, 0.0, 0.0), true), IoStatus::fault);
    EXPECT_EQ(shown(), Vec3::Zero());
    EXPECT_EQ(device->counts().last_kind, fd::FaultKind::device);
}

TEST_F(ForceDimensionTest, a_wrench_that_is_not_finite_is_refused_and_counted) {
    open();
    power();
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        const std::uint64_t before = device->counts().refused_commands;
        command.wrench_dev.torque_n_m = Vec3::Zero();
        cycle(Vec3(1.0, value, 0.0), true);
        EXPECT_EQ(shown(), Vec3::Zero());
        command.wrench_dev.torque_n_m = Vec3(0.0, 0.0, value);
        cycle(Vec3(1.0, 0.0, 0.0), true);
        EXPECT_EQ(shown(), Vec3::Zero());
        EXPECT_EQ(device->counts().refused_commands, before + 2);
    }
}

TEST_F(ForceDimensionTest, after_relax_a_new_enable_edge_is_required) {
    open();
    power();
    device->relax();
    cycles(20, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(shown(), Vec3::Zero());
    cycles(2, Vec3::Zero(), false);
    power();
}

// The person's enable stays high through the loss, as a pressed pedal does.
TEST_F(ForceDimensionTest, unplugged_at_random_instants_it_is_lost_at_once_and_never_re_armed_by_itself) {
    std::mt19937 random(20261128);
    for (int run = 0; run < 40; ++run) {
        SCOPED_TRACE(run);
        fake().reset();
        settings.serial = run % 2 == 0 ? "" : "1001";
        open();
        power();
        cycles(static_cast<int>(random() % 200), Vec3(1.0, 0.0, 0.0), true);
        ASSERT_EQ(sample.state, DeviceState::powered);
        const bool keeps_initialization = random() % 2 == 0;
        arm().plugged = false;
        if (!keeps_initialization) arm().initialized = false;
        EXPECT_EQ(cycle(Vec3(1.0, 0.0, 0.0), true), IoStatus::lost);
        EXPECT_EQ(device->write(command, clock.now()), IoStatus::lost);
        EXPECT_EQ(sample.notice, DeviceNotice::gone);
        EXPECT_EQ(sample.state, DeviceState::fault);
        EXPECT_EQ(shown(), Vec3::Zero());
        EXPECT_EQ(cycles(static_cast<int>(random() % 2000), Vec3(1.0, 0.0, 0.0), true), IoStatus::lost);
        arm().plugged = true;
        EXPECT_EQ(cycles(1200, Vec3(1.0, 0.0, 0.0), true),
                  keeps_initialization ? IoStatus::fault : IoStatus::lost);
        EXPECT_EQ(shown(), Vec3::Zero());
        EXPECT_EQ(arm().auto_inits.load(), 0U);
        if (!keeps_initialization) {
            EXPECT_EQ(sample.notice, DeviceNotice::not_initialized);
            EXPECT_TRUE(asks(sample.notice));
            EXPECT_FALSE(arm().open.load());  // free for HapticInit, which the person runs now
            arm().initialized = true;
            cycles(600, Vec3(1.0, 0.0, 0.0), true);
            EXPECT_EQ(shown(), Vec3::Zero());
        }
        EXPECT_FALSE(arm().force.load());
        cycles(200, Vec3::Zero(), false);
        EXPECT_EQ(sample.state, DeviceState::ready);
        power();
        EXPECT_EQ(device->counts().reopened, 1U);
        EXPECT_EQ(sample.bus.reconnects, 1U);
    }
}

TEST_F(ForceDimensionTest, an_enable_edge_while_it_is_lost_powers_nothing_when_it_is_found) {
    open();
    power();
    arm().plugged = false;
    cycles(300, Vec3::Zero(), false);
    cycles(100, Vec3(1.0, 0.0, 0.0), true);
    arm().plugged = true;
    cycles(800, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(device->counts().reopened, 1U);
    EXPECT_EQ(shown(), Vec3::Zero());
    EXPECT_FALSE(arm().force.load());
    cycles(200, Vec3::Zero(), false);
    power();
}

TEST_F(ForceDimensionTest, an_initialization_lost_under_force_is_zero_force_and_an_action) {
    open();
    power();
    arm().initialized = false;
    EXPECT_EQ(cycles(9, Vec3(1.0, 0.0, 0.0), true), IoStatus::lost);
    EXPECT_EQ(shown(), Vec3::Zero());
    EXPECT_EQ(sample.notice, DeviceNotice::not_initialized);
    EXPECT_EQ(device->counts().last_kind, fd::FaultKind::not_initialized);
}

TEST_F(ForceDimensionTest, a_replaced_device_is_not_taken_for_the_lost_one) {
    open();
    power();
    arm().plugged = false;
    cycles(100, Vec3::Zero(), true);
    arm().serial = 2222;
    arm().plugged = true;
    EXPECT_EQ(cycles(1500, Vec3::Zero(), false), IoStatus::lost);
    EXPECT_FALSE(arm().open.load());
    arm().serial = 1001;
    EXPECT_EQ(cycles(700, Vec3::Zero(), false), IoStatus::ok);
}

}  // namespace
}  // namespace tact
