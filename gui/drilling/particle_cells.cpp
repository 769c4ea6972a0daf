#include "gui/drilling/particle_cells.hpp"

#include "ipc/base/error.hpp"

namespace tact {

ParticleCells::ParticleCells(const BoneBricks& bricks, std::span<const std::uint8_t> density,
                             std::uint32_t margin)
    : bricks_(bricks), density_(density), margin_(static_cast<int>(margin)) {
    constexpr std::uint32_t kMost = 4096;
    std::size_t cells = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        if (bricks.size[i] == 0 || bricks.size[i] > kMost || margin > kMost)
            throw StartupError("the volume of the particles would have " + std::to_string(bricks.size[i]) +
                                   " voxels along an axis",
                               "the range is 1 to 4096", "crop or resample the volume");
        size_[i] = static_cast<int>(bricks.size[i] + 2 * margin);
        cells *= static_cast<std::size_t>(size_[i]);
    }
    if (!density.empty() && density.size() != bricks.bytes())
        throw StartupError(
            "the bone's densities do not fit its size",
            std::to_string(density.size()) + " bytes instead of " + std::to_string(bricks.bytes()),
            "bake the scene again");
    state_.resize((cells + 3) / 4);
}

}  // namespace tact
