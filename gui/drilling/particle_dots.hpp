// Particles prepared for drawing: grains first, then wet ones (water, blood and paste).
//
// Unit     cells, as Particle::at; the variation of colour depends on the cell and stays with it
// Thread   any; pure
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/drilling/particles.hpp"

namespace tact {

inline constexpr float kDotSize = 32.0F;

struct ParticleDot {
    std::array<float, 3> at;
    Matter matter;
    std::uint8_t shade;  // 0 to 255: variation of brightness among its kind
    std::uint8_t size;   // of kDotSize: edge of its bone over that of a grain
    std::uint8_t reserved;
};
static_assert(sizeof(ParticleDot) == 16);

struct DotRanges {
    std::size_t grains = 0, fluids = 0;                // in this order
    std::array<float, 3> fluids_low{}, fluids_high{};  // bounding box of the fluids' centres, if any
};

// Fills `dots`; its memory is reused from frame to frame.
DotRanges build_dots(std::span<const Particle> particles, std::vector<ParticleDot>& dots);

}  // namespace tact
