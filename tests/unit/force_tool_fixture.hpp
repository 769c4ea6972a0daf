// Tools over planes, blocks and rough spheres, and a hand that leads them.
#pragma once

#include <algorithm>
#include <memory>

#include "prep/surface/build_surface.hpp"
#include "prep/surface/sample_tool.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"
#include "rt/force/surface/tool_model.hpp"

namespace tact::tool_test {

inline constexpr double kStiffness = 500.0, kWorldPerModel = 10.0;

inline TriangleMesh box_mesh(const Vec3& half_m) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis)
            mesh.position_m.push_back(
                static_cast<float>((i >> axis & 1) != 0 ? half_m[axis] : -half_m[axis]));
    mesh.triangle = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

inline void append_box(TriangleMesh& to, const Vec3& middle_m, const Vec3& half_m) {
    const auto first = static_cast<std::uint32_t>(to.vertices());
    const TriangleMesh box = box_mesh(half_m);
    for (std::size_t i = 0; i < box.position_m.size(); ++i)
        to.position_m.push_back(box.position_m[i] +
                                static_cast<float>(middle_m[static_cast<Eigen::Index>(i % 3)]));
    for (const std::uint32_t c : box.triangle) to.triangle.push_back(first + c);
}

// A square of 0.2 m, y up, of 2 * parts^2 triangles.
inline TriangleMesh plane_mesh(std::uint32_t parts = 40) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i <= parts; ++i)
        for (std::uint32_t k = 0; k <= parts; ++k)
            for (const double x : {0.2 * i / parts - 0.1, 0.0, 0.2 * k / parts - 0.1})
                mesh.position_m.push_back(static_cast<float>(x));
    for (std::uint32_t i = 0; i < parts; ++i) {
        for (std::uint32_t k = 0; k < parts; ++k) {
            const std::uint32_t a = i * (parts + 1) + k, b = a + parts + 1;
            mesh.triangle.insert(mesh.triangle.end(), {a, b + 1, b, a, a + 1, b + 1});
        }
    }
    return mesh;
}

inline TriangleMesh scaled(TriangleMesh mesh, double by) {
    for (float& x : mesh.position_m) x *= static_cast<float>(by);
    return mesh;
}

// A scene in memory; sizes are in world metres.
struct World {
    std::vector<std::byte> bytes;
    std::unique_ptr<SceneFile> file;
    SurfaceMesh mesh;
    TouchTool tool;
    SceneMeta meta{};
    std::unique_ptr<ToolModel> model(const SurfaceSettings& settings) const {
        return std::make_unique<ToolModel>(meta, mesh, tool, settings);
    }
    [[nodiscard]] double ball_world_m() const { return kWorldPerModel * tool.ball_m; }
};

inline std::unique_ptr<World> world(const TriangleMesh& surface, const TriangleMesh& tool,
                                    ToolSampling sampling = {}) {
    auto w = std::make_unique<World>();
    SceneWriter out;
    write_surface(out, build_surface(scaled(surface, 1.0 / kWorldPerModel)));
    write_touch_tool(out, sample_tool(scaled(tool, 1.0 / kWorldPerModel), sampling));
    w->bytes = out.to_bytes();
    w->file = std::make_unique<SceneFile>(SceneFile::from_bytes(w->bytes, "test.tact"));
    w->mesh = read_surface(*w->file);
    w->tool = read_touch_tool(*w->file);
    w->meta.kind = SceneKind::surface;
    w->meta.world_per_model = kWorldPerModel;
    return w;
}

// A box of 0.03 x 0.01 x 0.02 m over a plane. Few points are enough, because its corners decide.
inline const World& box_on_plane() {
    static const auto made =
        world(plane_mesh(), box_mesh({0.015, 0.005, 0.01}), {.points = 300, .grip_in_middle = true});
    return *made;
}

// A thin bar of 0.04 m along x over two blocks at x = -0.01 and x = 0.015.
inline const World& bar_on_blocks() {
    static const auto made = [] {
        TriangleMesh blocks;
        append_box(blocks, {-0.01, -0.01, 0.0}, {0.001, 0.01, 0.02});
        append_box(blocks, {0.015, -0.01, 0.0}, {0.001, 0.01, 0.02});
        return world(blocks, box_mesh({0.02, 0.001, 0.001}), {.points = 2000});
    }();
    return *made;
}

inline const World& scaler_on_rough() {
    static const auto made = world(rough_sphere(60), made_tool("scaler"), {.grip_in_middle = false});
    return *made;
}

inline SurfaceSettings plain(double friction = 0.0) {
    return {.stiffness_n_m = kStiffness, .damping_n_s_m = 0.0, .friction = friction, .shading = false};
}

inline ToolState at(const Vec3& p, const Quat& q = Quat::Identity()) {
    ToolState tool;
    tool.T_world_tool = {p, q};
    return tool;
}

struct Hand {
    std::unique_ptr<ToolModel> model;
    Pose place;
    Wrench felt;
    Hand(const World& w, const SurfaceSettings& settings, const Pose& start)
        : model(w.model(settings)), place(start) {
        model->reset(at(start.p_m, start.q));
        for (int i = 0; i < ForceFade::ramp_steps(1e-3) + 8; ++i) (void)step(start);
    }
    const Wrench& step(const Pose& pose) {
        place = pose;
        felt = model->step(at(pose.p_m, pose.q), {}).wrench_world;
        return felt;
    }
    // Moves in steps of 0.1 mm or 0.01 rad, then rests.
    const Wrench& lead(const Pose& to, int rest = 300) {
        const Pose from = place;
        const int steps = 1 + static_cast<int>(std::max((to.p_m - from.p_m).norm() / 1e-4,
                                                        from.q.angularDistance(to.q) / 1e-2));
        for (int i = 1; i <= steps; ++i) {
            const double s = static_cast<double>(i) / steps;
            (void)step({from.p_m + s * (to.p_m - from.p_m), from.q.slerp(s, to.q)});
        }
        for (int i = 0; i < rest; ++i) (void)step(to);
        return felt;
    }
    [[nodiscard]] Pose proxy() const {
        Pose p = model->contact().proxy();
        p.p_m *= kWorldPerModel;
        return p;
    }
};

inline Pose pose(const Vec3& p, const Vec3& turn_rad = Vec3::Zero()) {
    return {p, quat_from_rotation_vector(turn_rad)};
}

// Flat on a ball that pokes between the points: here they matter.
inline const World& box_on_rough() {
    static const auto made = world(rough_sphere(40), box_mesh({0.015, 0.005, 0.01}), {.points = 1000});
    return *made;
}

}  // namespace tact::tool_test
