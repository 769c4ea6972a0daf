// Predicts a body's pose at display time: the newest pose, extrapolated at its filtered velocity.
//
// Predicts  at most kHorizon_ns past the newest pose; one older than kGap_ns (silent controller) stays unchanged.
// Thread    one; no allocation.
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"

namespace tact {

class PosePredictor {
public:
    static constexpr std::int64_t kHorizon_ns = 30'000'000;
    static constexpr std::int64_t kGap_ns = 200'000'000;  // a longer gap invalidates the velocity
    static constexpr double kSmooth_s = 0.04;             // time constant of the velocity filter

    void add(std::int64_t taken_at_ns, const Pose& pose);
    void clear() { known_ = false; }
    [[nodiscard]] bool known() const { return known_; }
    [[nodiscard]] const Pose& newest() const { return pose_; }
    [[nodiscard]] Pose at(std::int64_t now_ns) const;

private:
    bool known_ = false;
    std::int64_t taken_at_ns_ = 0;
    Pose pose_;
    Vec3 speed_m_s_ = Vec3::Zero();
    Vec3 spin_rad_s_ = Vec3::Zero();  // in model axes
};

}  // namespace tact
