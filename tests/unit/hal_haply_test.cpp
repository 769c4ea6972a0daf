// The driver of Haply's arms behind the contract, with a substitute for the manufacturer's service.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/inverse_driver.hpp"
#include "tests/support/pumped_case.hpp"
#include "tests/support/says.hpp"

namespace tact {
namespace {

using std::chrono::milliseconds;

InverseClock inverse_contract_clock;
FakeInverse inverse_contract_service;

INSTANTIATE_TEST_SUITE_P(Inverse3, HapticDeviceContract,
                         testing::Values(pumped_case<Inverse3>("inverse3", inverse_contract_clock,
                                                               [] {
                                                                   inverse_contract_service = {};
                                                                   inverse_contract_clock.service =
                                                                       &inverse_contract_service;
                                                                   return std::make_unique<Inverse3>(
                                                                       inverse_settings(),
                                                                       std::make_unique<FakeInverseChannel>(
                                                                           inverse_contract_service),
                                                                       inverse_contract_clock);
                                                               })),
                         [](const auto& tested) { return tested.param.name; });

class Inverse3Test : public VendorDriverTest<Inverse3, InverseClock> {
protected:
    Inverse3Test() { cycles_to_power = 4; }

    void open() override {
        clock.device = nullptr;
        device = std::make_unique<Inverse3>(settings, std::make_unique<FakeInverseChannel>(service), clock);
        info = device->open();
        clock.device = device.get();
        clock.service = &service;
    }
    [[nodiscard]] Vec3 shown() const override {
        return {service.force_n[0], service.force_n[2], -service.force_n[1]};
    }

    FakeInverse service;
    Inverse3Settings settings = inverse_settings();
};

TEST_F(Inverse3Test, axes_origin_and_grip_become_those_of_tact) {
    service.grip = true;
    open();
    EXPECT_EQ(info.name, "Haply Inverse3");
    EXPECT_EQ(info.serial, "049D");
    EXPECT_EQ(info.torque_n_m_max, 0.0);
    EXPECT_EQ(service.preset, "arm_front_centered");
    service.at_m = {0.01, 0.02, 0.03};  // right, away, up
    service.speed_m_s = {0.0, 0.0, 0.0};
    service.turn_wxyz = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};  // a quarter turn about up
    service.buttons = 5;
    ASSERT_EQ(cycle(Vec3::Zero(), false), IoStatus::ok);
    EXPECT_LT((sample.T_dev_tool.p_m - Vec3(0.01, 0.03, -0.02)).norm(), 1e-12);
    EXPECT_LT((sample.T_dev_tool.q * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_LT((sample.T_dev_tool.q * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12);
    EXPECT_EQ(sample.buttons, 5U);
    power();
    cycles(2, Vec3(1.0, 2.0, 1.5), true);
    EXPECT_LT((shown() - Vec3(1.0, 2.0, 1.5)).norm(), 1e-4);
    EXPECT_DOUBLE_EQ(service.force_n[1], -1.5);
    cycles(2, Vec3(0.0, 30.0, 40.0), true);
    EXPECT_LT((shown() - 3.0 * Vec3(0.0, 0.6, 0.8)).norm(), 1e-4);
    service.type = "minverse";
    open();
    EXPECT_EQ(info.name, "Haply Minverse");
    EXPECT_DOUBLE_EQ(info.workspace_half_m.x(), 0.04);
}

TEST_F(Inverse3Test, without_power_no_message_has_a_force_and_the_delay_is_measured) {
    open();
    cycles(50, Vec3(1.0, 0.0, 0.0), false);
    EXPECT_EQ(service.forces, 0);
    EXPECT_GT(service.messages, 50);
    EXPECT_EQ(sample.delay, milliseconds(4));  // two rounds of the pump, one of the servo, one estimated
    power();
    EXPECT_GT(service.forces, 0);
    device->relax();
    cycles(20, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(shown(), Vec3::Zero());
    cycles(2, Vec3::Zero(), false);
    power();
    clock.device = nullptr;
    device.reset();  // the last message has no force
    EXPECT_EQ(shown(), Vec3::Zero());
}

TEST_F(Inverse3Test, a_force_that_is_not_finite_is_zero_and_counted) {
    open();
    power();
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        cycles(2, Vec3(1.0, value, 0.0), true);
        EXPECT_EQ(shown(), Vec3::Zero());
    }
    EXPECT_GE(device->counts().refused_commands, 2U);
}

TEST_F(Inverse3Test, open_errors_are_reported_with_a_fix) {
    service.running = false;
    EXPECT_TRUE(says(refusal(), {"127.0.0.1:10001", "Connection refused", "fix:", "haply-inverse-service",
                                 "device.inverse_port", "deploy/units"}));
    service = {};
    service.plugged = false;
    EXPECT_TRUE(says(refusal(), {"does not list this arm", "fix:", "Haply Hub"}));
    service = {};
    service.second = true;
    EXPECT_TRUE(says(refusal(), {"several arms", "0007, 049D", "device.serial"}));
    settings.serial = "049D";
    EXPECT_EQ(refusal(), "it opened");
    settings.serial = "1\"}";
    EXPECT_TRUE(says(refusal(), {"letters, digits", "fix:"}));
    settings.serial = "";
    service = {};
    service.old_version = true;
    EXPECT_TRUE(says(refusal(), {"older than 3.5", "fix:"}));
    service = {};
    service.silent = true;
    EXPECT_TRUE(says(refusal(), {"does not answer as documented"}));
    service = {};
    service.garbage = true;
    EXPECT_TRUE(says(refusal(), {"does not answer as documented"}));
    service = {};
    service.at_m = {1e300, 0.0, 0.0};
    EXPECT_TRUE(says(refusal(), {"does not answer as documented"}));
}

TEST_F(Inverse3Test, lost_at_random_instants_it_is_zero_at_once_and_never_re_armed_by_itself) {
    std::mt19937 random(20261128);
    for (int run = 0; run < 40; ++run) {
        SCOPED_TRACE(run);
        service = {};
        settings.serial = run % 2 == 0 ? "" : "049D";
        open();
        power();
        cycles(static_cast<int>(random() % 150), Vec3(1.0, 0.0, 0.0), true);
        bool* const faults[] = {&service.plugged, &service.running, &service.silent, &service.breaks,
                                &service.garbage};
        bool& fault = *faults[run % 5];
        const bool good = fault;
        fault = !good;
        EXPECT_EQ(cycle(Vec3(1.0, 0.0, 0.0), true), IoStatus::lost);
        EXPECT_EQ(sample.state, DeviceState::fault);
        EXPECT_EQ(sample.notice, &fault == &service.silent ? DeviceNotice::silent : DeviceNotice::gone);
        cycles(10, Vec3(1.0, 0.0, 0.0), true);
        EXPECT_EQ(shown(), Vec3::Zero());
        EXPECT_EQ(cycles(static_cast<int>(random() % 1500), Vec3(1.0, 0.0, 0.0), true), IoStatus::lost);
        // An edge during the loss powers nothing.
        cycles(200, Vec3::Zero(), false);
        fault = good;
        const int forces = service.forces;
        EXPECT_EQ(cycles(800, Vec3(1.0, 0.0, 0.0), true), IoStatus::fault);
        EXPECT_EQ(service.forces, forces);
        cycles(200, Vec3::Zero(), false);
        power();
        EXPECT_EQ(device->counts().reopened, 1U);
    }
}

TEST_F(Inverse3Test, an_arm_that_is_not_calibrated_has_no_force_and_says_so) {
    open();
    power();
    service.calibrated = false;
    EXPECT_EQ(cycles(2, Vec3(1.0, 0.0, 0.0), true), IoStatus::fault);
    EXPECT_EQ(shown(), Vec3::Zero());
    EXPECT_EQ(sample.notice, DeviceNotice::not_initialized);
    service.calibrated = true;
    cycles(300, Vec3(1.0, 0.0, 0.0), true);
    EXPECT_EQ(shown(), Vec3::Zero());
    cycles(200, Vec3::Zero(), false);
    power();
}

TEST_F(Inverse3Test, impossible_poses_are_refused_and_the_last_one_ages) {
    open();
    for (const char* const position : {R"({"x":1e300,"y":0,"z":0})", R"({"x":"1","y":0,"z":0})", R"([1,2,3])",
                                       R"({"x":null,"y":0})", R"({"x":0.1,"y":0.7,"z":0})"}) {
        cycles(3, Vec3::Zero(), false);
        const std::uint64_t before = sample.sequence;
        const auto refused = device->counts().refused_samples;
        service.raw = std::string(R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":)") +
                      position + "}}]}";
        EXPECT_EQ(cycle(Vec3::Zero(), false), IoStatus::stale) << position;
        EXPECT_EQ(sample.sequence, before);
        EXPECT_EQ(device->counts().refused_samples, refused + 1);
        EXPECT_EQ(cycles(110, Vec3::Zero(), false), IoStatus::lost);
        service.raw.clear();
    }
}

TEST_F(Inverse3Test, a_servo_stopped_for_ten_milliseconds_gives_zero_force) {
    open();
    power();
    clock.wait_until(clock.now() + milliseconds(9));
    EXPECT_EQ(shown().x(), 1.0);
    clock.wait_until(clock.now() + milliseconds(4));
    EXPECT_EQ(shown(), Vec3::Zero());
    static_cast<void>(device->read(sample, clock.now()));
    EXPECT_EQ(sample.state, DeviceState::watchdog_tripped);
}

}  // namespace
}  // namespace tact
