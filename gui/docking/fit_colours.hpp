// Colours for the fit of residues to the map (ipc/scene/fit/residue_fit.hpp): from red (poor) by pale yellow to blue (good), which
// people who confuse red and green tell apart too; grey where nothing is known.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gui/render/elements.hpp"
#include "ipc/scene/fit/residue_fit.hpp"

namespace tact {

// Correlations at the ends of the scale; beyond them the colour stays.
inline constexpr double kPoorFit = 0.4, kGoodFit = 1.0;
inline constexpr Rgb8 kUnknownFit{128, 132, 140};

[[nodiscard]] Rgb8 fit_colour(std::optional<double> correlation);
// One per atom of the structure.
[[nodiscard]] std::vector<Rgb8> fit_colours(std::size_t atoms, std::span<const ResidueFit> residues);

}  // namespace tact
