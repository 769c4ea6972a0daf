// The distance field of one structure of a bone volume.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/base/progress.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/distance_field.hpp"

namespace tact {

struct BuiltDistances {
    DistanceField field;               // without its distances; `view()` has them
    std::vector<std::int16_t> quanta;  // empty: no voxel has the label
    [[nodiscard]] DistanceField view() const {
        DistanceField f = field;
        f.quanta = quanta;
        return f;
    }
};

// Voxels from one grid point to the next: 4 where that is below half a millimetre or the volume large, else 2.
std::uint32_t distance_step(const BoneBricks& bricks);

// Memory beside the result: some 3 bytes for step voxels.
BuiltDistances build_distances(const BoneBricks& bricks, std::span<const std::uint8_t> label, std::uint8_t of,
                               const Progress& progress = {});

}  // namespace tact
