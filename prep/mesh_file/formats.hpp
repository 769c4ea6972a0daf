// One function per mesh format, and their shared code: builds a mesh and checks it as it grows.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "ipc/base/error.hpp"
#include "prep/mesh_file/import_mesh.hpp"

namespace tact {

struct MeshSource {
    std::string_view bytes;
    std::string name;
    const Progress& progress;
    const AnnounceMesh& announce;

    [[noreturn]] void refuse(const std::string& why, const std::string& fix = "export the mesh again") const {
        throw StartupError("read mesh " + name, why, fix);
    }
    void at(std::size_t place) const {
        report(progress, static_cast<double>(place) / static_cast<double>(bytes.size() + 1),
               "reading the mesh");
    }
};

class MeshBuilder {
public:
    explicit MeshBuilder(const MeshSource& source) : source_(source) {}

    // Announces the memory needed, then reserves it. The counts are bounded by the file's size and may be estimates.
    void reserve(std::size_t vertices, std::size_t triangles) {
        vertices = std::min<std::size_t>(vertices, kMeshElementsMax);
        triangles = std::min<std::size_t>(triangles, kMeshElementsMax);
        if (source_.announce) source_.announce({vertices, triangles, 12 * (vertices + triangles)});
        mesh_.position_m.reserve(3 * vertices);
        mesh_.triangle.reserve(3 * triangles);
    }
    [[nodiscard]] std::size_t vertices() const { return mesh_.vertices(); }
    [[nodiscard]] const std::vector<float>& position_m() const { return mesh_.position_m; }
    // `where` returns the place for error texts: "line 7". It is called only on an error.
    template <class Where>
    void vertex(const std::array<double, 3>& p, Where&& where) {
        if (mesh_.vertices() >= kMeshElementsMax)
            source_.refuse("the mesh has more than 2^28 vertices", kSmaller);
        check(source_, p, where);
        for (const double x : p) mesh_.position_m.push_back(static_cast<float>(x));
    }
    template <class Where>
    static void check(const MeshSource& source, const std::array<double, 3>& p, Where&& where) {
        for (const double x : p) {
            if (!(std::abs(x) <= 1e6))
                source.refuse(where() + ": a coordinate is not a number of at most 1e6 in size",
                              "move the mesh near the origin, or repair it");
        }
    }
    template <class Where>
    void face(std::span<const std::int64_t> corner, Where&& where) {
        if (corner.size() < 3) source_.refuse(where() + ": the face has fewer than three corners");
        if (mesh_.triangles() + corner.size() > kMeshElementsMax)
            source_.refuse("the mesh has more than 2^28 triangles", kSmaller);
        for (const std::int64_t v : corner) {
            if (v < 0 || v >= kMeshElementsMax)
                source_.refuse(where() + ": the face refers to a vertex that does not exist");
            largest_ = std::max(largest_, v);
        }
        for (std::size_t i = 2; i < corner.size(); ++i) {
            for (const std::size_t k : {std::size_t{0}, i - 1, i})
                mesh_.triangle.push_back(static_cast<std::uint32_t>(corner[k]));
        }
    }
    TriangleMesh finish() {
        if (mesh_.triangles() == 0)
            source_.refuse("the file has no faces", "export a surface, not points or lines");
        if (largest_ >= static_cast<std::int64_t>(mesh_.vertices()))
            source_.refuse("a face refers to vertex " + std::to_string(largest_) +
                           " (from 0), but the number of vertices is " + std::to_string(mesh_.vertices()));
        return std::move(mesh_);
    }

    static constexpr std::size_t kCornersMax = 255;

private:
    static constexpr const char* kSmaller = "split the mesh into parts";
    const MeshSource& source_;
    TriangleMesh mesh_;
    std::int64_t largest_ = -1;
};

ImportedMesh read_ply(const MeshSource& source);
ImportedMesh read_obj(const MeshSource& source);
ImportedMesh read_off(const MeshSource& source);
ImportedMesh read_stl(const MeshSource& source);

}  // namespace tact
