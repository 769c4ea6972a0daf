// Particles as they are sent to be drawn: grains first, then what is wet: water, blood and paste.
//
// Unit     cells, as Particle::at; a colour's spread is the particle's own and stays with its place
// Thread   any; pure
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/drilling/particles.hpp"

namespace tact {

struct ParticleDot {
    std::array<float, 3> at;
    Matter matter;
    std::uint8_t shade;  // of 255: how light or dark this one is among its like
    std::uint8_t reserved[2];
};
static_assert(sizeof(ParticleDot) == 16);

struct DotRanges {
    std::size_t grains = 0, fluids = 0;                // in this order
    std::array<float, 3> fluids_low{}, fluids_high{};  // box about the fluids' centres; where there are some
};

// Fills `dots`, whose memory is kept from frame to frame.
DotRanges build_dots(std::span<const Particle> particles, std::vector<ParticleDot>& dots);

}  // namespace tact
