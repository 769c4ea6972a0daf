// The bone that the tools of a scene share: its densities, its moments, and its strokes.
//
// Memory   of the spans must outlive it: densities in brick order, and one revision a brick, which rises after each change
//          of it (store: release)
// Thread   constructed anywhere (may throw StartupError); then one. No allocation.
#pragma once

#include <cstdint>
#include <span>

#include "rt/force/drilling/moment_octree.hpp"
#include "rt/force/drilling/stroke_history.hpp"

namespace tact {

struct DrillBone {
    DrillBone(const BoneBricks& bricks, std::span<std::uint8_t> densities, std::span<std::uint32_t> revisions)
        : octree(bricks, densities),
          strokes(bricks.brick_count(), room_for(bricks)),
          density(densities),
          revision(revisions) {}

    MomentOctree octree;
    StrokeHistory strokes;
    std::span<std::uint8_t> density;
    std::span<std::uint32_t> revision;
    std::int64_t returned_levels =
        0;  // by undone strokes; below zero: taken by redone ones, and before the start

    // Of the tools, a bit each: whose force is not zero now. Bricks are exchanged only where none is felt.
    std::uint32_t tools = 0, pushing = 0;
    std::uint32_t add_tool() noexcept { return 1U << (tools++ % 32U); }

    // Some bricks of the stroke that is undone or redone.
    void exchange() noexcept TACT_RT;

private:
    static std::size_t room_for(const BoneBricks& bricks);
};

// Densities of a brick changed.
void raise_revision(std::uint32_t& revision) noexcept TACT_RT;

}  // namespace tact
