// A structure as a cartoon: helices as flat ribbons, strands as arrows, the rest and nucleic acids as tubes.
//
// Curve    as that of a tube (tube.hpp); strands follow the means of three atoms, which flattens their zigzag
// Folds    secondary_structure.hpp, once per structure
// Size     below vertices_max if possible; where that is impossible, tubes are built
// Thread   any
#pragma once

#include <span>

#include "gui/render/secondary_structure.hpp"
#include "gui/render/tube.hpp"

namespace tact {

// Of the atoms of strands_of(); nucleic acids are coils.
[[nodiscard]] std::vector<std::vector<Fold>> folds_of(const Structure& structure);

// folds: of the structure, or of the one that was bent into it. paint: the colour of each atom; empty: by chain.
[[nodiscard]] TubeMesh build_ribbons(const Structure& structure, const std::vector<std::vector<Fold>>& folds,
                                     std::size_t vertices_max, std::span<const Rgb8> paint = {});

}  // namespace tact
