// The atoms of a structure as Gaussians whose sum defines its surface (gui/docking/molecular_surface.hpp), and their sum at a point.
//
// Cut off  where a Gaussian falls below kGaussianTail of the level.  Frame body, ångström.  Thread any.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"

namespace tact {

inline constexpr double kGaussianTail = 0.002;

struct GaussianAtom {
    Eigen::Vector3f centre_a;
    float weight, decay;  // weight * exp(-decay * distance_a^2)
    float reach_a;
};

[[nodiscard]] std::vector<GaussianAtom> gaussian_atoms(const Structure& structure, double spacing_a);

// Their sum on a grid that contains all of it, with a border of zeros. Spacing raised until it has at most voxels_max. Frame of the grid:
// body, metres.
[[nodiscard]] DensityGrid gaussian_grid(const std::vector<GaussianAtom>& atoms, double spacing_a);
[[nodiscard]] double allowed_spacing_a(const Structure& structure, double spacing_a, std::size_t voxels_max);

// Finds the atoms near a point in cells as wide as the greatest reach.
class AtomCells {
public:
    explicit AtomCells(const std::vector<GaussianAtom>& atoms);  // must outlive this

    struct Sum {
        double value = 0.0;
        Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // per ångström
        std::uint32_t nearest = 0;  // atom with the nearest centre, if any reaches the point
    };
    [[nodiscard]] Sum sum(const Eigen::Vector3d& point_a) const;

private:
    [[nodiscard]] int cell_along(double at_a, int axis) const;

    const std::vector<GaussianAtom>& atoms_;
    Eigen::Vector3d low_a_ = Eigen::Vector3d::Zero();
    Eigen::Vector3i size_ = Eigen::Vector3i::Ones();
    double side_a_ = 1.0;
    std::vector<std::uint32_t> first_, member_;  // of each cell, its atoms
};

}  // namespace tact
