#include "gui/render/contour_extract.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ipc/scene/density/isosurface.hpp"

namespace tact {

DensityGrid thinned(const DensityGrid& grid, std::uint32_t stride) {
    DensityGrid thin;
    thin.origin_m = grid.origin_m;
    thin.spacing_m = grid.spacing_m * static_cast<double>(stride);
    for (std::size_t a = 0; a < 3; ++a) thin.size[a] = grid.size[a] > 0 ? (grid.size[a] - 1) / stride + 1 : 0;
    thin.values.reserve(thin.count());
    for (std::uint32_t z = 0; z < thin.size[2]; ++z)
        for (std::uint32_t y = 0; y < thin.size[1]; ++y)
            for (std::uint32_t x = 0; x < thin.size[0]; ++x)
                thin.values.push_back(grid.at(x * stride, y * stride, z * stride));
    return thin;
}

PlainMesh extract_contour(const DensityGrid& grid, double level, const Progress& progress) {
    const TriangleMesh surface = isosurface(grid, level, progress);
    PlainMesh mesh;
    mesh.index = surface.triangle;
    mesh.vertex.resize(surface.vertices());
    std::vector<Eigen::Vector3f> normal(surface.vertices(), Eigen::Vector3f::Zero());
    const auto at = [&](std::uint32_t v) {
        return Eigen::Map<const Eigen::Vector3f>(&surface.position_m[std::size_t{3} * v]);
    };
    // In voxels: squared metres of a map underflow in single precision.
    const auto scale = static_cast<float>(1.0 / grid.spacing_m.maxCoeff());
    for (std::size_t t = 0; t < surface.triangles(); ++t) {
        const std::uint32_t* v = &surface.triangle[3 * t];
        const Eigen::Vector3f area = (scale * (at(v[1]) - at(v[0]))).cross(scale * (at(v[2]) - at(v[0])));
        for (int i = 0; i < 3; ++i) normal[v[i]] += area;
    }
    for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
        const float length = normal[v].norm();
        MeshVertex& to = mesh.vertex[v];
        for (std::size_t i = 0; i < 3; ++i) {
            to.position_m[i] = surface.position_m[3 * v + i];
            const float part = length > 0.0F ? normal[v][static_cast<Eigen::Index>(i)] / length : 0.0F;
            to.normal[i] = static_cast<std::int16_t>(std::lround(32767.0F * part));
        }
        to.normal[3] = 0;
    }
    return mesh;
}

namespace {

std::size_t cells(const DensityGrid& grid, std::uint32_t stride) {
    std::size_t n = 1;
    for (const std::uint32_t size : grid.size) n *= size / stride + 1;
    return n;
}

}  // namespace

std::uint32_t first_stride(const DensityGrid& grid, const StrideLimits& limits) {
    std::uint32_t stride = 1;
    while (stride < kStrideMax && cells(grid, stride) > limits.cells_max) ++stride;
    return stride;
}

std::uint32_t next_stride(const DensityGrid& grid, std::uint32_t now, double extract_s, std::size_t vertices,
                          const StrideLimits& limits) {
    if (now < kStrideMax && (extract_s > limits.extract_s_max || vertices > limits.vertices_max))
        return now + 1;
    if (now <= first_stride(grid, limits)) return now;
    // From stride to stride, cells grow with the cube and vertices with the square of the ratio.
    const double ratio = static_cast<double>(now) / static_cast<double>(now - 1);
    const bool fits = extract_s * ratio * ratio * ratio < 0.6 * limits.extract_s_max &&
                      static_cast<double>(vertices) * ratio * ratio < 0.8 * limits.vertices_max;
    return fits ? now - 1 : now;
}

}  // namespace tact
