// The instruments of a drilling scene as they are drawn, from what the controller says of the hands.
//
// A burr at 60 000 turns a minute would be seen standing or turning backwards; it is drawn turning as slowly as the eye can
// follow at this rate of pictures, and standing when it stands.
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
    // Checked topic (region_checks.hpp). Valid until the next call.
    std::span<const DrawnDrillTool> follow(const DrillTopic& topic, const SceneMeta& meta);

private:
    std::array<double, kDrillHands> turned_rad_{};
    std::array<DrawnDrillTool, kDrillHands> drawn_{};
};

}  // namespace tact
