#include "gui/drilling/bone_controller.hpp"

#include <spdlog/spdlog.h>

#include <string>

namespace tact {

void BoneController::use(std::unique_ptr<BoneFollower> follower) {
    changes_ = {};
    follower_ = std::move(follower);
}

void BoneController::meet(const Controller& controller) {
    changes_ = {};
    if (!follower_ || !controller.attached()) return;
    const std::string why =
        controller.bone_refusal().empty() ? follower_->attach(controller.bone()) : controller.bone_refusal();
    if (!why.empty()) spdlog::warn("showing the bone as baked, without drilling: {}", why);
}

void BoneController::leave() {
    changes_ = {};
    if (follower_) follower_->detach();
}

void BoneController::follow() {
    changes_ = follower_ ? follower_->follow(kBricksAFrame) : std::span<const BrickChange>{};
}

}  // namespace tact
