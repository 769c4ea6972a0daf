#include "gui/docking/gaussian_atoms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gui/docking/molecular_surface.hpp"
#include "gui/render/elements.hpp"
#include "ipc/base/units.hpp"

namespace tact {
namespace {

// Cells of the search at most: for atoms that are few and far apart.
constexpr double kCellsMax = 4e6;

struct Bounds {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::max()),
                    high = Eigen::Vector3d::Constant(std::numeric_limits<double>::lowest());
    void add(const Eigen::Vector3d& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
};

Eigen::Vector3f centre_of(const Structure& s, std::size_t i) {
    constexpr auto kPerM = static_cast<float>(1.0 / kAngstromM);
    return kPerM * Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]);
}

// Widest atoms reach so far; so many voxels lie around them on each side.
double border_a(double reach_a, double spacing_a) { return reach_a + 1.5 * spacing_a; }

GaussianAtom gaussian(const Eigen::Vector3f& centre_a, double radius_a, double spacing_a) {
    const double own = radius_a / std::sqrt(2.0 * kSurfaceDecay);
    const double width = std::max(own, kWidestGrid * spacing_a);
    // At least e: then the sphere of a lone atom has a radius of sqrt(2) width, and always contains a point of the grid.
    const double weight = std::max(std::exp(kSurfaceDecay) * std::pow(own / width, 3), std::exp(1.0));
    const double reach = width * std::sqrt(2.0 * std::log(weight / kGaussianTail));
    return {centre_a, static_cast<float>(weight), static_cast<float>(0.5 / (width * width)),
            static_cast<float>(reach)};
}

}  // namespace

std::vector<GaussianAtom> gaussian_atoms(const Structure& structure, double spacing_a) {
    std::vector<GaussianAtom> atoms;
    atoms.reserve(structure.size());
    for (std::size_t i = 0; i < structure.size(); ++i)
        atoms.push_back(gaussian(centre_of(structure, i),
                                 static_cast<double>(vdw_radius_a(structure.element[i])), spacing_a));
    return atoms;
}

double allowed_spacing_a(const Structure& structure, double spacing_a, std::size_t voxels_max) {
    Bounds bounds;
    for (std::size_t i = 0; i < structure.size(); ++i) bounds.add(centre_of(structure, i).cast<double>());
    if (structure.size() == 0) return spacing_a;
    const auto voxels = [&](double spacing) {
        double reach = 0.0;
        for (const double radius : {1.2, 3.0})  // of all elements
            reach = std::max(reach,
                             static_cast<double>(gaussian(Eigen::Vector3f::Zero(), radius, spacing).reach_a));
        double n = 1.0;
        for (int k = 0; k < 3; ++k)
            n *= (bounds.high[k] - bounds.low[k] + 2.0 * border_a(reach, spacing)) / spacing + 2.0;
        return n;
    };
    while (voxels(spacing_a) > static_cast<double>(voxels_max)) spacing_a *= 1.05;
    return spacing_a;
}

DensityGrid gaussian_grid(const std::vector<GaussianAtom>& atoms, double spacing_a) {
    Bounds bounds;
    double reach = 0.0;
    for (const GaussianAtom& atom : atoms) {
        bounds.add(atom.centre_a.cast<double>());
        reach = std::max(reach, static_cast<double>(atom.reach_a));
    }
    DensityGrid grid;
    const Eigen::Vector3d low = bounds.low.array() - border_a(reach, spacing_a);
    for (int k = 0; k < 3; ++k) {
        const double length = bounds.high[k] + border_a(reach, spacing_a) - low[k];
        grid.size[static_cast<std::size_t>(k)] =
            static_cast<std::uint32_t>(std::ceil(length / spacing_a)) + 1;
    }
    grid.origin_m = kAngstromM * low;
    grid.spacing_m = Vec3::Constant(kAngstromM * spacing_a);
    grid.values.assign(grid.count(), 0.0F);
    // The exponential of a sum of squares is the product of three, so it is computed along the axes alone.
    std::array<std::vector<float>, 3> along;
    std::array<std::uint32_t, 3> first{};
    for (const GaussianAtom& atom : atoms) {
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double centre = (static_cast<double>(atom.centre_a[k]) - low[k]) / spacing_a;
            const double half = static_cast<double>(atom.reach_a) / spacing_a;
            first[axis] = static_cast<std::uint32_t>(std::ceil(centre - half));
            const auto last = static_cast<std::uint32_t>(std::floor(centre + half));
            along[axis].clear();
            for (std::uint32_t i = first[axis]; i <= last; ++i) {
                const double d = spacing_a * (static_cast<double>(i) - centre);
                along[axis].push_back(static_cast<float>(std::exp(-static_cast<double>(atom.decay) * d * d)));
            }
        }
        for (std::size_t z = 0; z < along[2].size(); ++z)
            for (std::size_t y = 0; y < along[1].size(); ++y) {
                const float plane = atom.weight * along[2][z] * along[1][y];
                // Corners of the box are beyond the reach.
                if (plane < static_cast<float>(kGaussianTail)) continue;
                float* const row =
                    &grid.values[((first[2] + z) * grid.size[1] + first[1] + y) * grid.size[0] + first[0]];
                for (std::size_t x = 0; x < along[0].size(); ++x) row[x] += plane * along[0][x];
            }
    }
    return grid;
}

AtomCells::AtomCells(const std::vector<GaussianAtom>& atoms) : atoms_(atoms) {
    Bounds bounds;
    for (const GaussianAtom& atom : atoms) {
        bounds.add(atom.centre_a.cast<double>());
        side_a_ = std::max(side_a_, static_cast<double>(atom.reach_a));
    }
    if (atoms.empty()) bounds.low = bounds.high = Eigen::Vector3d::Zero();
    low_a_ = bounds.low;
    const auto count = [&]() -> Eigen::Array3d {
        return ((bounds.high - bounds.low) / side_a_).array().floor() + 1.0;
    };
    while (count().prod() > kCellsMax) side_a_ *= 1.1;
    for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(count()[k]);
    const auto cell_of = [this](const GaussianAtom& atom) {
        std::size_t cell = 0;
        for (const int k : {2, 1, 0})
            cell = cell * static_cast<std::size_t>(size_[k]) +
                   static_cast<std::size_t>(cell_along(static_cast<double>(atom.centre_a[k]), k));
        return cell;
    };
    first_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
    for (const GaussianAtom& atom : atoms) ++first_[cell_of(atom) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    member_.resize(atoms.size());
    std::vector<std::uint32_t> next = first_;
    for (std::uint32_t i = 0; i < atoms.size(); ++i) member_[next[cell_of(atoms[i])]++] = i;
}

int AtomCells::cell_along(double at_a, int axis) const {
    return std::clamp(static_cast<int>(std::floor((at_a - low_a_[axis]) / side_a_)), 0, size_[axis] - 1);
}

AtomCells::Sum AtomCells::sum(const Eigen::Vector3d& point_a) const {
    Sum out;
    Eigen::Vector3i from, to;
    for (int k = 0; k < 3; ++k) {
        from[k] = cell_along(point_a[k] - side_a_, k);
        to[k] = cell_along(point_a[k] + side_a_, k);
    }
    const Eigen::Vector3f point = point_a.cast<float>();
    float nearest2 = std::numeric_limits<float>::max();
    for (int z = from.z(); z <= to.z(); ++z)
        for (int y = from.y(); y <= to.y(); ++y) {
            const auto row = (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) +
                              static_cast<std::size_t>(y)) *
                             static_cast<std::size_t>(size_.x());
            // Cells of a row follow each other.
            const std::uint32_t begin = first_[row + static_cast<std::size_t>(from.x())],
                                end = first_[row + static_cast<std::size_t>(to.x()) + 1];
            for (std::uint32_t m = begin; m < end; ++m) {
                const GaussianAtom& atom = atoms_[member_[m]];
                const Eigen::Vector3f off = point - atom.centre_a;
                const float d2 = off.squaredNorm();
                if (d2 < nearest2) {
                    nearest2 = d2;
                    out.nearest = member_[m];
                }
                if (d2 > atom.reach_a * atom.reach_a) continue;
                const double value = static_cast<double>(atom.weight * std::exp(-atom.decay * d2));
                out.value += value;
                out.gradient -= 2.0 * static_cast<double>(atom.decay) * value * off.cast<double>();
            }
        }
    return out;
}

}  // namespace tact
