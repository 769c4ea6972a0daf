// Builds the distance field of one structure of a bone volume.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/distance_field.hpp"

namespace tact {

struct BuiltDistances {
    DistanceField field;               // without its distances; `view()` adds them
    std::vector<std::int16_t> quanta;  // empty: no voxel has the label
    [[nodiscard]] DistanceField view() const {
        DistanceField f = field;
        f.quanta = quanta;
        return f;
    }
};

// Voxels between grid points: 4 if that is below half a millimetre or the volume is large, else 2.
std::uint32_t distance_step(const BoneBricks& bricks);

// Needs about 3 bytes per `step` voxels of memory in addition to the result.
BuiltDistances build_distances(const BoneBricks& bricks, std::span<const std::uint8_t> label, std::uint8_t of,
                               const Progress& progress = {});

}  // namespace tact
