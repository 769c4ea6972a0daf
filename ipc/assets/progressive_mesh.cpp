// Derivation of the step tables. A corner of a triangle starts at its original vertex and is lifted to the
// parent each time its vertex is contracted. Lifting the largest corner first visits the contractions in the
// order in which they happen, so one loop per triangle finds every change and proves that no level has a
// triangle with two equal corners. The work is the number of changes, about four per contraction; a crafted
// file with long chains could make it quadratic, so the number is bounded.
#include "ipc/assets/progressive_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ipc/assets/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kTag{'M', 'E', 'S', 'H'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kCountMax = 1U << 29;  // of vertices or triangles; 3 T fits 32 bits with room
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

}  // namespace

ProgressiveMesh::ProgressiveMesh(ProgressiveMeshData data) : data_(std::move(data)) {
    check_counts();
    check_content();
    derive_vertices();
    derive_corners();
}

void ProgressiveMesh::check_counts() const {
    const std::size_t n = data_.vertex.size();
    const std::size_t t = data_.triangle.size() / 3;
    if (n > kCountMax || t > kCountMax)
        refuse("it has more than " + std::to_string(kCountMax) + " vertices or triangles");
    if (data_.base_vertices < 1 || data_.base_vertices > n)
        refuse("its base has " + std::to_string(data_.base_vertices) + " of " + std::to_string(n) +
               " vertices");
    const std::size_t contractions = n - data_.base_vertices;
    if (data_.triangle.size() % 3 != 0 || data_.parent.size() != contractions ||
        data_.merged.size() != contractions || data_.error_m.size() != contractions + 1 ||
        data_.triangle_count.size() != contractions + 1)
        refuse("its tables do not have the lengths that its counts ask for");
    if (data_.triangle_count.back() != t) refuse("its finest level does not have all triangles");
}

void ProgressiveMesh::check_content() const {
    const auto n = static_cast<std::uint32_t>(data_.vertex.size());
    for (std::size_t k = 0; k < data_.parent.size(); ++k) {
        const std::size_t vertex = data_.base_vertices + k;
        if (data_.parent[k] >= vertex)
            refuse("vertex " + std::to_string(vertex) + " goes into vertex " +
                   std::to_string(data_.parent[k]));
        if (data_.triangle_count[k] > data_.triangle_count[k + 1])
            refuse("level " + std::to_string(vertex) + " has more triangles than the next finer one");
        if (!(data_.error_m[k] >= data_.error_m[k + 1]) || !std::isfinite(data_.error_m[k]))
            refuse("the error of level " + std::to_string(vertex) + " is below that of the next finer one");
    }
    if (!(data_.error_m.back() >= 0.0F) || !std::isfinite(data_.error_m.back()))
        refuse("the error of the finest level is negative");
    for (std::size_t c = 0; c < data_.triangle.size(); ++c) {
        if (data_.triangle[c] >= n)
            refuse("triangle " + std::to_string(c / 3) + " names vertex " +
                   std::to_string(data_.triangle[c]) + " of " + std::to_string(n));
    }
    if (!std::all_of(data_.vertex.begin(), data_.vertex.end(), sane) ||
        !std::all_of(data_.merged.begin(), data_.merged.end(), sane))
        refuse("a vertex is not finite, is further out than 1e6 m or has a damaged normal");
}

void ProgressiveMesh::derive_vertices() {
    const std::uint32_t base = data_.base_vertices;
    std::vector<MeshVertex> now = data_.vertex;
    before_.resize(data_.parent.size());
    child_.resize(data_.parent.size());
    coarser_.resize(data_.parent.size());
    finer_.resize(data_.parent.size());
    std::vector<std::uint32_t> last(data_.vertex.size(), UINT32_MAX);
    for (std::size_t k = data_.parent.size(); k-- > 0;) {
        const std::uint32_t parent = data_.parent[k];
        child_[k] = now[base + k];
        before_[k] = now[parent];
        now[parent] = data_.merged[k];
        finer_[k] = last[parent];
        coarser_[k] = parent;
        if (last[parent] != UINT32_MAX) coarser_[last[parent] - base] = base + static_cast<std::uint32_t>(k);
        last[parent] = base + static_cast<std::uint32_t>(k);
    }
}

void ProgressiveMesh::derive_corners() {
    const std::uint32_t base = data_.base_vertices;
    const std::size_t contractions = data_.parent.size();
    const std::uint64_t changes_max = kChangesPerItem * (contractions + data_.triangle.size() / 3) + 1024;
    birth_ = data_.triangle;
    change_first_.assign(contractions + 1, 0);

    // visit(contraction, place in the index list) for every corner that a contraction moves.
    const auto lift = [&](std::size_t t, std::uint32_t born, auto&& visit) {
        std::array<std::uint32_t, 3> v{data_.triangle[3 * t], data_.triangle[3 * t + 1],
                                       data_.triangle[3 * t + 2]};
        for (;;) {
            if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
                refuse("triangle " + std::to_string(t) + " has two equal corners at a level that draws it");
            const std::size_t corner =
                static_cast<std::size_t>(std::max_element(v.begin(), v.end()) - v.begin());
            if (v[corner] < born) return v;
            const std::uint32_t k = v[corner] - base;
            visit(k, static_cast<std::uint32_t>(3 * t + corner));
            v[corner] = data_.parent[k];
        }
    };
    const auto all = [&](auto&& visit, auto&& done) {
        std::size_t t = 0;
        for (std::size_t k = 0; k <= contractions; ++k) {
            for (; t < data_.triangle_count[k]; ++t)
                done(t, lift(t, base + static_cast<std::uint32_t>(k), visit));
        }
    };
    std::uint64_t changes = 0;
    all(
        [&](std::uint32_t k, std::uint32_t) {
            if (++changes > changes_max)
                refuse("its contractions move far more corners than those of a surface");
            ++change_first_[k + 1];
        },
        [&](std::size_t t, const std::array<std::uint32_t, 3>& v) {
            std::copy(v.begin(), v.end(), birth_.begin() + static_cast<std::ptrdiff_t>(3 * t));
        });
    if (changes > std::uint64_t{UINT32_MAX}) refuse("it has more corner changes than 32 bits count");
    for (std::size_t k = 0; k < contractions; ++k) change_first_[k + 1] += change_first_[k];
    change_.resize(changes);
    std::vector<std::uint32_t> next(change_first_.begin(), change_first_.end() - 1);
    all([&](std::uint32_t k, std::uint32_t place) { change_[next[k]++] = place; },
        [](std::size_t, const std::array<std::uint32_t, 3>&) {});
}

std::size_t ProgressiveMesh::memory_bytes() const {
    const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    return bytes(data_.vertex) + bytes(data_.parent) + bytes(data_.merged) + bytes(data_.error_m) +
           bytes(data_.triangle) + bytes(data_.triangle_count) + bytes(before_) + bytes(child_) +
           bytes(coarser_) + bytes(finer_) + bytes(birth_) + bytes(change_first_) + bytes(change_);
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
    out.add(kTag, kVersion, index, bytes.take());
}

ProgressiveMesh read_mesh(const SceneFile& file, std::uint32_t index) {
    BytesIn in(file.section(kTag, kVersion, index), file.name() + ", section MESH " + std::to_string(index));
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
    try {
        return ProgressiveMesh(std::move(data));
    } catch (const StartupError& error) {
        // Name the file too; the first line of the cause says what is wrong.
        const std::string why = error.what();
        in.fail(why.substr(0, why.find('\n')));
    }
}

}  // namespace tact
