// Combines frames into whole poses: pairs classic frames by their counter, checks the order of counters,
// and refuses impossible values.
//
// Counters  one more than the last is right; up to kCounterLead more is accepted and the gap counted as
//           missed; the same value is a repetition; anything else is a jump: refused, and counting
//           continues from there
// Range     a sensor farther from the tracker's origin than reach_m is refused
// Thread    one; no allocation
#pragma once

#include <array>
#include <cstdint>

#include "hal/tracker/pose_frames.hpp"

namespace tact {

enum class CanFormat : std::uint8_t { classic, fd };

struct FixSettings {
    CanFormat format = CanFormat::classic;
    unsigned sensors = 1;  // 1 to 4
    double reach_m = 1.6;
};

struct TrackerFix {
    std::uint8_t sensor = 0;
    std::uint8_t status = 0;
    std::uint32_t time_us = 0;  // the tracker's clock
    Pose T_tracker_sensor;
    double quality = 1.0;
    double distortion = 0.0;
};

class FixAssembler {
public:
    static constexpr unsigned kCounterLead = 3;  // "older than three periods" for a gap in the counter

    explicit FixAssembler(const FixSettings& settings) : settings_(settings) {}

    // True: `fix` is a new whole pose. Refusals are counted.
    bool take(const CanFrame& frame, TrackerFix& fix) noexcept;
    // Clears counters and halves; for use after an interruption of the bus.
    void restart() noexcept;

    [[nodiscard]] const RefusalCounts& refused() const noexcept { return refused_; }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }
    [[nodiscard]] TrackerStatus status() const noexcept { return status_; }
    void refuse(Refusal why) noexcept { refused_.add(why); }

private:
    struct Order {
        bool known = false;
        std::uint16_t last = 0;
    };
    struct Halves {
        bool pos = false, quat = false;
        std::uint8_t status = 0;
        Vec3 p_m = Vec3::Zero();
        Quat q = Quat::Identity();
    };

    [[nodiscard]] Refusal follow(Order& order, std::uint16_t counter, unsigned mask) noexcept;
    [[nodiscard]] Refusal take_sync(const CanFrame& frame) noexcept;
    [[nodiscard]] Refusal take_pos(const CanFrame& frame, TrackerFix& fix, bool& whole) noexcept;
    [[nodiscard]] Refusal take_quat(const CanFrame& frame, TrackerFix& fix, bool& whole) noexcept;
    [[nodiscard]] Refusal take_pose(const CanFrame& frame, TrackerFix& fix, bool& whole) noexcept;
    [[nodiscard]] Refusal whole_pair(std::uint8_t sensor, TrackerFix& fix, bool& whole) noexcept;
    [[nodiscard]] Refusal judge(std::uint8_t status, const Vec3& p_m) const noexcept;
    void drop_halves() noexcept;

    FixSettings settings_;
    RefusalCounts refused_;
    std::uint64_t missed_ = 0;
    TrackerStatus status_ = TrackerStatus::ok;
    Order sync_order_;
    bool sync_open_ = false;
    SyncFrame sync_;
    std::array<Halves, kTrackerSensorsMax> halves_;
    std::array<Order, kTrackerSensorsMax> pose_order_;
};

}  // namespace tact
