// The second of two hands as the picture shows it: where it will be when the picture is seen.
//
// Frames   comes in world axes and metres, goes in model axes; the two are parallel (ipc/scene/file/scene_meta.hpp)
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
    // Of another controller, which may have one hand.
    void forget() { predictor_.clear(); }
    // None where there is no second hand.
    [[nodiscard]] std::optional<DrawnHand> at(std::int64_t now_ns, const SceneMeta& scene) const;

private:
    PosePredictor predictor_;  // in world axes
    Vec3 force_world_n_ = Vec3::Zero();
    bool at_wall_ = false;
};

}  // namespace tact
