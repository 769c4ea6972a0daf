#include "ipc/scene/mesh/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr std::size_t kSurfaceAlign = 64;
constexpr std::uint32_t kTrianglesMost = SurfaceNode::kFirst;
constexpr double kLargestM = 1e6;

struct SurfaceHeader {
    std::uint32_t vertices, triangles, nodes;
    std::uint32_t closed;
    std::array<std::uint32_t, 12> reserved;  // zero
};
static_assert(sizeof(SurfaceHeader) == kSurfaceAlign);

constexpr std::size_t rounded_up(std::size_t bytes) {
    return (bytes + kSurfaceAlign - 1) / kSurfaceAlign * kSurfaceAlign;
}

template <class T>
void put_array(BytesOut& out, const std::vector<T>& values) {
    out.put_all(values);
    const std::size_t bytes = values.size() * sizeof(T);
    out.put_all(std::vector<std::byte>(rounded_up(bytes) - bytes));
}

// A view of the next array; the padding up to the next multiple must be zero.
template <class T>
std::span<const T> take_array(const BytesIn& in, std::span<const std::byte>& left, std::uint64_t count,
                              const char* what) {
    if (count > left.size() / sizeof(T)) in.fail(std::string(what) + ": fewer are present than declared");
    const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(T), all = rounded_up(bytes);
    if (all > left.size()) in.fail(std::string(what) + ": the section ends inside it");
    if (reinterpret_cast<std::uintptr_t>(left.data()) % alignof(T) != 0)
        in.fail(std::string(what) + ": its address is not aligned");
    for (std::size_t i = bytes; i < all; ++i) {
        if (left[i] != std::byte{0}) in.fail(std::string(what) + ": the bytes after it are not zero");
    }
    const std::span<const T> view(reinterpret_cast<const T*>(left.data()), static_cast<std::size_t>(count));
    left = left.subspan(all);
    return view;
}

struct TreeChecks {
    const BytesIn& in;
    std::span<const SurfaceNode> node;
    std::span<const float> position_m;
    std::span<const std::uint32_t> corner;
    std::uint32_t next_triangle = 0, seen = 0;

    [[noreturn]] void fail(std::uint32_t at, const char* why) const {
        in.fail("node " + std::to_string(at) + ": " + why);
    }
    void check_leaf(std::uint32_t at, std::size_t k) {
        const std::uint32_t code = node[at].child[k], first = SurfaceNode::leaf_first(code),
                            count = SurfaceNode::leaf_count(code);
        if ((code >> 30 & 1U) != 0) fail(at, "a leaf has more than four triangles");
        if (first != next_triangle || count > corner.size() / 3 - first)
            fail(at, "its leaves are not in the order of the triangles");
        next_triangle += count;
        for (std::size_t i = std::size_t{3} * first; i < std::size_t{3} * (first + count); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float x = position_m[std::size_t{3} * corner[i] + axis];
                if (x < node[at].low_m[axis][k] || x > node[at].high_m[axis][k])
                    fail(at, "a triangle extends beyond its box");
            }
        }
    }
    // Depth first, in the order of the file, so that no node has two parents.
    void walk(std::uint32_t at, std::uint32_t depth) {
        if (depth > SurfaceMesh::kDepthMax) fail(at, "it is too deep in the tree");
        ++seen;
        for (const std::uint32_t zero : node[at].reserved) {
            if (zero != 0) fail(at, "reserved bytes are not zero");
        }
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t code = node[at].child[k];
            const bool none = code == SurfaceNode::kNone;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float low = node[at].low_m[axis][k], high = node[at].high_m[axis][k];
                constexpr float kFar = std::numeric_limits<float>::infinity();
                if (none ? low != kFar || high != -kFar : !(low <= high)) fail(at, "a box is inside out");
            }
            if (none) continue;
            if ((code & SurfaceNode::kLeaf) != 0) {
                check_leaf(at, k);
                continue;
            }
            if (code != seen || code >= node.size()) fail(at, "a child is out of order");
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t c = 0; c < 4; ++c) {
                    if (node[code].child[c] == SurfaceNode::kNone) continue;
                    if (node[code].low_m[axis][c] < node[at].low_m[axis][k] ||
                        node[code].high_m[axis][c] > node[at].high_m[axis][k])
                        fail(code, "it extends beyond its parent's box");
                }
            }
            walk(code, depth + 1);
        }
    }
};

}  // namespace

// Octahedral mapping: the sphere is projected onto an octahedron, its lower half folded over (Meyer et al. 2010).
OctNormal oct_normal(const Vec3& unit) noexcept {
    const double sum = unit.cwiseAbs().sum();
    if (!(sum > 0.0)) return {0, 0};  // up
    double x = unit.x() / sum, y = unit.y() / sum;
    if (unit.z() < 0.0) {
        const double fx = (1.0 - std::abs(y)) * std::copysign(1.0, x);
        y = (1.0 - std::abs(x)) * std::copysign(1.0, y);
        x = fx;
    }
    return {static_cast<std::int16_t>(std::lround(x * 32767.0)),
            static_cast<std::int16_t>(std::lround(y * 32767.0))};
}

Vec3 unit_normal(OctNormal normal) noexcept {
    double x = normal[0] / 32767.0, y = normal[1] / 32767.0;
    const double z = 1.0 - std::abs(x) - std::abs(y);
    if (z < 0.0) {
        const double fx = (1.0 - std::abs(y)) * std::copysign(1.0, x);
        y = (1.0 - std::abs(x)) * std::copysign(1.0, y);
        x = fx;
    }
    return Vec3(x, y, z).normalized();  // |x| + |y| + |z| is 1 or slightly more: never zero
}

void write_surface(SceneWriter& out, const SurfaceData& data) {
    BytesOut bytes;
    const SurfaceHeader header{.vertices = static_cast<std::uint32_t>(data.position_m.size() / 3),
                               .triangles = static_cast<std::uint32_t>(data.triangle.size() / 3),
                               .nodes = static_cast<std::uint32_t>(data.node.size()),
                               .closed = data.closed ? 1U : 0U,
                               .reserved = {}};
    bytes.put(header);
    put_array(bytes, data.position_m);
    put_array(bytes, data.normal);
    put_array(bytes, data.triangle);
    put_array(bytes, data.node);
    out.add(SurfaceMesh::kTag, SurfaceMesh::kVersion, 0, bytes.take());
}

SurfaceMesh read_surface(const SceneFile& file) {
    const std::span<const std::byte> section = file.section(SurfaceMesh::kTag, SurfaceMesh::kVersion);
    BytesIn in(section, file.name() + ", section SURF");
    const auto header = in.get<SurfaceHeader>("header");
    if (header.vertices == 0 || header.triangles == 0 || header.nodes == 0) in.fail("it is empty");
    if (header.triangles >= kTrianglesMost) in.fail("it has more than 2^28 triangles");
    if (header.closed > 1) in.fail("its field closed is neither 0 nor 1");
    for (const std::uint32_t zero : header.reserved) {
        if (zero != 0) in.fail("reserved bytes of its header are not zero");
    }
    SurfaceMesh mesh;
    std::span<const std::byte> left = section.subspan(sizeof header);
    mesh.closed_ = header.closed != 0;
    mesh.bytes_ = section.size();
    mesh.position_m_ = take_array<float>(in, left, std::uint64_t{3} * header.vertices, "positions");
    mesh.normal_ = take_array<OctNormal>(in, left, header.vertices, "normals");
    mesh.corner_ = take_array<std::uint32_t>(in, left, std::uint64_t{3} * header.triangles, "corners");
    mesh.node_ = take_array<SurfaceNode>(in, left, header.nodes, "nodes");
    if (!left.empty()) in.fail(std::to_string(left.size()) + " bytes follow its content");

    mesh.low_m_ = Vec3::Constant(std::numeric_limits<double>::infinity());
    mesh.high_m_ = -mesh.low_m_;
    for (std::size_t i = 0; i < mesh.position_m_.size(); ++i) {
        const auto x = static_cast<double>(mesh.position_m_[i]);
        if (!(std::abs(x) <= kLargestM)) in.fail("position " + std::to_string(i) + " is out of range");
        const auto axis = static_cast<Eigen::Index>(i % 3);
        mesh.low_m_[axis] = std::min(mesh.low_m_[axis], x);
        mesh.high_m_[axis] = std::max(mesh.high_m_[axis], x);
    }
    mesh.largest_m_ = std::max(mesh.low_m_.cwiseAbs().maxCoeff(), mesh.high_m_.cwiseAbs().maxCoeff());
    for (std::size_t i = 0; i < mesh.corner_.size(); ++i) {
        if (mesh.corner_[i] >= header.vertices)
            in.fail("corner " + std::to_string(i) + " refers to vertex " + std::to_string(mesh.corner_[i]) +
                    " of " + std::to_string(header.vertices));
    }
    TreeChecks checks{in, mesh.node_, mesh.position_m_, mesh.corner_};
    checks.walk(0, 0);
    if (checks.next_triangle != header.triangles) in.fail("its leaves do not contain every triangle");
    if (checks.seen != header.nodes) in.fail("some nodes have no parent");
    return mesh;
}

}  // namespace tact
