// A sum over atoms of products of three one-dimensional Gaussians, each cut 4 sigma away (a box that
// contains all but 2e-4 of it), so an atom costs three short tables and one multiplication per voxel. A
// table needs three exponentials for any length: the ratio of consecutive values of a Gaussian changes by a
// constant factor. In double precision over some tens of voxels this is accurate to 1e-12.
#include "ipc/scene/density/simulated_map.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {

namespace {

void check(double resolution_m) {
    if (!(resolution_m > 0.0) || !std::isfinite(resolution_m)) {
        throw StartupError("simulating the map of a structure", "the resolution of the map is unknown",
                           "set it with --resolution-a");
    }
}

// Structure axes to voxels: place = offset + turn * point_body.
struct ToVoxels {
    Eigen::Matrix3d turn;
    Vec3 offset;
    ToVoxels(const DensityGrid& grid, const Pose& T_model_body) {
        const Vec3 per_m = grid.spacing_m.cwiseInverse();
        turn = per_m.asDiagonal() * T_model_body.q.toRotationMatrix();
        offset = (T_model_body.p_m - grid.origin_m).cwiseProduct(per_m);
    }
    Vec3 operator()(const Structure& s, std::size_t atom) const {
        return offset + turn * Vec3(static_cast<double>(s.x_m[atom]), static_cast<double>(s.y_m[atom]),
                                    static_cast<double>(s.z_m[atom]));
    }
};

// One axis of a Gaussian: its values at voxels first, first + 1, … of a box.
struct Table {
    std::size_t first = 0;
    std::vector<float> value;

    void fill(double place, double sigma, std::uint32_t low, std::uint32_t size) {
        value.clear();
        const double reach = kSimulatedCutSigmas * sigma;
        const double at = place - static_cast<double>(low);
        if (!(at >= -reach && at <= static_cast<double>(size) - 1.0 + reach)) return;  // also for NaN
        const double from = std::max(0.0, std::ceil(at - reach));
        const double to = std::min(static_cast<double>(size) - 1.0, std::floor(at + reach));
        if (to < from) return;
        first = static_cast<std::size_t>(from);
        const double d = (from - at) / sigma, step = 1.0 / sigma;
        double g = std::exp(-0.5 * d * d), ratio = std::exp(-step * (d + 0.5 * step));
        const double bend = std::exp(-step * step);
        value.resize(static_cast<std::size_t>(to - from) + 1);
        for (float& v : value) {
            v = static_cast<float>(g);
            g *= ratio;
            ratio *= bend;
        }
    }
};

}  // namespace

double scattering_weight(const Structure& structure, std::size_t atom) {
    if (atom < structure.element.size() && structure.element[atom] != 0) return structure.element[atom];
    return static_cast<double>(structure.mass_fraction[atom]) * structure.mass_u;
}

VoxelBox whole_box(const DensityGrid& grid) { return {{}, grid.size}; }

VoxelBox reached_box(const DensityGrid& grid, std::span<const PlacedStructure> placed, double resolution_m) {
    check(resolution_m);
    const Vec3 reach =
        kSimulatedCutSigmas * kSigmaPerResolution * resolution_m * grid.spacing_m.cwiseInverse();
    Vec3 low = Vec3::Constant(HUGE_VAL), high = Vec3::Constant(-HUGE_VAL);
    for (const PlacedStructure& p : placed) {
        const ToVoxels voxel(grid, p.T_model_body);
        for (std::size_t i = 0; i < p.structure->size(); ++i) {
            const Vec3 at = voxel(*p.structure, i);
            if (!at.allFinite()) continue;
            low = low.cwiseMin(at - reach);
            high = high.cwiseMax(at + reach);
        }
    }
    VoxelBox box;
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const double from = std::max(0.0, std::ceil(low[a]));
        const double to = std::min(static_cast<double>(grid.size[axis]) - 1.0, std::floor(high[a]));
        if (!(to >= from)) return VoxelBox{};
        box.first[axis] = static_cast<std::uint32_t>(from);
        box.size[axis] = static_cast<std::uint32_t>(to - from) + 1;
    }
    return box;
}

void add_simulated(const DensityGrid& grid, const PlacedStructure& placed, double resolution_m, float scale,
                   const VoxelBox& box, std::span<float> values) {
    check(resolution_m);
    if (values.size() != box.count())
        throw StartupError("simulating the map of a structure",
                           "the number of values differs from the number of voxels",
                           "this is an error in Tact; please report it");
    const Vec3 sigma = kSigmaPerResolution * resolution_m * grid.spacing_m.cwiseInverse();
    const ToVoxels voxel(grid, placed.T_model_body);
    const Structure& s = *placed.structure;
    Table x, y, z;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 at = voxel(s, i);
        z.fill(at.z(), sigma.z(), box.first[2], box.size[2]);
        if (z.value.empty()) continue;
        y.fill(at.y(), sigma.y(), box.first[1], box.size[1]);
        if (y.value.empty()) continue;
        x.fill(at.x(), sigma.x(), box.first[0], box.size[0]);
        const std::size_t wide = x.value.size();
        if (wide == 0) continue;
        const float weight = scale * static_cast<float>(scattering_weight(s, i));
        for (std::size_t c = 0; c < z.value.size(); ++c) {
            for (std::size_t b = 0; b < y.value.size(); ++b) {
                const float zy = weight * z.value[c] * y.value[b];
                float* const row =
                    &values[((z.first + c) * box.size[1] + y.first + b) * box.size[0] + x.first];
                for (std::size_t a = 0; a < wide; ++a) row[a] += zy * x.value[a];
            }
        }
    }
}

std::vector<float> simulated_map(const DensityGrid& grid, std::span<const PlacedStructure> placed,
                                 double resolution_m) {
    std::vector<float> map(grid.count(), 0.0F);
    for (const PlacedStructure& p : placed) add_simulated(grid, p, resolution_m, 1.0F, whole_box(grid), map);
    return map;
}

}  // namespace tact
