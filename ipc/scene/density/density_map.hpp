// An EM density map for sampling at any point: twice continuously differentiable density, and its gradient.
//
// The map's values, normalized as (value - background) / sigma, are slightly sharpened and then interpolated by a tricubic
// B-spline (coefficients by the usual recursive prefilter; outside the box the normalized density is zero).
// So the density is C2, its gradient C1: no force jump at a voxel face, and the force field is conservative. With the
// sharpening the slope of any wave of three voxels or more is right on average over the places of a body's atoms; without
// it the force is too small by up to 6 % (density_map.cpp).
//
// Frame    model, metres. Grid axes are parallel to the model axes; voxels may differ in x, y, z.
// Outside  the spline continues beyond the box and fades to zero within eight voxels, as if the map
//          continued with its background; farther away density and gradient are exactly zero
// Unit     sigma (standard deviation of the map); gradients are sigma per model metre
// Thread   immutable after construction; sample() on any thread, no allocation
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/density/huge_buffer.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {

// The map from its file: x fastest, values in the file's unit.
struct DensityGrid {
    std::array<std::uint32_t, 3> size{};
    Vec3 origin_m = Vec3::Zero();  // model position of voxel (0,0,0)
    Vec3 spacing_m = Vec3::Ones();
    std::vector<float> values;

    [[nodiscard]] std::size_t count() const { return std::size_t{size[0]} * size[1] * size[2]; }
    [[nodiscard]] float at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return values[(std::size_t{z} * size[1] + y) * size[0] + x];
    }
};

// Sections GRID: size, origin, spacing, then the values. Section 0 is the map from its file, used for
// drawing and measurement; the optional section 1 is a smoothed copy, used for the force.
inline constexpr std::uint32_t kMapGrid = 0, kForceMapGrid = 1;
void write_grid(SceneWriter& out, const DensityGrid& grid, std::uint32_t index = kMapGrid);
DensityGrid read_grid(const SceneFile& file, std::uint32_t index = kMapGrid);
DensityGrid read_force_map_grid(const SceneFile& file);  // section 1 if present, otherwise 0

// Points in structure-of-arrays form, body frame, metres. Weights sum to 1.
struct PointsView {
    std::span<const float> x, y, z, weight;
    [[nodiscard]] std::size_t size() const { return x.size(); }
};

// Sums over points: components of force, torque and the reduced correlation.
struct DensitySums {
    double density_sigma = 0.0;    // sum w rho
    Vec3 gradient = Vec3::Zero();  // sum w grad rho, sigma per model metre, model axes
    Vec3 moment = Vec3::Zero();    // sum w (r - c) x grad rho, sigma, model axes, about the body origin c
};

// Derivatives of those sums by position and rotation of the body, model axes.
struct DensityBends {
    Eigen::Matrix3d by_shift = Eigen::Matrix3d::Zero();  // of gradient, sigma per model metre squared
    Eigen::Matrix3d by_turn =
        Eigen::Matrix3d::Zero();  // symmetric part of that of moment, sigma per radian squared
};

// Receives w grad rho of each point of a sum, sigma per model metre, model axes; at least as long as the points.
struct PointGradients {
    std::span<float> x, y, z;
};

struct DensityKernel;  // ipc/scene/density/density_kernels.hpp

class DensityMap {
public:
    struct Options {
        const DensityKernel* kernel = nullptr;  // for tests; null: the fastest for this processor
        // Sums of few points are faster with the coefficients stored fourfold, because each point then
        // needs half as many cache lines. Not used if it needs more memory than this.
        std::size_t windows_bytes_max = std::size_t{64} << 20;
        // The spline passes through the map's values, without the sharpening: for fields that are no sampled density.
        bool interpolating = false;
    };

    // sigma > 0. May allocate and take a second for large maps.
    DensityMap(const DensityGrid& grid, double background, double sigma)
        : DensityMap(grid, background, sigma, Options{nullptr, std::size_t{64} << 20, false}) {}
    DensityMap(const DensityGrid& grid, double background, double sigma, const Options& options);

    // Density in sigma and its gradient in sigma per metre at a model point.
    [[nodiscard]] double sample(const Vec3& point_model_m, Vec3& gradient) const noexcept TACT_RT;

    // The same summed over the points of a rigid body at T_model_body; the servo's inner loop. Uses the
    // widest instruction set of the processor; results agree with sample() to single precision. Zero for a
    // pose that is not finite or has no rotation.
    [[nodiscard]] DensitySums sum(const PointsView& points, const Pose& T_model_body,
                                  const PointGradients* each = nullptr) const noexcept TACT_RT;

    // Derivatives of the sums; for a few points at a time (density_bend.cpp). Zero as in sum().
    [[nodiscard]] DensityBends bends(const PointsView& points,
                                     const Pose& T_model_body) const noexcept TACT_RT;

    [[nodiscard]] const Vec3& origin_m() const { return origin_m_; }
    [[nodiscard]] const Vec3& spacing_m() const { return spacing_m_; }
    [[nodiscard]] const std::array<std::uint32_t, 3>& size() const { return size_; }
    [[nodiscard]] const char* kernel_name() const noexcept;  // "avx512", "avx2", "generic"
    [[nodiscard]] std::size_t bytes() const { return (columns_.size() + windows_.size()) * sizeof(float); }

private:
    Vec3 origin_m_, spacing_m_;
    std::array<std::uint32_t, 3> size_{};
    std::array<std::int32_t, 3> padded_{};  // size_ plus the border on both sides
    const DensityKernel* kernel_ = nullptr;
    HugeBuffer columns_, windows_;  // layouts: density_kernels.hpp; no windows if too large
};

}  // namespace tact
