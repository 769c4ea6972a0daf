// The contract of every haptic device driver, emulated or real. A driver's test gives a factory and inherits:
//
//     INSTANTIATE_TEST_SUITE_P(Sim, HapticDeviceContract, testing::Values(DeviceCase{...}));
//
// The test controls time: `elapse` lets a duration pass for the device (lockstep: it advances `now`; a device with
// a clock of its own: it sleeps). With such a device, a claim that failed while the machine paused for longer than
// `steady` is inconclusive and is retried.
#pragma once

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>

#include "hal/api/haptic_device.hpp"

namespace tact {

struct DeviceCase {
    const char* name;
    std::function<std::unique_ptr<HapticDevice>()> make;
    std::function<Instant(Instant, Duration)> elapse;
    Duration silence = std::chrono::milliseconds(40);  // well beyond the device's watchdog
    Duration steady = Duration::max();                 // own clock: less than five cycles
};

class HapticDeviceContract : public testing::TestWithParam<DeviceCase> {
protected:
    // Checks the claim on a fresh device.
    void holds(const std::function<void()>& claim) {
        using testing::ScopedFakeTestPartResultReporter;
        const Instant end = Monotonic::now() + std::chrono::minutes(1);
        while (true) {
            testing::TestPartResultArray found;
            {
                ScopedFakeTestPartResultReporter reporter(
                    ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &found);
                device_ = GetParam().make();
                info_ = device_->open();
                now_ = GetParam().elapse(Monotonic::now(), std::chrono::milliseconds(1));
                disturbed_ = false;
                heartbeat_ = 0;
                claim();
                device_->relax();
            }
            bool failed = false;
            for (int i = 0; i < found.size(); ++i) failed = failed || found.GetTestPartResult(i).failed();
            if (failed && disturbed_) {
                if (Monotonic::now() < end) continue;
                GTEST_SKIP() << "the machine was too busy for a minute";
            }
            for (int i = 0; i < found.size(); ++i) {
                const testing::TestPartResult& r = found.GetTestPartResult(i);
                if (r.failed()) ADD_FAILURE_AT(r.file_name(), r.line_number()) << r.message();
            }
            return;
        }
    }

    void elapse(Duration d) {
        const Instant before = now_;
        now_ = GetParam().elapse(now_, d);
        disturbed_ = disturbed_ || now_ - before - d > GetParam().steady;
    }
    IoStatus write(const Vec3& force_n, bool enable) {
        DeviceCommand command;
        command.wrench_dev.force_n = force_n;
        command.enable = enable;
        command.heartbeat = ++heartbeat_;
        return device_->write(command, now_);
    }
    DeviceSample read() {
        DeviceSample sample;
        status_ = device_->read(sample, now_);
        disturbed_ = disturbed_ || now_ - sample.taken_at > GetParam().steady;
        return sample;
    }
    // Runs n cycles of one millisecond.
    DeviceSample cycles(int n, const Vec3& force_n, bool enable) {
        DeviceSample sample;
        for (int i = 0; i < n; ++i) {
            elapse(std::chrono::milliseconds(1));
            sample = read();
            EXPECT_EQ(write(force_n, enable), IoStatus::ok);
        }
        return sample;
    }
    // Displacement within n cycles at that force.
    double way_m(int n, const Vec3& force_n, bool enable) {
        const Vec3 before = read().T_dev_tool.p_m;
        return (cycles(n, force_n, enable).T_dev_tool.p_m - before).norm();
    }

    std::unique_ptr<HapticDevice> device_;
    DeviceInfo info_;
    Instant now_{};
    IoStatus status_ = IoStatus::ok;
    std::uint64_t heartbeat_ = 0;
    bool disturbed_ = false;
};

TEST_P(HapticDeviceContract, describes_itself) {
    holds([&] {
        EXPECT_FALSE(info_.name.empty());
        EXPECT_GT(info_.force_n_max, 0.0);
        EXPECT_GE(info_.force_n_max, info_.force_n_continuous);
        EXPECT_GT(info_.position_step_m, 0.0);
        EXPECT_TRUE((info_.workspace_half_m.array() > 0.0).all());
    });
}

TEST_P(HapticDeviceContract, samples_are_finite_rise_in_sequence_and_are_never_from_the_future) {
    holds([&] {
        std::uint64_t before = 0;
        for (int i = 0; i < 20; ++i) {
            const DeviceSample s = cycles(1, Vec3::Zero(), false);
            const bool own_clock = GetParam().steady != Duration::max();
            EXPECT_TRUE(status_ == IoStatus::ok || (own_clock && status_ == IoStatus::stale));
            EXPECT_TRUE(s.T_dev_tool.finite());
            EXPECT_NEAR(s.T_dev_tool.q.norm(), 1.0, 1e-9);
            EXPECT_GE(s.sequence, before);
            EXPECT_LE(to_ns(s.taken_at), to_ns(now_));
            before = s.sequence;
        }
        EXPECT_GT(before, 1U);
    });
}

TEST_P(HapticDeviceContract, without_enable_every_wrench_gives_no_force) {
    holds([&] {
        EXPECT_LT(way_m(100, Vec3(3.0, 0.0, 0.0), false), 2.0 * info_.position_step_m);
        EXPECT_EQ(read().state, DeviceState::ready);
    });
}

TEST_P(HapticDeviceContract, with_enable_a_force_moves_the_hand_in_its_direction) {
    holds([&] {
        cycles(5, Vec3::Zero(), true);
        EXPECT_EQ(read().state, DeviceState::powered);
        const Vec3 before = read().T_dev_tool.p_m;
        const Vec3 moved = cycles(100, Vec3(0.0, 1.0, 0.0), true).T_dev_tool.p_m - before;
        EXPECT_GT(moved.y(), 10.0 * info_.position_step_m);
        EXPECT_NEAR(moved.x(), 0.0, 2.0 * info_.position_step_m);
    });
}

TEST_P(HapticDeviceContract, silence_of_the_controller_trips_its_own_watchdog_until_a_new_enable_edge) {
    holds([&] {
        cycles(5, Vec3::Zero(), true);
        elapse(GetParam().silence);
        EXPECT_EQ(read().state, DeviceState::watchdog_tripped);
        // An enable that stayed high does not restore the force.
        EXPECT_LT(way_m(50, Vec3(2.0, 0.0, 0.0), true), 0.5e-3);
        EXPECT_EQ(read().state, DeviceState::watchdog_tripped);
        cycles(5, Vec3::Zero(), false);
        cycles(5, Vec3::Zero(), true);
        EXPECT_EQ(read().state, DeviceState::powered);
    });
}

TEST_P(HapticDeviceContract, a_constant_heartbeat_counts_as_silence) {
    holds([&] {
        cycles(5, Vec3::Zero(), true);
        DeviceCommand same;
        same.enable = true;
        same.heartbeat = heartbeat_;
        for (Duration t{0}; t < GetParam().silence; t += std::chrono::milliseconds(1)) {
            elapse(std::chrono::milliseconds(1));
            static_cast<void>(device_->write(same, now_));
        }
        EXPECT_EQ(read().state, DeviceState::watchdog_tripped);
    });
}

TEST_P(HapticDeviceContract, a_wrench_that_is_not_finite_gives_no_force) {
    holds([&] {
        cycles(5, Vec3::Zero(), true);
        const double nan = std::numeric_limits<double>::quiet_NaN();
        EXPECT_LT(way_m(50, Vec3(nan, 1.0, 0.0), true), 2.0 * info_.position_step_m);
    });
}

TEST_P(HapticDeviceContract, relax_works_in_any_state_and_twice) {
    holds([&] {
        device_->relax();
        device_->relax();
        cycles(5, Vec3(1.0, 0.0, 0.0), true);
        device_->relax();
        device_->relax();
        elapse(GetParam().silence / 2);  // without relax() the watchdog would have tripped by now
        EXPECT_EQ(read().state, DeviceState::ready);
        const std::unique_ptr<HapticDevice> unopened = GetParam().make();
        unopened->relax();
        DeviceSample sample;
        EXPECT_EQ(unopened->read(sample, now_), IoStatus::lost);
    });
}

}  // namespace tact
