// Keeps the bone of the displayed scene equal to the controller's: the only place that connects both.
//
// Frame     use() for a new scene, meet() for a new controller or scene, leave() when the controller leaves; then
//           follow() once a frame. changes() holds its changes, for everything that shows bone.
// Thread    frame thread
#pragma once

#include <memory>
#include <span>

#include "gui/drilling/bone_follower.hpp"
#include "gui/link/controller.hpp"

namespace tact {

class BoneController {
public:
    static constexpr std::size_t kBricksAFrame =
        512;  // 256 KiB; a burr changes about ten per cycle, mostly the same

    void use(std::unique_ptr<BoneFollower> follower);  // null: not a bone scene
    void meet(const Controller& controller);
    void leave();
    void follow();

    [[nodiscard]] std::span<const BrickChange> changes() const { return changes_; }
    // The current copy; null: not a bone scene.
    [[nodiscard]] const BoneVolumeView* volume() const { return follower_ ? &follower_->volume() : nullptr; }

private:
    std::unique_ptr<BoneFollower> follower_;
    std::span<const BrickChange> changes_;
};

}  // namespace tact
