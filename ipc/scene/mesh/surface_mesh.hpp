// A triangle surface for touch at full resolution, with the search tree of its triangles.
//
// Layout    section SURF: header, positions (3 float per vertex), normals (2 int16, octahedral), corners (3
//           u32 per triangle), nodes; each array at a multiple of 64 bytes. About 31 bytes per triangle for
//           a mesh with half as many vertices as triangles. Little endian
// Tree      four children per node; a child is another node, later in the file, or up to four consecutive
//           triangles. Triangles are in the order of the leaves, vertices in the order of their use
// Frame     model, metres
// Views     a SurfaceMesh points into the bytes of the scene, which must outlive it
// Thread    created anywhere but on the servo thread; the queries are TACT_RT: no allocation, and work
//           bounded by their arguments
// Errors    StartupError: read_surface() checks every count, index, range and box, so that a query on an
//           untrusted file is correct or refused. A query whose limit is reached reports it
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/mesh/triangle_query.hpp"

namespace tact {

struct SurfaceNode {
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;  // no child: its box is from +inf to -inf
    static constexpr std::uint32_t kLeaf =
        1U << 31;  // a leaf: bits 28, 29 are its number of triangles minus one
    static constexpr std::uint32_t kFirst = (1U << 28) - 1;  // number of its first triangle
    std::array<std::array<float, 4>, 3> low_m, high_m;       // [axis][child]
    std::array<std::uint32_t, 4> child;
    std::array<std::uint32_t, 4> reserved;  // zero

    static constexpr std::uint32_t leaf(std::uint32_t first, std::uint32_t count) {
        return kLeaf | (count - 1) << 28 | first;
    }
    static constexpr std::uint32_t leaf_first(std::uint32_t code) { return code & kFirst; }
    static constexpr std::uint32_t leaf_count(std::uint32_t code) { return (code >> 28 & 3U) + 1; }
};
static_assert(sizeof(SurfaceNode) == 128);

using OctNormal = std::array<std::int16_t, 2>;
[[nodiscard]] OctNormal oct_normal(const Vec3& unit) noexcept;
[[nodiscard]] Vec3 unit_normal(OctNormal normal) noexcept TACT_RT;

// Output of prep/surface, and content of the section.
struct SurfaceData {
    bool closed = false;                  // oriented and without a border: it has an inside
    std::vector<float> position_m;        // 3 per vertex
    std::vector<OctNormal> normal;        // 1 per vertex, outward
    std::vector<std::uint32_t> triangle;  // 3 corners, counter-clockwise as viewed from outside
    std::vector<SurfaceNode> node;        // the first is the root
};

struct SurfacePoint {
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
    std::uint32_t triangle = kNone;  // kNone: nothing within the given distance
    double distance_m = 0.0;
    Vec3 point_m = Vec3::Zero();
    Vec3 part = Vec3::Zero();  // barycentric
    bool exhausted = false;    // the visits were used up: a nearer point may exist
};

class SurfaceMesh {
public:
    static constexpr SectionTag kTag{'S', 'U', 'R', 'F'};
    static constexpr std::uint32_t kVersion = 1;
    static constexpr std::uint32_t kDepthMax = 40;
    static constexpr std::uint32_t kVisitsMax = 1U << 16;

    SurfaceMesh() = default;

    [[nodiscard]] std::size_t vertices() const noexcept { return position_m_.size() / 3; }
    [[nodiscard]] std::size_t triangles() const noexcept { return corner_.size() / 3; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] bool closed() const noexcept { return closed_; }
    [[nodiscard]] const Vec3& low_m() const noexcept { return low_m_; }
    [[nodiscard]] const Vec3& high_m() const noexcept { return high_m_; }
    [[nodiscard]] std::array<std::uint32_t, 3> corners(std::uint32_t triangle) const noexcept TACT_RT {
        const std::uint32_t* const c = corner_.data() + std::size_t{3} * triangle;
        return {c[0], c[1], c[2]};
    }
    // For this mesh and a point; the caller sets the triangles and the limit.
    [[nodiscard]] QueryJob query_job(const Vec3& point_m) const noexcept TACT_RT;
    [[nodiscard]] Vec3 position_m(std::uint32_t vertex) const noexcept TACT_RT {
        const float* const p = position_m_.data() + std::size_t{3} * vertex;
        return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }
    [[nodiscard]] Vec3 normal(std::uint32_t vertex) const noexcept TACT_RT {
        return unit_normal(normal_[vertex]);
    }

    // The same triangles with another tree over some of them.
    [[nodiscard]] SurfaceMesh with_tree(std::span<const SurfaceNode> node) const noexcept TACT_RT {
        SurfaceMesh mesh = *this;
        mesh.node_ = node;
        return mesh;
    }
    [[nodiscard]] std::span<const SurfaceNode> tree() const noexcept { return node_; }
    // 3 per vertex and 3 per triangle: for the forest over the same surface.
    [[nodiscard]] std::span<const float> all_positions_m() const noexcept { return position_m_; }
    [[nodiscard]] std::span<const std::uint32_t> all_corners() const noexcept { return corner_; }

    // Leaves whose boxes intersect the sphere, as codes of SurfaceNode, in the order of their triangles.
    // False: `out` is full and some are missing. count: number of leaves in `out`.
    bool leaves_near(const Vec3& centre_m, double radius_m, std::span<std::uint32_t> out,
                     std::size_t& count) const noexcept TACT_RT;
    // The nearest point of one triangle, in double precision.
    [[nodiscard]] SurfacePoint point_of(std::uint32_t triangle, const Vec3& point_m) const noexcept TACT_RT;
    // The nearest point of the surface within radius_m. hint: a triangle that is probably near, or kNone.
    [[nodiscard]] SurfacePoint nearest(const Vec3& point_m, double radius_m,
                                       std::uint32_t hint = SurfacePoint::kNone,
                                       std::uint32_t visits_max = kVisitsMax) const noexcept TACT_RT;
    // Lower bound of the distance to the surface, at most at_most_m: the distance of the leaves' boxes,
    // without triangle tests. 0 if the visits were used up.
    [[nodiscard]] double clearance_m(const Vec3& point_m, double at_most_m,
                                     std::uint32_t visits_max = kVisitsMax) const noexcept TACT_RT;
    // Interpolated from the corners; never zero.
    [[nodiscard]] Vec3 normal_at(const SurfacePoint& at) const noexcept TACT_RT;
    // Counter-clockwise orientation; zero for a triangle without area.
    [[nodiscard]] Vec3 facet_normal(std::uint32_t triangle) const noexcept TACT_RT;

private:
    friend SurfaceMesh read_surface(const SceneFile& file);
    bool closed_ = false;
    std::size_t bytes_ = 0;
    std::span<const float> position_m_;
    std::span<const OctNormal> normal_;
    std::span<const std::uint32_t> corner_;
    std::span<const SurfaceNode> node_;
    Vec3 low_m_ = Vec3::Zero(), high_m_ = Vec3::Zero();
    double largest_m_ = 0.0;  // largest coordinate
};

void write_surface(SceneWriter& out, const SurfaceData& data);
SurfaceMesh read_surface(const SceneFile& file);

}  // namespace tact
