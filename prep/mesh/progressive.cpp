#include "prep/mesh/progressive.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

std::vector<Eigen::Vector3d> area_normals(const TriangleMesh& mesh) {
    std::vector<Eigen::Vector3d> normal(mesh.vertices(), Eigen::Vector3d::Zero());
    const auto at = [&](std::uint32_t v) {
        return Eigen::Vector3d(mesh.position_m[3 * v], mesh.position_m[3 * v + 1],
                               mesh.position_m[3 * v + 2]);
    };
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        const std::uint32_t* v = &mesh.triangle[3 * t];
        const Eigen::Vector3d area = (at(v[1]) - at(v[0])).cross(at(v[2]) - at(v[0]));
        for (int i = 0; i < 3; ++i) normal[v[i]] += area;
    }
    return normal;
}

std::array<std::int16_t, 4> packed(const Eigen::Vector3d& sum, const std::array<std::int16_t, 4>& otherwise) {
    const double length = sum.norm();
    if (!(length > 0.0)) return otherwise;
    const auto pack = [&](int i) {
        return static_cast<std::int16_t>(std::lround(32767.0 * sum[i] / length));
    };
    return {pack(0), pack(1), pack(2), 0};
}

// The lowest level that contains the triangle: one above the contraction that merges two of its corners.
std::uint32_t birth_level(std::array<std::uint32_t, 3> v, const ProgressiveMeshData& data) {
    for (;;) {
        const std::size_t last = static_cast<std::size_t>(std::max_element(v.begin(), v.end()) - v.begin());
        if (v[last] < data.base_vertices) return data.base_vertices;
        const std::uint32_t gone = v[last];
        v[last] = data.parent[gone - data.base_vertices];
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return gone + 1;
    }
}

}  // namespace

ProgressiveMeshData make_progressive(const TriangleMesh& raw, const SimplifySettings& settings,
                                     const Progress& progress) {
    const TriangleMesh mesh = cleaned(raw);
    if (mesh.triangles() == 0) {
        throw StartupError("bake a progressive mesh", "the surface has no triangle",
                           "choose a contour level between the lowest and the highest density");
    }
    const std::vector<Contraction> steps = simplify(mesh, settings, progress).contraction;
    const auto n = static_cast<std::uint32_t>(mesh.vertices());
    ProgressiveMeshData data;
    data.base_vertices = n - static_cast<std::uint32_t>(steps.size());

    // New numbers: the base mesh first, then in reverse order of contraction.
    std::vector<std::uint32_t> number(n, kNoIndex);
    for (std::size_t s = 0; s < steps.size(); ++s)
        number[steps[s].gone] = n - 1 - static_cast<std::uint32_t>(s);
    std::uint32_t next = 0;
    for (std::uint32_t& place : number) {
        if (place == kNoIndex) place = next++;
    }

    std::vector<Eigen::Vector3d> normal = area_normals(mesh);
    data.vertex.resize(n);
    for (std::uint32_t v = 0; v < n; ++v) {
        MeshVertex& vertex = data.vertex[number[v]];
        for (std::size_t i = 0; i < 3; ++i) vertex.position_m[i] = mesh.position_m[3 * std::size_t{v} + i];
        vertex.normal = packed(normal[v], {0, 0, 32767, 0});
    }
    data.parent.resize(steps.size());
    data.merged.resize(steps.size());
    data.error_m.assign(steps.size() + 1, 0.0F);
    std::vector<std::array<std::int16_t, 4>> shown(n);
    for (std::uint32_t v = 0; v < n; ++v) shown[v] = data.vertex[number[v]].normal;
    for (std::size_t s = 0; s < steps.size(); ++s) {
        const Contraction& step = steps[s];
        const std::size_t k = steps.size() - 1 - s;
        normal[step.kept] += normal[step.gone];
        shown[step.kept] = packed(normal[step.kept], shown[step.kept]);
        data.parent[k] = number[step.kept];
        data.merged[k] = {step.position_m, shown[step.kept]};
        data.error_m[k] = step.error_m;
    }

    // Counting sort of the triangles by the level in which they appear; stable.
    const std::size_t triangles = mesh.triangles();
    std::vector<std::uint32_t> level(triangles);
    data.triangle_count.assign(steps.size() + 1, 0);
    for (std::size_t t = 0; t < triangles; ++t) {
        level[t] = birth_level({number[mesh.triangle[3 * t]], number[mesh.triangle[3 * t + 1]],
                                number[mesh.triangle[3 * t + 2]]},
                               data) -
                   data.base_vertices;
        ++data.triangle_count[level[t]];
    }
    std::vector<std::uint32_t> place(steps.size() + 1, 0);
    for (std::size_t k = 1; k < data.triangle_count.size(); ++k) {
        place[k] = data.triangle_count[k - 1];
        data.triangle_count[k] += data.triangle_count[k - 1];
    }
    data.triangle.resize(3 * triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
        const std::size_t to = place[level[t]]++;
        for (std::size_t i = 0; i < 3; ++i) data.triangle[3 * to + i] = number[mesh.triangle[3 * t + i]];
    }
    return data;
}

void write_progressive_mesh(SceneWriter& out, std::uint32_t index, const TriangleMesh& mesh,
                            const SimplifySettings& settings, const Progress& progress) {
    write_mesh(out, index, make_progressive(mesh, settings, progress));
}

}  // namespace tact
