// Derivation of the step tables. A corner of a triangle starts at its original vertex and is lifted to the
// parent each time its vertex is contracted. Lifting the largest corner first visits the contractions in
// their order, so one loop per triangle finds every change and proves that no level has a triangle with two
// equal corners. The work is the number of changes, about four per contraction; a crafted file with long
// chains could make it quadratic, so the number is limited.
#include "ipc/scene/mesh/progressive_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kMeshTag{'M', 'E', 'S', 'H'};
constexpr std::uint32_t kMeshVersion = 1;
constexpr std::uint32_t kCountMax = 1U << 29;  // of vertices or triangles; 3 T fits 32 bits
constexpr std::uint64_t kChangesPerItem = 24;  // measured 2.5 to 4 per contraction
constexpr double kPositionMax = 1e6;           // metres

struct MeshHeader {
    std::uint32_t vertices, base_vertices, triangles, reserved;  // reserved is zero
};
static_assert(sizeof(MeshHeader) == 16);

[[noreturn]] void refuse(const std::string& why) {
    throw StartupError("read a progressive mesh", why, "bake the scene again with this version of tact-prep");
}

bool sane(const MeshVertex& vertex) {
    return std::all_of(vertex.position_m.begin(), vertex.position_m.end(),
                       [](float x) { return std::abs(static_cast<double>(x)) <= kPositionMax; }) &&
           vertex.normal[3] == 0;
}

void check_counts(const ProgressiveMeshData& data) {
    const std::size_t n = data.vertex.size();
    const std::size_t t = data.triangle.size() / 3;
    if (n > kCountMax || t > kCountMax)
        refuse("it has more than " + std::to_string(kCountMax) + " vertices or triangles");
    if (data.base_vertices < 1 || data.base_vertices > n)
        refuse("its base has " + std::to_string(data.base_vertices) + " of " + std::to_string(n) +
               " vertices");
    const std::size_t contractions = n - data.base_vertices;
    if (data.triangle.size() % 3 != 0 || data.parent.size() != contractions ||
        data.merged.size() != contractions || data.error_m.size() != contractions + 1 ||
        data.triangle_count.size() != contractions + 1)
        refuse("the lengths of its tables do not match its counts");
    if (data.triangle_count.back() != t) refuse("its finest level does not contain all triangles");
}

void check_content(const ProgressiveMeshData& data) {
    const auto n = static_cast<std::uint32_t>(data.vertex.size());
    for (std::size_t k = 0; k < data.parent.size(); ++k) {
        const std::size_t vertex = data.base_vertices + k;
        if (data.parent[k] >= vertex)
            refuse("vertex " + std::to_string(vertex) + " is contracted into vertex " +
                   std::to_string(data.parent[k]));
        if (data.triangle_count[k] > data.triangle_count[k + 1])
            refuse("level " + std::to_string(vertex) + " has more triangles than the next finer one");
        if (!(data.error_m[k] >= data.error_m[k + 1]) || !std::isfinite(data.error_m[k]))
            refuse("the error of level " + std::to_string(vertex) + " is below that of the next finer one");
    }
    if (!(data.error_m.back() >= 0.0F) || !std::isfinite(data.error_m.back()))
        refuse("the error of the finest level is negative");
    for (std::size_t c = 0; c < data.triangle.size(); ++c) {
        if (data.triangle[c] >= n)
            refuse("triangle " + std::to_string(c / 3) + " names vertex " + std::to_string(data.triangle[c]) +
                   " of " + std::to_string(n));
    }
    if (!std::all_of(data.vertex.begin(), data.vertex.end(), sane) ||
        !std::all_of(data.merged.begin(), data.merged.end(), sane))
        refuse("a vertex is not finite, is farther than 1e6 m or has a damaged normal");
}

std::uint32_t ten_bits(std::int16_t part) {
    const long rounded = std::lround(511.0 / 32767.0 * part);
    return static_cast<std::uint32_t>(std::clamp(rounded, -511L, 511L)) & 1023U;
}

}  // namespace

PackedVertex pack(const MeshVertex& vertex) {
    return {vertex.position_m,
            ten_bits(vertex.normal[0]) | ten_bits(vertex.normal[1]) << 10 | ten_bits(vertex.normal[2]) << 20};
}

std::array<float, 3> unit_normal(const PackedVertex& vertex) {
    const auto part = [&](unsigned shift) {  // the left shift moves the sign to the highest bit
        return static_cast<float>(static_cast<std::int32_t>(vertex.normal << (22 - shift)) >> 22) / 511.0F;
    };
    return {part(0), part(10), part(20)};
}

ProgressiveMesh::ProgressiveMesh(ProgressiveMeshData data) {
    check_counts(data);
    check_content(data);
    base_ = data.base_vertices;
    order_versions(data);
    derive_corners(data);
    parent_.assign(data.parent.begin(), data.parent.end());
    error_m_ = std::move(data.error_m);
    triangle_count_ = std::move(data.triangle_count);
}

// Each span starts with the vertices shown by its top level. So a level is found among about 1.5 times as
// many versions as the top has vertices, at any distance below the original.
void ProgressiveMesh::order_versions(const ProgressiveMeshData& data) {
    const auto n = static_cast<std::uint32_t>(data.vertex.size());
    std::size_t versions = data.parent.size();
    for (std::uint32_t top = n;; top /= 2) {
        spans_.push_back({top, 0, 0});
        versions += top;
        if (top / 2 <= base_) break;
    }
    version_.resize(versions);
    version_level_.assign(versions + 1, UINT32_MAX);
    version_merged_.resize(data.parent.size());
    version_coarsest_.resize(data.parent.size() + 1);
    std::vector<PackedVertex> now(n);
    std::transform(data.vertex.begin(), data.vertex.end(), now.begin(), pack);
    std::vector<std::uint32_t> length, place(n);
    std::uint32_t end = 0;
    for (std::size_t s = 0; s < spans_.size(); ++s) {
        const std::uint32_t top = spans_[s].top, low = s + 1 < spans_.size() ? spans_[s + 1].top : base_;
        length.assign(top, 1);
        for (std::uint32_t v = low; v < top; ++v) ++length[data.parent[v - base_]];
        spans_[s].version_first = end;
        for (std::uint32_t v = 0; v < top; end += length[v++]) version_[place[v] = end] = now[v];
        spans_[s].version_end = end;
        if (s == 0) {
            for (std::uint32_t v = 0; v < top; v += kVersionStride) version_original_.push_back(place[v]);
            version_original_.push_back(end);
        }
        for (std::uint32_t v = top; v-- > low;) {
            const std::uint32_t k = v - base_, parent = data.parent[k], to = ++place[parent];
            version_[to] = now[parent] = pack(data.merged[k]);
            version_level_[to] = v;
            version_merged_[k] = to;
            version_coarsest_[k + 1] = place[v];
        }
        version_coarsest_[0] = place[base_ - 1];
    }
}

void ProgressiveMesh::derive_corners(const ProgressiveMeshData& data) {
    const std::uint32_t base = base_;
    const std::size_t contractions = data.parent.size();
    const std::uint64_t changes_max = kChangesPerItem * (contractions + data.triangle.size() / 3) + 1024;
    change_first_.assign(contractions + 1, 0);

    // Calls visit(contraction, triangle, corner) for every corner that a contraction moves.
    const auto lift = [&](std::size_t t, std::uint32_t born, auto&& visit) {
        std::array<std::uint32_t, 3> v{data.triangle[3 * t], data.triangle[3 * t + 1],
                                       data.triangle[3 * t + 2]};
        for (;;) {
            if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
                refuse("triangle " + std::to_string(t) + " has two equal corners at a level that draws it");
            const std::size_t corner =
                static_cast<std::size_t>(std::max_element(v.begin(), v.end()) - v.begin());
            if (v[corner] < born) return v;
            const std::uint32_t k = v[corner] - base;
            visit(k, t, corner);
            v[corner] = data.parent[k];
        }
    };
    const auto all = [&](auto&& visit, auto&& done) {
        std::size_t t = 0;
        for (std::size_t k = 0; k <= contractions; ++k) {
            for (; t < data.triangle_count[k]; ++t)
                done(t, k, lift(t, base + static_cast<std::uint32_t>(k), visit));
        }
    };
    std::uint64_t changes = 0;
    all(
        [&](std::uint32_t k, std::size_t, std::size_t) {
            if (++changes > changes_max) refuse("its contractions move more corners than any surface has");
            ++change_first_[k + 1];
        },
        [&](std::size_t t, std::size_t k, const std::array<std::uint32_t, 3>& v) {
            if (k == 0) return;
            const std::uint32_t child = base + static_cast<std::uint32_t>(k) - 1;
            if (std::find(v.begin(), v.end(), child) == v.end() ||
                std::find(v.begin(), v.end(), data.parent[k - 1]) == v.end())
                refuse("triangle " + std::to_string(t) + " disappears before two of its corners meet");
        });
    if (changes > std::uint64_t{UINT32_MAX}) refuse("it has more than 2^32 corner changes");
    for (std::size_t k = 0; k < contractions; ++k) change_first_[k + 1] += change_first_[k];

    PatchedMesh patched = make_patches(data, changes_max);
    patches_ = std::move(patched.patches);
    change_.resize(changes);
    birth_.resize(data.triangle.size() / 3 - data.triangle_count[0]);
    std::vector<std::uint32_t> next(change_first_.begin(), change_first_.end() - 1);
    all(
        [&](std::uint32_t k, std::size_t t, std::size_t corner) {
            change_[next[k]++] =
                patches_.place_at(patched.number[t], base + k + 1) + static_cast<std::uint32_t>(corner);
        },
        [&](std::size_t t, std::size_t k, const std::array<std::uint32_t, 3>& v) {
            if (k == 0) return;
            const std::uint32_t level = base + static_cast<std::uint32_t>(k);
            birth_[t - data.triangle_count[0]] =
                birth(patches_.place_at(patched.number[t], level), v, level - 1, data.parent[k - 1]);
        });
}

ProgressiveMesh::Birth ProgressiveMesh::birth(std::uint32_t place,
                                              const std::array<std::uint32_t, 3>& corners,
                                              std::uint32_t child, std::uint32_t parent) {
    const auto at = [&](std::uint32_t v) {
        return static_cast<std::uint32_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
    };
    const std::uint32_t c = at(child), p = at(parent), other = 3 - c - p;
    const std::uint32_t mirrored = p == (c + 1) % 3 ? 0 : 1;
    return {place, corners[other] | (2 * c + mirrored) << 29};
}

std::size_t ProgressiveMesh::memory_bytes() const {
    const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    return bytes(parent_) + bytes(error_m_) + bytes(triangle_count_) + bytes(version_) +
           bytes(version_level_) + bytes(version_original_) + bytes(version_coarsest_) +
           bytes(version_merged_) + patches_.memory_bytes() + bytes(birth_) + bytes(change_first_) +
           bytes(change_);
}

void write_mesh(SceneWriter& out, std::uint32_t index, const ProgressiveMeshData& data) {
    BytesOut bytes;
    bytes.put(MeshHeader{static_cast<std::uint32_t>(data.vertex.size()), data.base_vertices,
                         static_cast<std::uint32_t>(data.triangle.size() / 3), 0});
    bytes.put_all(data.vertex);
    bytes.put_all(data.parent);
    bytes.put_all(data.merged);
    bytes.put_all(data.error_m);
    bytes.put_all(data.triangle);
    bytes.put_all(data.triangle_count);
    out.add(kMeshTag, kMeshVersion, index, bytes.take());
}

ProgressiveMeshData read_mesh_data(const SceneFile& file, std::uint32_t index) {
    BytesIn in(file.section(kMeshTag, kMeshVersion, index),
               file.name() + ", section MESH " + std::to_string(index));
    const auto header = in.get<MeshHeader>("header");
    if (header.reserved != 0) in.fail("a reserved field is not zero");
    if (header.base_vertices < 1 || header.base_vertices > header.vertices)
        in.fail("its base has " + std::to_string(header.base_vertices) + " of " +
                std::to_string(header.vertices) + " vertices");
    const std::uint64_t contractions = header.vertices - header.base_vertices;
    ProgressiveMeshData data;
    data.base_vertices = header.base_vertices;
    data.vertex = in.get_all<MeshVertex>(header.vertices, "vertices");
    data.parent = in.get_all<std::uint32_t>(contractions, "parents");
    data.merged = in.get_all<MeshVertex>(contractions, "merged vertices");
    data.error_m = in.get_all<float>(contractions + 1, "errors");
    data.triangle = in.get_all<std::uint32_t>(std::uint64_t{3} * header.triangles, "triangles");
    data.triangle_count = in.get_all<std::uint32_t>(contractions + 1, "triangle counts");
    in.finish();
    return data;
}

ProgressiveMesh read_mesh(const SceneFile& file, std::uint32_t index) {
    ProgressiveMeshData data = read_mesh_data(file, index);
    try {
        return ProgressiveMesh(std::move(data));
    } catch (const StartupError& error) {
        // Adds the file name; the first line of the cause is the fault.
        const std::string why = error.what();
        throw StartupError("read scene " + file.name() + ", section MESH " + std::to_string(index),
                           why.substr(0, why.find('\n')),
                           "bake the scene again with this version of tact-prep");
    }
}

}  // namespace tact
