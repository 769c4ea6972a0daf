#include "prep/surface/clean_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/base/huge_pages.hpp"
#include "prep/mesh_file/vertex_table.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kNoVertex = UINT32_MAX;
constexpr double kFlatArea = 1e-10;  // near 1, floats resolve heights down to 1e-7 of a side

[[noreturn]] void refuse_to_clean(const std::string& why, const char* fix) {
    throw StartupError("clean a mesh", why, fix);
}

void check_mesh(const TriangleMesh& mesh) {
    if (mesh.vertices() >= kNoVertex / 4 || mesh.triangles() >= kNoVertex / 4)
        refuse_to_clean("the mesh has more than 2^30 vertices or triangles", "split the mesh into parts");
    for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
        if (mesh.triangle[i] >= mesh.vertices())
            refuse_to_clean("triangle " + std::to_string(i / 3) + " refers to vertex " +
                                std::to_string(mesh.triangle[i]) + ", but the mesh has " +
                                std::to_string(mesh.vertices()),
                            "export the mesh again");
    }
    for (std::size_t i = 0; i < mesh.position_m.size(); ++i) {
        if (!(std::abs(mesh.position_m[i]) <= 1e6F))
            refuse_to_clean("vertex " + std::to_string(i / 3) +
                                " has a coordinate that is not a number of at most 1e6 in size",
                            "move the mesh near the origin, or repair it");
    }
}

// Kept vertices in cells as wide as the tolerance: the vertices near a point lie in one of 27 cells.
class NearTable {
public:
    NearTable(double tolerance, std::size_t vertices)
        : tolerance_(tolerance), first_(std::bit_ceil(std::max<std::size_t>(vertices, 64)), kNoVertex) {}

    // The first kept vertex within the tolerance of p; if none, returns kNoVertex and stores `fresh` as kept at p.
    std::uint32_t find(const std::array<float, 3>& p, const std::vector<float>& position_m,
                       std::uint32_t fresh) {
        std::array<std::int64_t, 3> cell{};
        for (std::size_t i = 0; i < 3; ++i)
            cell[i] = static_cast<std::int64_t>(std::floor(static_cast<double>(p[i]) / tolerance_));
        std::uint32_t found = kNoVertex;
        for (std::int64_t k = 0; k < 27; ++k) {
            const std::size_t at = slot({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
            for (std::uint32_t v = first_[at]; v != kNoVertex; v = next_[v]) {
                double square = 0.0;
                for (std::size_t i = 0; i < 3; ++i) {
                    const double d = static_cast<double>(p[i]) - position_m[3 * std::size_t{v} + i];
                    square += d * d;
                }
                if (square <= tolerance_ * tolerance_) found = std::min(found, v);
            }
        }
        if (found != kNoVertex) return found;
        const std::size_t at = slot(cell);
        next_.push_back(first_[at]);
        first_[at] = fresh;
        return kNoVertex;
    }

private:
    [[nodiscard]] std::size_t slot(const std::array<std::int64_t, 3>& cell) const {
        std::uint64_t h = 0x9E3779B97F4A7C15;
        for (const std::int64_t c : cell) {
            h = (h ^ static_cast<std::uint64_t>(c)) * 0xD6E8FEB86659FD93;
            h ^= h >> 32U;
        }
        return static_cast<std::size_t>(h) & (first_.size() - 1);
    }
    double tolerance_;
    HugeVector<std::uint32_t> first_;
    std::vector<std::uint32_t> next_;  // per kept vertex
};

// Compacts the kept vertices and renumbers the corners.
void merge_vertices(TriangleMesh& mesh, double tolerance, const Progress& progress) {
    const std::size_t n = mesh.vertices();
    std::vector<std::uint32_t> number(n);
    std::vector<float> kept;
    kept.reserve(mesh.position_m.size());
    // With a tolerance, the coarser table also finds equal positions.
    VertexTable same(tolerance > 0.0 ? 0 : n);
    NearTable near(tolerance, tolerance > 0.0 ? n : 0);
    for (std::size_t v = 0; v < n; ++v) {
        if (v % 65536 == 0)
            report(progress, 0.5 * static_cast<double>(v) / static_cast<double>(n), "cleaning: vertices");
        const std::array<float, 3> p{mesh.position_m[3 * v], mesh.position_m[3 * v + 1],
                                     mesh.position_m[3 * v + 2]};
        const auto fresh = static_cast<std::uint32_t>(kept.size() / 3);
        const std::uint32_t known = tolerance > 0.0 ? near.find(p, kept, fresh) : same.find(p, kept);
        number[v] = known != kNoVertex ? known : fresh;
        if (known == kNoVertex) kept.insert(kept.end(), p.begin(), p.end());
    }
    for (std::uint32_t& corner : mesh.triangle) corner = number[corner];
    mesh.position_m = std::move(kept);
}

bool without_area(const TriangleMesh& mesh, const std::uint32_t* corner) {
    const auto at = [&](std::uint32_t v) {
        const float* p = &mesh.position_m[3 * std::size_t{v}];
        return Eigen::Vector3d(p[0], p[1], p[2]);
    };
    const Eigen::Vector3d a = at(corner[1]) - at(corner[0]), b = at(corner[2]) - at(corner[0]);
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
    return !(a.cross(b).norm() > kFlatArea * longest);
}

using CornerKey = std::array<std::uint32_t, 3>;

CornerKey key_of(const std::uint32_t* corner) {
    CornerKey key{corner[0], corner[1], corner[2]};
    std::sort(key.begin(), key.end());
    return key;
}

void drop_triangles(TriangleMesh& mesh, CleanReport& done, const Progress& progress) {
    HugeVector<std::uint32_t> place(std::bit_ceil(std::max<std::size_t>(2 * mesh.triangles(), 64)),
                                    kNoVertex);
    std::uint32_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        if (t % 65536 == 0)
            report(progress, 0.5 + 0.5 * static_cast<double>(t) / static_cast<double>(mesh.triangles()),
                   "cleaning: triangles");
        const CornerKey corner{mesh.triangle[3 * t], mesh.triangle[3 * t + 1], mesh.triangle[3 * t + 2]};
        const CornerKey key = key_of(corner.data());
        if (key[0] == key[1] || key[1] == key[2]) {
            ++done.repeated_corners;
            continue;
        }
        if (without_area(mesh, corner.data())) {
            ++done.zero_area;
            continue;
        }
        std::uint64_t h = 0x9E3779B97F4A7C15;
        for (const std::uint32_t v : key) {
            h = (h ^ v) * 0xD6E8FEB86659FD93;
            h ^= h >> 32U;
        }
        std::size_t at = static_cast<std::size_t>(h) & (place.size() - 1);
        while (place[at] != kNoVertex && key_of(&mesh.triangle[3 * std::size_t{place[at]}]) != key)
            at = (at + 1) & (place.size() - 1);
        if (place[at] != kNoVertex) {
            ++done.repeated_triangles;
            continue;
        }
        place[at] = kept;
        std::copy(corner.begin(), corner.end(), mesh.triangle.begin() + 3 * std::ptrdiff_t{kept});
        ++kept;
    }
    mesh.triangle.resize(3 * std::size_t{kept});
}

void drop_vertices(TriangleMesh& mesh) {
    std::vector<std::uint32_t> number(mesh.vertices(), kNoVertex);
    for (const std::uint32_t v : mesh.triangle) number[v] = 0;
    std::uint32_t next = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == kNoVertex) continue;
        number[v] = next;
        for (std::size_t i = 0; i < 3; ++i)
            mesh.position_m[3 * std::size_t{next} + i] = mesh.position_m[3 * v + i];
        ++next;
    }
    mesh.position_m.resize(3 * std::size_t{next});
    for (std::uint32_t& v : mesh.triangle) v = number[v];
}

}  // namespace

CleanReport clean_mesh(TriangleMesh& mesh, double tolerance, const Progress& progress) {
    if (!(tolerance >= 0.0 && tolerance <= 1e6) || (tolerance > 0.0 && tolerance < 1e-12))
        refuse_to_clean("the tolerance " + std::to_string(tolerance) + " is outside 1e-12 to 1e6",
                        "give a length from 1e-12 to 1e6, or 0 for none");
    check_mesh(mesh);
    CleanReport done;
    done.vertices_in = mesh.vertices();
    done.triangles_in = mesh.triangles();
    merge_vertices(mesh, tolerance, progress);
    done.merged_vertices = done.vertices_in - mesh.vertices();
    drop_triangles(mesh, done, progress);
    drop_vertices(mesh);
    done.unused_vertices = done.vertices_in - done.merged_vertices - mesh.vertices();
    done.vertices = mesh.vertices();
    done.triangles = mesh.triangles();
    if (done.triangles == 0)
        refuse_to_clean("none of the " + std::to_string(done.triangles_in) + " triangles has an area",
                        "export the mesh again, or give a smaller tolerance");
    return done;
}

std::string CleanReport::words() const {
    if (!changed()) return "nothing to clean";
    std::string text;
    const auto add = [&](std::uint64_t count, const char* before, const char* after) {
        if (count == 0) return;
        text += (text.empty() ? "" : ", ") + std::string(before) + std::to_string(count) + after;
    };
    add(merged_vertices, "merged ", merged_vertices == 1 ? " vertex" : " vertices");
    const auto triangles_of = [](std::uint64_t count, const char* kind) {
        return (count == 1 ? " triangle " : " triangles ") + std::string(kind);
    };
    add(repeated_corners, "dropped ", triangles_of(repeated_corners, "with a repeated corner").c_str());
    add(zero_area, "dropped ", triangles_of(zero_area, "without area").c_str());
    add(repeated_triangles, "dropped ", triangles_of(repeated_triangles, "given twice").c_str());
    add(unused_vertices, "dropped ", unused_vertices == 1 ? " unused vertex" : " unused vertices");
    return text;
}

std::string CleanReport::json() const {
    std::string text;
    const auto add = [&](const char* name, std::uint64_t value) {
        text += (text.empty() ? "{\"" : ",\"") + std::string(name) + "\":" + std::to_string(value);
    };
    add("vertices_in", vertices_in);
    add("triangles_in", triangles_in);
    add("merged_vertices", merged_vertices);
    add("repeated_corners", repeated_corners);
    add("zero_area", zero_area);
    add("repeated_triangles", repeated_triangles);
    add("unused_vertices", unused_vertices);
    add("vertices", vertices);
    add("triangles", triangles);
    return text + "}";
}

}  // namespace tact
