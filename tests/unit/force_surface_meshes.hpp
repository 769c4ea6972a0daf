// Difficult meshes for the contact, as a surface of the product and as triangles of the reference.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/random.hpp"
#include "prep/mesh_file/import_mesh.hpp"
#include "prep/surface/build_surface.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "tests/reference/surface_reference.hpp"

namespace tact::surface_test {

struct MeshScene {
    std::string name;
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> file;
    SurfaceMesh mesh;
    reference::Triangles triangles;
    double size_m = 0.0;
};

inline std::unique_ptr<MeshScene> mesh_scene(const std::string& name, const TriangleMesh& from) {
    auto s = std::make_unique<MeshScene>();
    s->name = name;
    SceneWriter out;
    write_surface(out, build_surface(from));
    s->bytes = out.to_bytes();
    s->file = std::make_unique<SceneFile>(SceneFile::from_bytes(s->bytes, "mesh.tact"));
    s->mesh = read_surface(*s->file);
    for (std::uint32_t v = 0; v < s->mesh.vertices(); ++v)
        s->triangles.vertex.push_back(s->mesh.position_m(v));
    for (std::uint32_t t = 0; t < s->mesh.triangles(); ++t) s->triangles.corner.push_back(s->mesh.corners(t));
    s->size_m = 0.5 * (s->mesh.high_m() - s->mesh.low_m()).norm();
    return s;
}

inline std::uint32_t add_vertex(TriangleMesh& mesh, const Vec3& p) {
    for (const double x : {p.x(), p.y(), p.z()}) mesh.position_m.push_back(static_cast<float>(x));
    return static_cast<std::uint32_t>(mesh.vertices() - 1);
}

inline void add_triangle(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::uint32_t i = add_vertex(mesh, a), k = add_vertex(mesh, b), l = add_vertex(mesh, c);
    mesh.triangle.insert(mesh.triangle.end(), {i, k, l});
}

// Triangles of about size_m at random places in a cube; flat: height over base.
inline TriangleMesh soup(int count, double cube_m, double size_m, double flat, std::uint64_t seed) {
    SeededRandom random(seed);
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3 centre =
            cube_m * (Vec3(random.uniform(), random.uniform(), random.uniform()) - Vec3::Constant(0.5));
        const Vec3 along = random.direction(), across = along.cross(random.direction()).normalized();
        add_triangle(mesh, centre - 0.5 * size_m * along, centre + 0.5 * size_m * along,
                     centre + size_m * ((random.uniform() - 0.5) * along + flat * across));
    }
    return mesh;
}

// A grid of parts x parts squares over side_m with height(x, z).
template <class Height>
TriangleMesh terrain(std::uint32_t parts, double side_m, const Height& height) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i <= parts; ++i)
        for (std::uint32_t k = 0; k <= parts; ++k) {
            const double x = side_m * (static_cast<double>(i) / parts - 0.5),
                         z = side_m * (static_cast<double>(k) / parts - 0.5);
            (void)add_vertex(mesh, {x, height(x, z), z});
        }
    for (std::uint32_t i = 0; i < parts; ++i)
        for (std::uint32_t k = 0; k < parts; ++k) {
            const std::uint32_t a = i * (parts + 1) + k, b = a + parts + 1;
            mesh.triangle.insert(mesh.triangle.end(), {a, b + 1, b, a, a + 1, b + 1});
        }
    return mesh;
}

inline TriangleMesh uneven_terrain(std::uint64_t seed, std::uint32_t parts = 30, double side_m = 0.03,
                                   double rough_m = 6e-4) {
    SeededRandom random(seed);
    return terrain(parts, side_m, [&](double, double) { return rough_m * random.uniform(); });
}

// Sheets folded onto themselves, and covered twice by other triangles.
inline TriangleMesh folded() {
    TriangleMesh mesh =
        terrain(16, 0.02, [](double x, double) { return 1e-3 * std::abs(std::remainder(x, 4e-3) / 2e-3); });
    const TriangleMesh twice =
        terrain(11, 0.02, [](double x, double) { return 1e-3 * std::abs(std::remainder(x, 4e-3) / 2e-3); });
    const auto first = static_cast<std::uint32_t>(mesh.vertices());
    mesh.position_m.insert(mesh.position_m.end(), twice.position_m.begin(), twice.position_m.end());
    for (const std::uint32_t v : twice.triangle) mesh.triangle.push_back(first + v);
    // Folds: a sheet that returns over itself at a small angle.
    for (int i = 0; i < 12; ++i) {
        const double x = -0.009 + 0.0015 * i;
        const Vec3 a(x, 0.0015, -0.006), b(x, 0.0015, 0.006), up(x + 0.003, 0.0025, 0.0),
            back(x - 0.001, 0.00251, 0.001);
        add_triangle(mesh, a, b, up);
        add_triangle(mesh, a, up, back);
        add_triangle(mesh, b, back, up);
        add_triangle(mesh, a, b, up);
    }
    return mesh;
}

inline TriangleMesh with_flipped(TriangleMesh mesh, double fraction, std::uint64_t seed) {
    SeededRandom random(seed);
    for (std::size_t t = 0; t < mesh.triangle.size(); t += 3)
        if (random.uniform() < fraction) std::swap(mesh.triangle[t], mesh.triangle[t + 1]);
    return mesh;
}

// Some hundred to some thousand triangles, for a reference that tests every triangle.
inline const std::vector<const MeshScene*>& difficult_meshes() {
    static const std::vector<std::unique_ptr<MeshScene>> made = [] {
        std::vector<std::unique_ptr<MeshScene>> m;
        m.push_back(mesh_scene("soup", soup(500, 0.02, 4e-3, 0.5, 1)));
        m.push_back(mesh_scene("slivers", soup(500, 0.02, 6e-3, 2e-3, 2)));
        m.push_back(mesh_scene("needles", soup(400, 0.02, 8e-3, 1e-6, 3)));
        m.push_back(mesh_scene("folded", folded()));
        m.push_back(mesh_scene("terrain", uneven_terrain(4)));
        m.push_back(mesh_scene("sphere", rough_sphere(10)));
        return m;
    }();
    static const std::vector<const MeshScene*> all = [] {
        std::vector<const MeshScene*> a;
        for (const auto& m : made) a.push_back(m.get());
        return a;
    }();
    return all;
}

// Small meshes of the folder of real data, scaled to 0.1 m; none without the folder.
inline std::vector<std::unique_ptr<MeshScene>> real_meshes() {
    const char* const shared = std::getenv("TACT_SHARED");
    const std::filesystem::path folder =
        std::filesystem::path(shared != nullptr ? shared : "../shared") / "data" / "meshes";
    std::vector<std::unique_ptr<MeshScene>> scenes;
    for (const char* name : {"cow.obj", "beetle_nonmanifold.obj", "teapot_open.obj"}) {
        if (!std::filesystem::is_regular_file(folder / name)) continue;
        TriangleMesh mesh = import_mesh(folder / name).mesh;
        float most = 0.0F;
        for (const float x : mesh.position_m) most = std::max(most, std::abs(x));
        for (float& x : mesh.position_m) x *= 0.05F / most;
        scenes.push_back(mesh_scene(name, mesh));
    }
    return scenes;
}

}  // namespace tact::surface_test
