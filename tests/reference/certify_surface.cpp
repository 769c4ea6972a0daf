// A point and a ball of 1 mm at the default settings, and both without shading, friction and damping. A hand strays over the
// mesh: strokes of 5 mm/s to 0.5 m/s, presses of up to 3 mm, pauses, and lifts. The reference sees only the triangles near
// the tool, from a list of cells of its own.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "rt/force/surface/surface_model.hpp"
#include "tests/reference/certify.hpp"
#include "tests/reference/surface_reference.hpp"

namespace tact {
namespace {

namespace ref = reference;

constexpr double kSurfaceStepS = 1e-3, kDeepestM = 3e-3, kLiftM = 4e-3;
constexpr double kHandM = 5e-5;   // change of a step's way from step to step: 50 m/s^2
constexpr int kStraySteps = 500;  // between two fresh places

// The triangles of a mesh in world metres, by cubes of equal size.
class Cells {
public:
    Cells(const SurfaceMesh& mesh, const SceneMeta& meta) {
        for (std::uint32_t v = 0; v < mesh.vertices(); ++v)
            all_.vertex.push_back(meta.to_world(mesh.position_m(v)));
        double sum_m = 0.0;
        for (std::uint32_t t = 0; t < mesh.triangles(); ++t) {
            const auto corner = mesh.corners(t);
            all_.corner.push_back({corner[0], corner[1], corner[2]});
            sum_m += (all_.vertex[corner[1]] - all_.vertex[corner[0]]).norm();
        }
        size_m_ =
            std::max(2.0 * sum_m / static_cast<double>(std::max<std::size_t>(mesh.triangles(), 1)), 5e-4);
        for (std::uint32_t t = 0; t < all_.corner.size(); ++t)
            each(low_m(t), high_m(t), [&](std::int64_t cell) { in_[cell].push_back(t); });
    }
    [[nodiscard]] const ref::Triangles& all() const { return all_; }
    // Those whose boxes come within reach_m.
    [[nodiscard]] ref::Triangles near(const Vec3& place_m, double reach_m) const {
        std::vector<std::uint32_t> found;
        const Vec3 low = place_m.array() - reach_m, high = place_m.array() + reach_m;
        each(low, high, [&](std::int64_t cell) {
            if (const auto at = in_.find(cell); at != in_.end())
                for (const std::uint32_t t : at->second)
                    if ((low_m(t).array() <= high.array()).all() && (high_m(t).array() >= low.array()).all())
                        found.push_back(t);
        });
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        ref::Triangles some;
        for (const std::uint32_t t : found) {
            const auto n = static_cast<std::uint32_t>(some.vertex.size());
            for (const std::uint32_t c : all_.corner[t]) some.vertex.push_back(all_.vertex[c]);
            some.corner.push_back({n, n + 1, n + 2});
        }
        return some;
    }

private:
    [[nodiscard]] Vec3 low_m(std::uint32_t t) const {
        const auto& c = all_.corner[t];
        return all_.vertex[c[0]].cwiseMin(all_.vertex[c[1]]).cwiseMin(all_.vertex[c[2]]);
    }
    [[nodiscard]] Vec3 high_m(std::uint32_t t) const {
        const auto& c = all_.corner[t];
        return all_.vertex[c[0]].cwiseMax(all_.vertex[c[1]]).cwiseMax(all_.vertex[c[2]]);
    }
    template <class Visit>
    void each(const Vec3& low, const Vec3& high, const Visit& visit) const {
        const auto cell = [&](double m) { return static_cast<std::int64_t>(std::floor(m / size_m_)); };
        for (std::int64_t z = cell(low.z()); z <= cell(high.z()); ++z)
            for (std::int64_t y = cell(low.y()); y <= cell(high.y()); ++y)
                for (std::int64_t x = cell(low.x()); x <= cell(high.x()); ++x)
                    visit((z * 2'097'143 + y) * 2'097'143 + x);
    }

    ref::Triangles all_;
    double size_m_ = 1.0;
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> in_;
};

// A hand that strays; it lifts now and then, and never presses deeper than kDeepestM.
class Stray {
public:
    Stray(const Cells& cells, SeededRandom& random) : cells_(cells), mesh_(cells.all()), random_(random) {}

    Vec3 begin(double radius_m) {
        auto [foot, normal] = place();
        // Above the surface, and clear of all other parts of it.
        clear_ = false;
        for (int tries = 0; tries < 200 && !clear_; ++tries) {
            if (tries > 0) std::tie(foot, normal) = place();
            clear_ = is_clear(foot + (radius_m + kLiftM) * normal, radius_m + 1e-4);
        }
        moved_.setZero();
        goal_ = foot + (radius_m + kLiftM) * normal;
        to_ = foot + (radius_m - kDeepestM * random_.uniform()) * normal;
        choose_speed();
        return goal_;
    }
    [[nodiscard]] bool clear() const { return clear_; }  // begin() found a place free of triangles
    Vec3 next(const Vec3& proxy_m, double radius_m) {
        if ((to_ - goal_).norm() <= speed_m_) {
            const Vec3 aside = random_.within(0.02);
            const double choice = random_.uniform();
            if (choice < 0.15)
                pause_ = 40;
            else if (choice < 0.3)
                to_ = proxy_m + (proxy_m - goal_).normalized() * kLiftM + 0.1 * aside;
            else
                to_ = proxy_m + aside + 0.5 * radius_m * random_.direction();
            choose_speed();
        }
        if ((goal_ - proxy_m).norm() > kDeepestM) to_ = proxy_m;
        Vec3 wanted = to_ - goal_;
        const double left = wanted.norm();
        // Slow enough to stop at the target.
        wanted *= pause_ > 0 || left == 0.0
                      ? 0.0
                      : std::min({speed_m_ / left, 1.0, std::sqrt(2.0 * kHandM / left)});
        if (pause_ > 0) --pause_;
        const Vec3 change = wanted - moved_;
        moved_ += std::min(kHandM / std::max(change.norm(), 1e-12), 1.0) * change;
        goal_ += moved_;
        return goal_;
    }

private:
    [[nodiscard]] bool is_clear(const Vec3& at_m, double radius_m) const {
        const ref::Triangles near = cells_.near(at_m, radius_m);
        return std::all_of(near.corner.begin(), near.corner.end(), [&](const auto& c) {
            return ref::nearest(near.vertex[c[0]], near.vertex[c[1]], near.vertex[c[2]], at_m).distance >
                   radius_m;
        });
    }
    std::pair<Vec3, Vec3> place() {
        for (;;) {
            const auto& c = mesh_.corner[random_.below(mesh_.corner.size())];
            const Vec3 &a = mesh_.vertex[c[0]], &b = mesh_.vertex[c[1]], &d = mesh_.vertex[c[2]];
            const Vec3 normal = (b - a).cross(d - a);
            if (normal.norm() > 0.0) return {(a + b + d) / 3.0, normal.normalized()};
        }
    }
    void choose_speed() { speed_m_ = 0.5 * kSurfaceStepS * std::pow(10.0, -2.0 * random_.uniform()); }

    const Cells& cells_;
    const ref::Triangles& mesh_;
    SeededRandom& random_;
    Vec3 goal_ = Vec3::Zero(), to_ = Vec3::Zero(), moved_ = Vec3::Zero();
    double speed_m_ = 1e-4;  // per step
    int pause_ = 0;
    bool clear_ = false;
};

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
        Vec3 goal_m = hand_.begin(ball_.radius);
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
}

}  // namespace tact
