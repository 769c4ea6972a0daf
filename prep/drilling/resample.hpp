// From a scan's slices to the cubes of a bone volume, turned so that a chosen side of the patient looks at the user.
//
// Values    linear between voxels where the new voxel is the finer one, else averaged with a tent as wide as it, so
//           that nothing is skipped. Slices may lie at any distance from each other and be shifted sideways (a tilted
//           gantry): each is taken from where it is. Labels: the nearest voxel's.
// Sides     axes are swapped and reversed, never mirrored: left stays left.
// Memory    the result, and some planes of it; for labels the label file's voxels, a byte each, besides.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_bricks.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

enum class BoneFace : std::uint8_t {
    front,
    back,
    left,
    right,
    top,
    bottom
};  // of the patient, towards the user

struct SamplePlan {
    BoneBricks bricks;  // the middle of the volume is model (0, 0, 0)
    double voxel_mm = 0.0;
    std::array<std::uint32_t, 3> count{};  // along the scan's columns, rows and normal
    std::array<double, 3> start_mm{};      // of the first, along these
    std::array<std::size_t, 3> axis{};     // model axis a is this one of them,
    std::array<bool, 3> reversed{};        // the other way round
    [[nodiscard]] std::size_t voxel(std::uint32_t u, std::uint32_t v, std::uint32_t s) const {
        const std::array<std::uint32_t, 3> from{u, v, s};
        std::array<std::uint32_t, 3> to;
        for (std::size_t a = 0; a < 3; ++a)
            to[a] = reversed[a] ? count[axis[a]] - 1 - from[axis[a]] : from[axis[a]];
        return bricks.voxel(to[0], to[1], to[2]);
    }
};

// voxel_mm 0: the scan's finest. Throws StartupError where the volume would be too large; takes no memory.
SamplePlan plan_samples(const Scan& scan, double voxel_mm, BoneFace face);

// 0 at `low` and below, 255 at `high` and above, at least 1 between them.
std::vector<std::uint8_t> sample_density(const Scan& scan, const SamplePlan& plan, double low, double high,
                                         const Progress& progress);
// The labels of `labels`, which may lie otherwise than the scan, at the plan's voxels; 0 outside of them.
// Where one of them does not say where it lies, both have to be of one size, and are taken to lie together.
std::vector<std::uint8_t> sample_labels(const Scan& scan, const SamplePlan& plan, const Scan& labels,
                                        const Progress& progress);

}  // namespace tact
