// Where bone is wet, and where blood has stained it, from the particles that pass.
//
// Cells    of 4 voxels, as BoneField's. Water and blood wet a cell at once; it dries over kDriesS. Blood stains it; water
//          washes the stain away; by itself it fades over kFadesS
// Shown    in steps of 16 of 255, so that a cell that dries is drawn again a few times and not in each frame
// Cost     looks at all particles kLooksPerS times a second
// Thread   one; allocates when more cells than ever before are wet
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/drilling/particles.hpp"

namespace tact {

class WetBone {
public:
    static constexpr std::uint32_t kCell = 4;
    static constexpr double kLooksPerS = 5.0, kDriesS = 20.0, kFadesS = 120.0;
    // Water and stain of a cell, 0 to 255.
    using Texel = std::array<std::uint8_t, 2>;

    explicit WetBone(const BoneBricks& bricks);
    // Call once a frame. `cells` are those of the particles.
    void step(double dt_s, std::span<const Particle> particles, const ParticleCells& cells);

    [[nodiscard]] const std::array<std::uint32_t, 3>& size() const noexcept { return size_; }  // cells
    // All cells as shown, x fastest.
    [[nodiscard]] std::span<const Texel> texels() const noexcept { return shown_; }
    // Bricks whose cells the last step() shows differently, each once.
    [[nodiscard]] std::span<const std::uint32_t> changed() const noexcept { return changed_; }

private:
    struct Touch {
        std::uint16_t water = 0, blood = 0;  // particles
    };
    struct Wet {
        std::uint32_t cell;
        float water, stain;  // 0 to 1
    };
    void look(std::span<const Particle> particles, const ParticleCells& cells);
    void show(const Wet& wet);

    BoneBricks bricks_;
    std::array<std::uint32_t, 3> size_{};
    std::vector<Texel> shown_;
    std::vector<Wet> wet_;
    std::vector<std::uint32_t> place_;  // of a cell in wet_, plus one; 0: dry
    std::vector<Touch> touch_;          // of each of wet_, in this look
    std::vector<std::uint32_t> changed_;
    std::vector<std::uint8_t> brick_changed_;
    double since_look_s_ = 0.0;
};

}  // namespace tact
