#include "rt/force/drilling/drill_bone.hpp"

#include <algorithm>
#include <atomic>

namespace tact {
namespace {
constexpr std::size_t kTimesOver = 4;  // so often the strokes of a small bone can change every brick
}  // namespace

std::size_t DrillBone::room_for(const BoneBricks& bricks) {
    return std::min(kTimesOver * bricks.brick_count(), StrokeHistory::kRoomMost);
}

void DrillBone::exchange() noexcept {
    const auto& n = octree.blocks(0);
    strokes.exchange(density, [&](std::uint32_t brick) {
        const MomentOctree::Brick lost =
            octree.refresh(brick % n[0], brick / n[0] % n[1], brick / n[0] / n[1]);
        returned_levels -= lost.m0;
        raise_revision(revision[brick]);
    });
}

// A reader that sees the new number, with acquire, sees the densities too.
void raise_revision(std::uint32_t& revision) noexcept {
    const std::atomic_ref<std::uint32_t> number(revision);
    number.store(number.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

}  // namespace tact
