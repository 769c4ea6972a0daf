// The backbone of a structure as smooth tubes, coloured by chain. Built once, on the processor.
//
// Curve    Catmull-Rom through the trace atoms; broken where the chain changes or two neighbours are further
//          apart than a bond can be. Frame body, unit ångström.
// Size     sides and steps are chosen so that the whole stays below vertices_max where that can be.
#pragma once

#include <cstddef>
#include <cstdint>
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

// The trace atoms in order, parted as the curve is; strands of one atom are left out.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> strands_of(const Structure& structure);

[[nodiscard]] TubeMesh build_tubes(const Structure& structure, std::size_t vertices_max);

}  // namespace tact
