// Where a body is when the picture is seen: the newest pose, moved on at its filtered speed.
//
// Predicts  at most kHorizon past the newest pose; an old pose (the controller is silent) is shown as it is.
// Thread    one; no allocation.
#pragma once

#include <cstdint>

#include "ipc/base/pose.hpp"

namespace tact {

class PosePredictor {
public:
    static constexpr std::int64_t kHorizon_ns = 30'000'000;
    static constexpr std::int64_t kGap_ns = 200'000'000;  // longer: the speed is not known any more
    static constexpr double kSmooth_s = 0.04;             // of the speed

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
