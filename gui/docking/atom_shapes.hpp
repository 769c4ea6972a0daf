// Spheres and sticks of a structure as plain data, for the shaders of gui/docking/impostors.hpp.
//
// Frame    body, ångström.  Thread   any.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/docking/bonds.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

using Rgba8 = std::array<std::uint8_t, 4>;

// Both colourings travel with the shape: choosing one needs no new data.
struct AtomColours {
    Rgba8 element, chain;
};

struct Sphere {
    std::array<float, 3> centre_a;
    float radius_a;
    AtomColours colours;
};
static_assert(sizeof(Sphere) == 24);

// A cylinder with round ends. Its halves have the colours of the atoms at their ends.
struct Stick {
    std::array<float, 3> from_a;
    float radius_a;
    std::array<float, 3> to_a;
    AtomColours from, to;
};
static_assert(sizeof(Stick) == 44);

inline constexpr float kStickRadiusA = 0.25F, kTraceRadiusA = 0.35F;

// By element; carbon has the colour of its chain, so that chains are told apart all the same.
[[nodiscard]] AtomColours colours_of(const Structure& structure, std::size_t atom);
// All atoms, at their van der Waals radii.
[[nodiscard]] std::vector<Sphere> spheres_of(const Structure& structure);
// One for each bond. An atom without bonds (an ion) is a stick of no length, half its size.
[[nodiscard]] std::vector<Stick> sticks_of(const Structure& structure, std::span<const Bond> bonds);
// From trace atom to trace atom, straight.
[[nodiscard]] std::vector<Stick> trace_of(const Structure& structure);

}  // namespace tact
