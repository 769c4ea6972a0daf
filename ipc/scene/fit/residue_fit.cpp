#include "ipc/scene/fit/residue_fit.hpp"

#include <cmath>
#include <cstdlib>

#include "ipc/scene/fit/fit_sums.hpp"

namespace tact {
namespace {

constexpr std::uint64_t kVoxelsMin = 8;

std::vector<ResidueFit> residues_of(const Structure& s) {
    std::vector<ResidueFit> list;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (list.empty() || list.back().chain != s.chain[i] || list.back().residue != s.residue[i])
            list.push_back({s.chain[i], s.residue[i], i, 0, 0.0, {}});
        ++list.back().atoms;
    }
    return list;
}

void append_atoms(const Structure& from, std::size_t first, std::size_t count, Structure& to) {
    for (std::size_t i = first; i < first + count; ++i) {
        to.x_m.push_back(from.x_m[i]);
        to.y_m.push_back(from.y_m[i]);
        to.z_m.push_back(from.z_m[i]);
        to.mass_fraction.push_back(from.mass_fraction[i]);
        to.element.push_back(from.element[i]);
    }
}

// The window's atoms as a structure of their own.
Structure window_of(const Structure& s, const std::vector<ResidueFit>& residues, std::size_t middle,
                    int half) {
    Structure out;
    out.mass_u = s.mass_u;  // of the whole, to which the fractions refer
    const auto belongs = [&](std::size_t r) {
        return residues[r].chain == residues[middle].chain &&
               std::llabs(std::int64_t{residues[r].residue} - residues[middle].residue) <= half;
    };
    std::size_t first = middle, last = middle;
    while (first > 0 && belongs(first - 1)) --first;
    while (last + 1 < residues.size() && belongs(last + 1)) ++last;
    for (std::size_t r = first; r <= last; ++r)
        append_atoms(s, residues[r].first_atom, residues[r].atoms, out);
    return out;
}

// The values of the whole grid in a box.
std::vector<float> cut(const DensityGrid& grid, std::span<const float> whole, const VoxelBox& box) {
    std::vector<float> part;
    part.reserve(box.count());
    for (std::uint32_t z = 0; z < box.size[2]; ++z)
        for (std::uint32_t y = 0; y < box.size[1]; ++y) {
            const std::size_t row =
                (std::size_t{box.first[2] + z} * grid.size[1] + box.first[1] + y) * grid.size[0] +
                box.first[0];
            part.insert(part.end(), whole.begin() + static_cast<std::ptrdiff_t>(row),
                        whole.begin() + static_cast<std::ptrdiff_t>(row + box.size[0]));
        }
    return part;
}

}  // namespace

std::vector<ResidueFit> residue_fit(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                                    const FitSettings& settings, int window) {
    if (placed.empty()) return {};
    const std::vector<float> all = simulated_map(grid, placed, settings.resolution_m);
    const Structure& s = *placed.front().structure;
    std::vector<ResidueFit> residues = residues_of(s);
    std::vector<float> own;
    for (std::size_t r = 0; r < residues.size(); ++r) {
        ResidueFit& fit = residues[r];
        for (std::size_t i = fit.first_atom; i < fit.first_atom + fit.atoms; ++i)
            fit.density_sigma += map_at(grid, atom_in_voxels(grid, placed.front(), i), settings.background);
        const double mean = fit.density_sigma / static_cast<double>(fit.atoms);
        fit.density_sigma = settings.sigma > 0.0 ? (mean - settings.background) / settings.sigma : 0.0;
        const Structure part = window_of(s, residues, r, window / 2);
        const PlacedStructure at{&part, placed.front().T_model_body};
        const VoxelBox box = reached_box(grid, {&at, 1}, settings.resolution_m);
        if (box.count() == 0) continue;
        own.assign(box.count(), 0.0F);
        add_simulated(grid, at, settings.resolution_m, 1.0F, box, own);
        const RegionCorrelation c = correlate(grid, box, own, cut(grid, all, box));
        if (c.voxels >= kVoxelsMin) fit.correlation = c.cc_mean;
    }
    return residues;
}

}  // namespace tact
