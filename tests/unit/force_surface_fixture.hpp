// Surfaces in memory, and a tool that touches them.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "prep/surface/build_surface.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "rt/force/surface/surface_model.hpp"

namespace tact::surface_test {

inline constexpr double kStiffness = 500.0;

// A scene in memory, which models refer to. The world is 100 times the model.
struct Scene {
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> file;
    SurfaceMesh mesh;
    SceneMeta meta{};
    std::unique_ptr<SurfaceModel> model(const SurfaceSettings& settings) const {
        return std::make_unique<SurfaceModel>(meta, mesh, settings);
    }
};

inline constexpr double kWorldPerModel = 100.0;

inline std::unique_ptr<Scene> scene(TriangleMesh mesh) {  // coordinates in world metres
    for (float& x : mesh.position_m) x /= static_cast<float>(kWorldPerModel);
    auto s = std::make_unique<Scene>();
    SceneWriter out;
    write_surface(out, build_surface(mesh));
    s->bytes = out.to_bytes();
    s->file = std::make_unique<SceneFile>(SceneFile::from_bytes(s->bytes, "test.tact"));
    s->mesh = read_surface(*s->file);
    s->meta.kind = SceneKind::surface;
    s->meta.world_per_model = kWorldPerModel;
    return s;
}

// An open square of 0.1 m through the origin with its normal along `up`, of many triangles.
inline void add_square(TriangleMesh& mesh, const Vec3& right, const Vec3& up, std::uint32_t parts = 20) {
    const Vec3 back = right.cross(up);
    const auto first = static_cast<std::uint32_t>(mesh.vertices());
    for (std::uint32_t i = 0; i <= parts; ++i) {
        for (std::uint32_t k = 0; k <= parts; ++k) {
            const Vec3 p = 0.1 * ((static_cast<double>(i) / parts - 0.5) * right +
                                  (static_cast<double>(k) / parts - 0.5) * back);
            for (const double x : {p.x(), p.y(), p.z()}) mesh.position_m.push_back(static_cast<float>(x));
        }
    }
    for (std::uint32_t i = 0; i < parts; ++i) {
        for (std::uint32_t k = 0; k < parts; ++k) {
            const std::uint32_t a = first + i * (parts + 1) + k, b = a + parts + 1;
            mesh.triangle.insert(mesh.triangle.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    }
}

inline const Scene& plane() {
    static const auto made = [] {
        TriangleMesh mesh;
        add_square(mesh, Vec3::UnitX(), Vec3::UnitY());
        return scene(std::move(mesh));
    }();
    return *made;
}

// The same, turned so that no coordinate of its vertices is exact.
inline Quat tilt() { return quat_from_rotation_vector(Vec3(0.31, -0.72, 0.53)); }
inline const Scene& tilted_plane() {
    static const auto made = [] {
        TriangleMesh mesh;
        add_square(mesh, tilt() * Vec3::UnitX(), tilt() * Vec3::UnitY(), 57);
        return scene(std::move(mesh));
    }();
    return *made;
}

// Three squares that intersect at the origin and form eight corners.
inline const Scene& crossing() {
    static const auto made = [] {
        TriangleMesh mesh;
        add_square(mesh, Vec3::UnitX(), Vec3::UnitY(), 7);
        add_square(mesh, Vec3::UnitY(), Vec3::UnitZ(), 7);
        add_square(mesh, Vec3::UnitZ(), Vec3::UnitX(), 7);
        return scene(std::move(mesh));
    }();
    return *made;
}

inline const Scene& box() {  // 0.04 m wide, two triangles per side
    static const auto made = [] {
        TriangleMesh mesh;
        for (int i = 0; i < 8; ++i)
            for (int axis = 0; axis < 3; ++axis)
                mesh.position_m.push_back((i >> axis & 1) != 0 ? 0.02F : -0.02F);
        mesh.triangle = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                         2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
        return scene(std::move(mesh));
    }();
    return *made;
}

inline const Scene& rough() {
    static const auto made = scene(rough_sphere(40));
    return *made;
}

inline const Scene& smooth() {
    static const auto made = scene(smooth_sphere(40));
    return *made;
}

inline SurfaceSettings plain(double radius_m = 0.0, double friction = 0.0) {
    return {.radius_m = radius_m,
            .stiffness_n_m = kStiffness,
            .damping_n_s_m = 0.0,
            .friction = friction,
            .shading = false};
}

inline ToolState at(const Vec3& p) {
    ToolState tool;
    tool.T_world_tool.p_m = p;
    return tool;
}

// A tool at a free start position, after the force has faded in.
struct Hand {
    std::unique_ptr<SurfaceModel> model;
    Vec3 place;
    Hand(const Scene& s, const SurfaceSettings& settings, const Vec3& start)
        : model(s.model(settings)), place(start) {
        model->reset(at(start));
        for (int i = 0; i < ForceFade::ramp_steps(1e-3); ++i) (void)model->step(at(start), {});
    }
    // Moves in a straight line in steps of 0.1 mm, then rests.
    Vec3 lead(const Vec3& to) {
        const Vec3 from = place;
        const int steps = 1 + static_cast<int>((to - from).norm() / 1e-4);
        for (int i = 1; i <= steps; ++i) (void)step(from + (to - from) * i / steps);
        Vec3 force;
        for (int i = 0; i < 200; ++i) force = step(to);
        return force;
    }
    Vec3 step(const Vec3& p) {
        place = p;
        return model->step(at(p), {}).wrench_world.force_n;
    }
    [[nodiscard]] Vec3 proxy() const { return kWorldPerModel * model->contact().proxy_m; }
};

// Position on a path at constant depth over the rough sphere.
inline Vec3 slide(double t_s, double depth_m) {
    const Vec3 d(std::cos(0.9 * std::sin(0.61 * t_s)) * std::cos(1.1 * t_s),
                 std::cos(0.9 * std::sin(0.61 * t_s)) * std::sin(1.1 * t_s),
                 std::sin(0.9 * std::sin(0.61 * t_s)));
    return (rough_radius_m(d) - depth_m) * d;
}

}  // namespace tact::surface_test
