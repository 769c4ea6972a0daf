// Spheres and sticks of a structure as plain data, for the shaders of gui/docking/impostors.hpp.
//
// Frame    body, ångström.  Thread   any.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/render/elements.hpp"
#include "ipc/scene/density/bonds.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

using Rgba8 = std::array<std::uint8_t, 4>;

// Both colourings are stored with the shape, so switching needs no new data.
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

// Colours of the atoms in place of those of element and chain; empty: none.
using AtomPaint = std::span<const Rgb8>;

// By element, but carbon by chain, so that chains remain distinguishable.
[[nodiscard]] AtomColours colours_of(const Structure& structure, std::size_t atom, AtomPaint paint = {});
// All atoms, at their van der Waals radii.
[[nodiscard]] std::vector<Sphere> spheres_of(const Structure& structure, AtomPaint paint = {});
// One per bond. An atom without bonds (an ion) is a stick of zero length with half its van der Waals radius.
[[nodiscard]] std::vector<Stick> sticks_of(const Structure& structure, std::span<const Bond> bonds,
                                           AtomPaint paint = {});
// Straight sticks from trace atom to trace atom, or between means of as many successive ones.
[[nodiscard]] std::vector<Stick> trace_of(const Structure& structure, std::size_t atoms_per_point = 1,
                                          AtomPaint paint = {});

// For levels of detail, the order in which shapes are drawn: the first n of them represent all.
// Spheres in random order, the same in every run.
void order_by_level(std::vector<Sphere>& spheres);
// Sticks by their distance from the trace in bonds, so that side chains become shorter. Returns the number of sticks that must always be
// drawn: the backbone, and atoms without bonds.
[[nodiscard]] std::size_t order_by_level(std::vector<Stick>& sticks, const Structure& structure,
                                         std::span<const Bond> bonds);

}  // namespace tact
