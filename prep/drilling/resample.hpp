// Resamples a scan to the cubes of a bone volume, rotated so that a chosen side of the patient faces the user.
//
// Values    linear interpolation if the new voxel is finer, else a tent-weighted mean as wide as the new voxel, so
//           that no voxel is skipped. Slices may have any spacing and lateral shift (tilted gantry): each is sampled at
//           its true position. Labels: nearest voxel.
// Sides     axes are swapped and reversed, never mirrored: left stays left.
// Memory    the result and some planes of it; for labels also one byte per voxel of the label file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_bricks.hpp"
#include "ipc/scene/bone/patient_frame.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

enum class BoneFace : std::uint8_t {
    front,
    back,
    left,
    right,
    top,
    bottom
};  // side of the patient that faces the user

struct SamplePlan {
    BoneBricks bricks;  // the middle of the volume is model (0, 0, 0)
    double voxel_mm = 0.0;
    std::array<std::uint32_t, 3> count{};  // along the scan's columns, rows and normal
    std::array<double, 3> start_mm{};      // of the first voxel, along these axes
    std::array<std::size_t, 3> axis{};     // model axis a is this scan axis,
    std::array<bool, 3> reversed{};        // reversed if true
    // Of the model in the patient; the scan is oriented.
    [[nodiscard]] PatientFrame patient(const Scan& scan) const;
    [[nodiscard]] std::size_t voxel(std::uint32_t u, std::uint32_t v, std::uint32_t s) const {
        const std::array<std::uint32_t, 3> from{u, v, s};
        std::array<std::uint32_t, 3> to;
        for (std::size_t a = 0; a < 3; ++a)
            to[a] = reversed[a] ? count[axis[a]] - 1 - from[axis[a]] : from[axis[a]];
        return bricks.voxel(to[0], to[1], to[2]);
    }
};

// voxel_mm 0: the finest spacing of the scan. Throws StartupError if the volume would be too large; allocates nothing.
SamplePlan plan_samples(const Scan& scan, double voxel_mm, BoneFace face);

// Density 0 at `low` and below, 255 at `high` and above, at least 1 between.
std::vector<std::uint8_t> sample_density(const Scan& scan, const SamplePlan& plan, double low, double high,
                                         const Progress& progress);
// Labels of the volume `labels`, which may be oriented differently from the scan, at the plan's voxels; 0 outside it.
// If one of the two has no orientation, both must have the same size and are assumed to coincide.
std::vector<std::uint8_t> sample_labels(const Scan& scan, const SamplePlan& plan, const Scan& labels,
                                        const Progress& progress);

}  // namespace tact
