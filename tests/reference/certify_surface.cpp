// A point and a ball of 1 mm at the default settings, and both without shading, friction and damping. A hand strays over the
// mesh: strokes of 5 mm/s to 0.5 m/s, presses of up to 3 mm, pauses, and lifts. The reference sees only the triangles near
// the tool (stray.hpp).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/mesh/touch_tool.hpp"
#include "rt/force/surface/surface_model.hpp"
#include "tests/reference/certify.hpp"
#include "tests/reference/stray.hpp"
#include "tests/reference/surface_reference.hpp"

namespace tact {
namespace {

namespace ref = reference;

struct SurfacePromises {
    ref::Promise &free, &settled, &plain, &cone, &change, &energy;
};

class SurfaceCertifier {
public:
    SurfaceCertifier(const SurfaceMesh& mesh, const SceneMeta& meta, const Cells& cells,
                     const SurfaceSettings& settings, SurfacePromises promises, SeededRandom& random)
        : meta_(meta),
          cells_(cells),
          settings_(settings),
          model_(meta, mesh, settings),
          promises_(promises),
          hand_(cells, random) {
        ball_.radius = std::max(settings.radius_m, SurfaceModel::kPointM);
        ball_.margin =
            std::min(0.5 * ball_.radius, std::max(1e-3 * ball_.radius, 0.5 * SurfaceModel::kPointM));
        ball_.friction = settings.friction;
    }

    void stray(int steps) {
        Vec3 goal_m = hand_.begin(ball_.radius, ball_.radius);
        if (!hand_.clear()) return;  // too narrow everywhere for this ball
        tool_ = {};
        tool_.T_world_tool.p_m = goal_m;
        model_.reset(tool_);
        Vec3 force_n = Vec3::Zero();
        for (int i = 0; i < ForceFade::ramp_steps(kSurfaceStepS) + 1; ++i)
            force_n = model_.step(tool_, {}).wrench_world.force_n;
        double gained_j = 0.0;
        bool from_free = false;  // the excursion began free: not seated in contact, nor released
        std::uint64_t released = model_.released();
        for (int i = 0; i < steps; ++i) {
            const Vec3 before_m = goal_m;
            goal_m = hand_.next(meta_.to_world(model_.contact().proxy_m), ball_.radius);
            tool_.T_world_tool.p_m = goal_m;
            tool_.twist_world.linear_m_s = (goal_m - before_m) / kSurfaceStepS;
            const StepResult r = model_.step(tool_, {});
            gained_j += 0.5 * (r.wrench_world.force_n + force_n).dot(goal_m - before_m);
            const double moved_n = settings_.stiffness_n_m * (goal_m - before_m).norm();
            note(promises_.change, (r.wrench_world.force_n - force_n).norm(),
                 2.5 * moved_n + 2.0 * SurfaceModel::kLagN + damping_n(goal_m - before_m) + 1e-3);
            force_n = r.wrench_world.force_n;
            if (model_.released() != released) {  // fell through a gap: an excursion of its own
                released = model_.released();
                from_free = false;
            }
            if (model_.contact().planes == 0 && force_n.norm() == 0.0) {
                if (from_free) note(promises_.energy, gained_j, 1e-6);
                from_free = true;
                gained_j = 0.0;
                continue;
            }
            if (model_.contact().planes > 0) judge(r, goal_m);
        }
    }

private:
    [[nodiscard]] double damping_n(const Vec3& moved_m) {
        const double now = settings_.damping_n_s_m * moved_m.norm() / kSurfaceStepS;
        return now + std::exchange(damped_n_, now);
    }
    void judge(const StepResult& r, const Vec3& goal_m) {
        const Contact& contact = model_.contact();
        const Vec3 proxy_m = meta_.to_world(contact.proxy_m), way_m = proxy_m - goal_m;
        const double m = ball_.margin;
        const ref::Triangles near = cells_.near(proxy_m, ball_.radius + 4.0 * m);
        double nearest_m = 1e300;
        for (const auto& c : near.corner)
            nearest_m = std::min(
                nearest_m,
                ref::nearest(near.vertex[c[0]], near.vertex[c[1]], near.vertex[c[2]], proxy_m).distance);
        const double in_m = ball_.radius - m - nearest_m;
        note(promises_.free, in_m, 0.5 * m);
        if (in_m > 0.5 * m) return;  // in many triangles at once, where rest has no meaning
        const ref::Judgement j = ref::judge(near, ball_, proxy_m, goal_m, 3.0 * m);
        const bool settled = contact.state == ContactState::settled;
        if (settled) note(promises_.settled, unborne_m(j, proxy_m, goal_m), 2.0 * m);
        if (plain()) {
            const Vec3 right_n =
                std::min(settings_.stiffness_n_m, settings_.force_n_max / way_m.norm()) * way_m;
            note(promises_.plain, (r.wrench_world.force_n - right_n).norm(), r.load.error + 1e-3);
        }
        // The cone about the push of the touched triangle, where there is one; shading turns it by up to 40 degrees.
        if (!settings_.shading && settled && j.touched.size() == 1 && j.touched[0].inside) {
            const Vec3 &n = j.touched[0].normal, &f = r.wrench_world.force_n;
            const double along = f.dot(n), across = (f - along * n).norm();
            note(promises_.cone, across, settings_.friction * along + r.load.error + 1e-3);
        }
    }
    // Where the touched triangles leave a pull, the slide that it makes: nearly parallel triangles may leave the set of those that
    // bear it to rounding, but not the slide. With friction, the model's parts of the way are judged: one in the cone, and one
    // that the triangles bear.
    [[nodiscard]] double unborne_m(const ref::Judgement& j, const Vec3& proxy_m, const Vec3& goal_m) const {
        const double m = ball_.margin, step_m = std::max(0.05 * ball_.radius, 0.25 * m);
        if (j.unborne <= 2.0 * m) return j.unborne;
        const Vec3 lift_m = meta_.world_per_model * model_.contact().lift_m,
                   rub_m = proxy_m - goal_m - lift_m;
        if (rub_m.norm() > ball_.friction * lift_m.norm() + 1e-3 * m) return j.unborne;
        const ref::Triangles around = cells_.near(proxy_m, ball_.radius + 40.0 * step_m);
        const Vec3 end_m = ref::descend(around, ball_, proxy_m, proxy_m - lift_m, step_m, 0.01 * m);
        return std::min(j.unborne, (end_m - proxy_m).norm());
    }
    [[nodiscard]] bool plain() const {
        return !settings_.shading && settings_.friction == 0.0 && settings_.damping_n_s_m == 0.0;
    }
    void note(ref::Promise& promise, double measured, double allowed) {
        if (!promise.check(measured, allowed)) return;
        const Vec3& at = tool_.T_world_tool.p_m;
        char text[200];
        std::snprintf(text, sizeof text,
                      "(%.6f, %.6f, %.6f) m, radius %.1f mm, shading %d, friction %.1f: %.4g, allowed %.4g",
                      at.x(), at.y(), at.z(), 1e3 * settings_.radius_m, settings_.shading ? 1 : 0,
                      settings_.friction, measured, allowed);
        promise.worst_at = text;
    }

    const SceneMeta& meta_;
    const Cells& cells_;
    SurfaceSettings settings_;
    SurfaceModel model_;
    SurfacePromises promises_;
    Stray hand_;
    ref::Ball ball_;
    ToolState tool_;
    double damped_n_ = 0.0;
};

}  // namespace

void certify_surface(const SceneFile& scene, const CertifySettings& settings, ref::Promises& promises) {
    const SceneMeta meta = read_meta(scene);
    const SurfaceMesh mesh = read_surface(scene);
    const Cells cells(mesh, meta);
    SeededRandom random(settings.seed);
    const SurfacePromises made{
        promises.emplace_back("surface.free",
                              "the proxy is not in a triangle by more than half of its margin"),
        promises.emplace_back("surface.settled",
                              "a proxy called settled is at rest: a Karush-Kuhn-Tucker point"),
        promises.emplace_back(
            "surface.force",
            "without shading and friction, the force is that of the spring to the proxy, within "
            "the published error"),
        promises.emplace_back("surface.cone",
                              "without shading, the force is in the friction cone of its triangle"),
        promises.emplace_back(
            "surface.change",
            "from step to step the force changes by 2.5 times what the motion explains, and "
            "twice the lag force"),
        promises.emplace_back("surface.energy",
                              "an excursion from free to free gives back no more than 1 uJ")};
    std::vector<SurfaceSettings> kinds;
    for (const double radius_m : {0.0, 1e-3}) {
        SurfaceSettings usual;
        usual.radius_m = radius_m;
        SurfaceSettings flat = usual, plain = usual;
        flat.shading = plain.shading = false;
        plain.friction = plain.damping_n_s_m = 0.0;
        kinds.insert(kinds.end(), {usual, flat, plain});
    }
    const std::uint64_t strays = settings.poses / kStraySteps + 1;
    std::vector<std::unique_ptr<SurfaceCertifier>> by_kind;
    for (const SurfaceSettings& kind : kinds)
        by_kind.push_back(std::make_unique<SurfaceCertifier>(mesh, meta, cells, kind, made, random));
    for (std::uint64_t i = 0; i < strays; ++i) {
        report(settings.progress, static_cast<double>(i) / static_cast<double>(strays),
               "strokes and presses");
        by_kind[i % by_kind.size()]->stray(kStraySteps);
    }
    if (has_touch_tool(scene)) certify_tool(scene, settings, promises);
}

}  // namespace tact
