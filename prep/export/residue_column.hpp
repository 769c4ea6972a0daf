// The fit of each residue (ipc/scene/fit/residue_fit.hpp) as a table, and in the B column of a structure file, where viewers colour by it.
//
// B column   the correlation; 0 for atoms that have none: of residues off the map, and waters
// Errors     StartupError: an mmCIF file without a B column
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/scene/fit/residue_fit.hpp"

namespace tact {

// Columns chain, residue, atoms, density_sigma, correlation (empty: none); with local resolutions also local_resolution_a.
std::string residue_csv(const Structure& structure, const std::vector<ResidueFit>& fit,
                        const std::vector<std::optional<double>>& local_resolution_a = {});

// Means of a map of local resolutions (angstrom) at the atoms of each residue; none where no atom is inside its box.
std::vector<std::optional<double>> local_resolutions(const DensityGrid& map, const PlacedStructure& placed,
                                                     const std::vector<ResidueFit>& fit);

std::string with_b_column(std::string_view text, bool mmcif, const std::string& name,
                          const Structure& structure, const std::vector<ResidueFit>& fit);

}  // namespace tact
