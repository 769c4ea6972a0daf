// The 256 cases of a surface that crosses a cell of eight samples, for ipc/scene/density/isosurface.cpp.
//
// Corner c is at x = c & 1, y = c >> 1 & 1, z = c >> 2. Edges of the cell: 0-3 along x, 4-7 along y, 8-11
// along z, numbered by the other two coordinates of their lower corner.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tact {

inline constexpr std::uint8_t kCellCentre = 12;  // marks an extra vertex inside the cell

// Lower corner and axis of the twelve edges.
inline constexpr std::array<std::array<std::uint8_t, 2>, 12> kCellEdge{
    {{0, 0}, {2, 0}, {4, 0}, {6, 0}, {0, 1}, {1, 1}, {4, 1}, {5, 1}, {0, 2}, {1, 2}, {2, 2}, {3, 2}}};

struct CellCase {
    std::vector<std::array<std::uint8_t, 3>> triangle;  // edge numbers, or kCellCentre + loop number
    std::vector<std::vector<std::uint8_t>> centre;  // edges whose mean is the extra vertex, per extra vertex
};

// Indexed by the set of corners inside (bit c for corner c). Built once, always identical.
const std::array<CellCase, 256>& cell_cases();

}  // namespace tact
