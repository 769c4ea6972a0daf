// An emulated head tracker: the default one, also used by tests. The emulated bus goes through the same
// reader as a real one.
//
// Lockstep  its only time source is the `now` argument of read(), so the same calls give the same poses, on
//           any clock
#pragma once

#include "hal/sim/sim_head_bus.hpp"

namespace tact {

class SimTracker final : public Tracker {
public:
    explicit SimTracker(const SimHeadSettings& settings = {});

    TrackerInfo open() override;
    TrackerState read(unsigned sensor, TrackerSample& newest, Instant now) noexcept TACT_RT override;
    [[nodiscard]] TrackerHealth health() const noexcept TACT_RT override;

    void inject(TrackerFault fault) noexcept { bus_.inject(fault); }
    void hold(const Vec3& at_m) noexcept { bus_.hold(at_m); }
    void let_go() noexcept { bus_.let_go(); }
    [[nodiscard]] const SimHead& head() const noexcept { return bus_.head(); }
    [[nodiscard]] CanReaderCounts counts() const noexcept { return reader_.counts(); }

private:
    // Returns the `now` of the last read.
    class GivenClock final : public Clock {
    public:
        Instant now() noexcept TACT_RT override { return now_; }
        void wait_until(Instant /*t*/) noexcept TACT_RT override {}
        void set(Instant now) noexcept { now_ = now; }

    private:
        Instant now_{};
    };

    SimHeadSettings settings_;
    GivenClock clock_;
    SimHeadBus bus_;
    CanReader reader_;
    bool opened_ = false, started_ = false;
};

}  // namespace tact
