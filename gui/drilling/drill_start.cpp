#include "gui/drilling/drill_start.hpp"

namespace tact {

DrillStart::DrillStart(const SceneContent& content) {
    const BoneContent* const bone = content.of<BoneContent>();
    if (bone == nullptr) return;
    follower = std::make_unique<BoneFollower>(bone->volume, content.checksum);
    site = std::make_unique<SiteEffects>(follower->volume(), bone->labels, content.meta.world_per_model);
}

}  // namespace tact
