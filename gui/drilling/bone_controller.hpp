// The bone of the scene that is shown, kept the same as the controller's: the one place that joins both.
//
// Frame     use() when a scene came, meet() when a controller came or a scene did, leave() when it went; then follow()
//           once a frame, and changes() is what has changed in it, for everything that shows bone.
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
        512;  // 256 KiB; a burr changes some ten a cycle, mostly the same

    void use(std::unique_ptr<BoneFollower> follower);  // null: the scene is not of bone
    void meet(const Controller& controller);
    void leave();
    void follow();

    [[nodiscard]] std::span<const BrickChange> changes() const { return changes_; }
    // Null: the scene is not of bone. The copy as it is now.
    [[nodiscard]] const BoneVolumeView* volume() const { return follower_ ? &follower_->volume() : nullptr; }

private:
    std::unique_ptr<BoneFollower> follower_;
    std::span<const BrickChange> changes_;
};

}  // namespace tact
