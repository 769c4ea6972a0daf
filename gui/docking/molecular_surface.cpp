#include "gui/docking/molecular_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "gui/docking/gaussian_atoms.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/isosurface.hpp"

namespace tact {
namespace {

constexpr std::size_t kVerticesPerReport = 4096;

void set_normal(SurfaceVertex& vertex, const Eigen::Vector3d& outward) {
    const double length = outward.norm();
    for (int k = 0; k < 3; ++k)
        vertex.normal[static_cast<std::size_t>(k)] =
            static_cast<std::int16_t>(std::lround(length > 0.0 ? 32767.0 * outward[k] / length : 0.0));
    vertex.normal[3] = 0;
}

// One step of Newton's method towards the level 1 in the logarithm of the sum.
Eigen::Vector3d newton_step(const AtomCells::Sum& at, double most_a) {
    if (!(at.value > 0.0)) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d slope = at.gradient / at.value;
    const double slope2 = slope.squaredNorm();
    if (!(slope2 > 1e-6)) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d step = -std::log(at.value) / slope2 * slope;
    const double length = step.norm();
    return length > most_a ? Eigen::Vector3d(most_a / length * step) : step;
}

}  // namespace

MolecularSurface build_surface(const Structure& structure, double spacing_a, const Progress& progress) {
    for (std::size_t i = 0; i < structure.size(); ++i)
        if (!std::isfinite(structure.x_m[i] + structure.y_m[i] + structure.z_m[i]))
            throw StartupError("computing the surface of " + structure.name,
                               "the position of atom " + std::to_string(i + 1) + " is not finite",
                               "bake the scene again");
    MolecularSurface surface;
    surface.spacing_a = allowed_spacing_a(structure, spacing_a, kSurfaceVoxelsMax);
    if (structure.size() == 0) return surface;
    report(progress, 0.0, "surface");
    const std::vector<GaussianAtom> atoms = gaussian_atoms(structure, surface.spacing_a);
    TriangleMesh mesh;
    {
        const DensityGrid grid = gaussian_grid(atoms, surface.spacing_a);
        report(progress, 0.2, "surface");
        mesh = isosurface(grid, 1.0, part(progress, 0.2, 0.5));
    }
    const AtomCells cells(atoms);
    surface.vertex.resize(mesh.vertices());
    surface.atom.resize(mesh.vertices());
    for (std::size_t v = 0; v < mesh.vertices(); ++v) {
        if (v % kVerticesPerReport == 0)
            report(progress, 0.5 + 0.5 * static_cast<double>(v) / static_cast<double>(mesh.vertices()),
                   "surface");
        Eigen::Vector3d at =
            Eigen::Map<const Eigen::Vector3f>(&mesh.position_m[3 * v]).cast<double>() / kAngstromM;
        at += newton_step(cells.sum(at), kNewtonMost * surface.spacing_a);
        const AtomCells::Sum there = cells.sum(at);
        SurfaceVertex& to = surface.vertex[v];
        for (int k = 0; k < 3; ++k) to.position_a[static_cast<std::size_t>(k)] = static_cast<float>(at[k]);
        set_normal(to, -there.gradient);
        surface.atom[v] = there.nearest;
    }
    surface.index = std::move(mesh.triangle);
    return surface;
}

double finest_spacing_a(const MolecularSurface& coarse, std::size_t vertices_max) {
    const double ratio = static_cast<double>(coarse.vertex.size()) /
                         static_cast<double>(std::max<std::size_t>(vertices_max, 1));
    return std::max(kFinestSpacingA, coarse.spacing_a * std::sqrt(ratio));
}

double spacing_of_step_a(double finest_a, std::size_t step) {
    return finest_a / std::sqrt(static_cast<double>(kSurfaceShares[step]));
}

std::vector<Rgba8> surface_colours(const MolecularSurface& surface, const Structure& structure,
                                   bool by_element, AtomPaint paint) {
    std::vector<Rgba8> of_atom(structure.size());
    for (std::size_t i = 0; i < of_atom.size(); ++i) {
        const AtomColours c = colours_of(structure, i, paint);
        of_atom[i] = by_element ? c.element : c.chain;
    }
    std::vector<Rgba8> colours(surface.atom.size());
    for (std::size_t v = 0; v < colours.size(); ++v) colours[v] = of_atom[surface.atom[v]];
    return colours;
}

std::vector<SurfaceVertex> bent_surface(const MolecularSurface& surface, const Structure& straight,
                                        const Structure& bent) {
    constexpr auto kPerM = static_cast<float>(1.0 / kAngstromM);
    std::vector<SurfaceVertex> out = surface.vertex;
    for (std::size_t v = 0; v < out.size(); ++v) {
        const std::uint32_t i = surface.atom[v];
        out[v].position_a[0] += kPerM * (bent.x_m[i] - straight.x_m[i]);
        out[v].position_a[1] += kPerM * (bent.y_m[i] - straight.y_m[i]);
        out[v].position_a[2] += kPerM * (bent.z_m[i] - straight.z_m[i]);
    }
    std::vector<Eigen::Vector3f> normal(out.size(), Eigen::Vector3f::Zero());
    const auto at = [&](std::uint32_t v) {
        return Eigen::Map<const Eigen::Vector3f>(out[v].position_a.data());
    };
    for (std::size_t t = 0; t + 2 < surface.index.size(); t += 3) {
        const std::uint32_t* const v = &surface.index[t];
        const Eigen::Vector3f area = (at(v[1]) - at(v[0])).cross(at(v[2]) - at(v[0]));
        for (int i = 0; i < 3; ++i) normal[v[i]] += area;
    }
    for (std::size_t v = 0; v < out.size(); ++v) set_normal(out[v], normal[v].cast<double>());
    return out;
}

}  // namespace tact
