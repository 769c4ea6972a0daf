// The instruments to draw in a drilling scene, from the controller's record of the hands.
//
// At 60 000 rpm a burr would appear to stand or to turn backwards. It is therefore drawn turning as slowly as the eye
// can follow at the frame rate, and standing when it stands.
// Thread   frame thread
#pragma once

#include <array>
#include <span>

#include "gui/drilling/drill_tools.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/topics/drill.hpp"

namespace tact {

class DrillHands {
public:
    // The topic must be checked (region_checks.hpp). The result is valid until the next call.
    std::span<const DrawnDrillTool> follow(const DrillTopic& topic, const SceneMeta& meta);

private:
    std::array<double, kDrillHands> turned_rad_{};
    std::array<DrawnDrillTool, kDrillHands> drawn_{};
};

}  // namespace tact
