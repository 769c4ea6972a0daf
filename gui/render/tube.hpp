// The backbone of a structure as smooth tubes, coloured by chain or as given. Built once, on the CPU.
//
// Curve    Catmull-Rom spline through the trace atoms; interrupted where the chain changes or two successive atoms
//          are farther apart than a bond. Frame body, unit ångström.
// Size     sides and steps are chosen to keep the total below vertices_max if possible. The coarsest tubes follow the mean of two to
//          four successive atoms.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/render/elements.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

struct TubeVertex {
    float position_a[3];
    float normal[3];
    std::uint8_t rgba[4];
};
static_assert(sizeof(TubeVertex) == 28);

struct TubeMesh {
    std::vector<TubeVertex> vertex;
    std::vector<std::uint32_t> index;
    std::size_t strands = 0;
};

inline constexpr double kTraceGapM = 8e-10;  // above the C-alpha (3.8 A) and phosphate (about 7 A) distances

// The trace atoms in order, one strand per curve; strands of one atom are omitted.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> strands_of(const Structure& structure);

// Points along a strand, ångström: its atoms, or the means of as many successive ones, between its first and last atom.
[[nodiscard]] std::vector<Eigen::Vector3f> thinned_strand_a(const Structure& structure,
                                                            const std::vector<std::uint32_t>& atoms,
                                                            std::size_t atoms_per_point);

// paint: the colour of each atom; empty: by chain.
[[nodiscard]] TubeMesh build_tubes(const Structure& structure, std::size_t vertices_max,
                                   std::span<const Rgb8> paint = {});

}  // namespace tact
