// The tracker's contract: emulated in lockstep, and the CAN driver with its thread on an emulated bus.
#include <thread>

#include "hal/tracker/can_tracker.hpp"
#include "tests/contract/tracker_contract.hpp"

namespace tact {
namespace {

SimHeadSettings two_sensors(CanFormat format) {
    SimHeadSettings settings;
    settings.can.fix.format = format;
    settings.can.fix.sensors = 2;
    return settings;
}

class LockstepRig final : public TrackerRig {
public:
    explicit LockstepRig(CanFormat format) : tracker_(two_sensors(format)) {}
    Tracker& tracker() override { return tracker_; }
    const SimHead& head() override { return tracker_.head(); }
    void inject(TrackerFault fault) override { tracker_.inject(fault); }
    Instant elapse(Instant now, Duration d) override { return now + d; }

private:
    SimTracker tracker_;
};

class ThreadRig final : public TrackerRig {
public:
    explicit ThreadRig(CanFormat format) {
        const SimHeadSettings settings = two_sensors(format);
        auto bus = std::make_unique<SimHeadBus>(settings, clock_);
        bus_ = bus.get();
        tracker_ = std::make_unique<CanTracker>(settings.can, std::move(bus), "emulated bus");
    }
    Tracker& tracker() override { return *tracker_; }
    const SimHead& head() override { return bus_->head(); }
    void inject(TrackerFault fault) override { bus_->inject(fault); }
    Instant elapse(Instant, Duration d) override {
        std::this_thread::sleep_for(d);
        return Monotonic::now();
    }

private:
    ServoClock clock_{Duration{0}};
    SimHeadBus* bus_ = nullptr;
    std::unique_ptr<CanTracker> tracker_;
};

template <class Rig>
std::function<std::unique_ptr<TrackerRig>()> rig(CanFormat format) {
    return [format] { return std::make_unique<Rig>(format); };
}

const auto kName = [](const auto& tested) { return std::string(tested.param.name); };

// Five standard deviations of noise plus 0.5 m/s over the 1 ms between two reads.
INSTANTIATE_TEST_SUITE_P(Sim, TrackerContract,
                         testing::Values(TrackerCase{"classic", rig<LockstepRig>(CanFormat::classic), 4e-3},
                                         TrackerCase{"fd", rig<LockstepRig>(CanFormat::fd), 4e-3}),
                         kName);

// On the real clock. The head sways by 5 cm, so a pose is within that at any time.
INSTANTIATE_TEST_SUITE_P(Can, TrackerContract,
                         testing::Values(TrackerCase{"thread", rig<ThreadRig>(CanFormat::classic), 0.25}),
                         kName);

TEST(SimTracker, the_same_calls_give_the_same_poses) {
    const auto run = [] {
        SimTracker tracker(two_sensors(CanFormat::classic));
        tracker.open();
        TrackerSample s;
        for (int i = 0; i < 500; ++i) static_cast<void>(tracker.read(0, s, instant_from_ns(i * 1'300'000)));
        return s;
    };
    const TrackerSample one = run(), other = run();
    EXPECT_GT(one.sequence, 100U);
    EXPECT_EQ(one.sequence, other.sequence);
    EXPECT_EQ(one.T_tracker_sensor.p_m, other.T_tracker_sensor.p_m);
    EXPECT_EQ(one.T_tracker_sensor.q.coeffs(), other.T_tracker_sensor.q.coeffs());
}

}  // namespace
}  // namespace tact
