// The second of two hands as displayed: its pose predicted for display time.
//
// Frames   input in world axes and metres, output in model axes; both are parallel (ipc/scene/file/scene_meta.hpp)
// Thread   frame thread
#pragma once

#include <cstdint>
#include <optional>

#include "gui/link/pose_predictor.hpp"
#include "gui/render/drawn_hand.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/topics/tool.hpp"

namespace tact {

class SecondHand {
public:
    void follow(const ToolTopic& tool);
    // For another controller, which may have one hand.
    void forget() { predictor_.clear(); }
    // None without a second hand.
    [[nodiscard]] std::optional<DrawnHand> at(std::int64_t now_ns, const SceneMeta& scene) const;

private:
    PosePredictor predictor_;  // in world axes
    Vec3 force_world_n_ = Vec3::Zero();
    bool at_wall_ = false;
};

}  // namespace tact
