// The mesh tool of a surface scene: at the default settings, without shading, and without friction and damping too. A hand strays
// over the mesh as that of a ball does (stray.hpp), and turns at up to 2 rad/s.
#include <cstdio>
#include <memory>
#include <utility>

#include "ipc/base/random.hpp"
#include "rt/force/surface/tool_model.hpp"
#include "tests/reference/certify.hpp"
#include "tests/reference/stray.hpp"
#include "tests/reference/tool_reference.hpp"

namespace tact {
namespace {

namespace ref = reference;

constexpr int kJudgeEvery = 4;         // steps
constexpr double kTurnRadStep = 2e-3;  // per step, at most
constexpr double kTurnChangeRad = 5e-5;
// Of the pull: at an edge the normal of a ball of 20 margins turns by that in a tenth of a margin.
constexpr double kNormalShare = 0.005;

struct ToolPromises {
    ref::Promise &free, &settled, &plain, &change, &energy;
};

class ToolCertifier {
public:
    ToolCertifier(const SurfaceMesh& mesh, const TouchTool& tool, const SceneMeta& meta, const Cells& cells,
                  const SurfaceSettings& settings, ToolPromises promises, SeededRandom& random)
        : meta_(meta),
          cells_(cells),
          settings_(settings),
          model_(meta, mesh, tool, settings),
          promises_(promises),
          random_(random),
          hand_(cells, random) {
        double squares = 0.0;
        for (std::size_t i = 0; i < tool.points(); ++i) {
            lever_m_.push_back(meta.world_per_model * tool.at_m(i));
            squares += lever_m_.back().squaredNorm();
            reach_m_ = std::max(reach_m_, lever_m_.back().norm());
        }
        ball_.radius = meta.world_per_model * model_.contact().settings().ball_m;
        ball_.margin = meta.world_per_model * model_.contact().settings().margin_m;
        ball_.friction = settings.friction;
        gyration_m_ = std::max(std::sqrt(squares / static_cast<double>(tool.points())), ball_.radius);
        reach_m_ += ball_.radius;
    }

    void stray(int steps) {
        Vec3 goal_m = hand_.begin(0.0, reach_m_);
        if (!hand_.clear()) return;  // too narrow everywhere for this tool
        hand_state_ = {};
        hand_state_.T_world_tool = {goal_m, quat_from_rotation_vector(3.0 * random_.direction())};
        model_.reset(hand_state_);
        Vec6 force_n = Vec6::Zero();
        // A force that still fades in is no work of the hand.
        for (int i = 0, seated = 0; i < kSeatMost && seated <= ForceFade::ramp_steps(kSurfaceStepS); ++i) {
            force_n = wrench_n(model_.step(hand_state_, {}));
            seated = model_.contact().seating() ? 0 : seated + 1;
        }
        Vec3 turn_rad = Vec3::Zero(), turn_to_rad = Vec3::Zero();
        double gained_j = 0.0;
        bool from_free = false;
        std::uint64_t released = model_.released();
        for (int i = 0; i < steps; ++i) {
            const Pose before = hand_state_.T_world_tool;
            goal_m = hand_.next(meta_.to_world(model_.contact().proxy().p_m), reach_m_);
            if (i % 50 == 0) turn_to_rad = kTurnRadStep * random_.uniform() * random_.direction();
            const Vec3 change_rad = turn_to_rad - turn_rad;
            turn_rad += std::min(kTurnChangeRad / std::max(change_rad.norm(), 1e-12), 1.0) * change_rad;
            hand_state_.T_world_tool = {goal_m,
                                        (quat_from_rotation_vector(turn_rad) * before.q).normalized()};
            hand_state_.twist_world = {(goal_m - before.p_m) / kSurfaceStepS, turn_rad / kSurfaceStepS};
            const StepResult r = model_.step(hand_state_, {});
            const Vec6 now_n = wrench_n(r);
            Vec6 moved_m;
            moved_m << goal_m - before.p_m, gyration_m_ * turn_rad;
            gained_j += 0.5 * (now_n + force_n).dot(moved_m);
            note(promises_.change, (now_n - force_n).norm(),
                 2.5 * settings_.stiffness_n_m * moved_m.norm() + 2.0 * SurfaceModel::kLagN +
                     damping_n(moved_m) + 1e-3);
            force_n = now_n;
            if (model_.released() != released) {
                released = model_.released();
                from_free = false;
            }
            const ToolTouch& touch = model_.tool_touch();
            if (touch.places == 0 && force_n.norm() == 0.0) {
                if (from_free) note(promises_.energy, gained_j, 1e-6);
                from_free = true;
                gained_j = 0.0;
            } else if (touch.places > 0 && i % kJudgeEvery == 0) {
                judge(r, now_n);
            }
        }
    }

private:
    static constexpr int kSeatMost = 1000;

    // Force, and torque over the radius of gyration.
    [[nodiscard]] Vec6 wrench_n(const StepResult& r) const {
        Vec6 w;
        w << r.wrench_world.force_n, r.wrench_world.torque_n_m / gyration_m_;
        return w;
    }
    [[nodiscard]] double damping_n(const Vec6& moved_m) {
        const double now = settings_.damping_n_s_m * moved_m.norm() / kSurfaceStepS;
        return now + std::exchange(damped_n_, now);
    }
    void judge(const StepResult& r, const Vec6& force_n) {
        const Pose& proxy = model_.contact().proxy();
        const Vec3 hand_m = meta_.to_world(proxy.p_m);
        const Pose& at = hand_state_.T_world_tool;
        Vec6 way_m;
        way_m << hand_m - at.p_m,
            gyration_m_ * rotation_vector_rad((proxy.q * at.q.conjugate()).normalized());
        const double m = ball_.margin;
        const ref::ToolJudgement j = judged(hand_m, proxy.q, way_m);
        note(promises_.free, j.deepest, 2.0 * m);
        if (j.deepest > 2.0 * m) return;
        if (model_.tool_touch().state == ContactState::settled)
            note(promises_.settled, unborne_m(j, hand_m, proxy.q, way_m),
                 2.0 * m + kNormalShare * way_m.norm());
        if (!settings_.shading && settings_.friction == 0.0 && settings_.damping_n_s_m == 0.0) {
            const Vec6 right_n =
                std::min(settings_.stiffness_n_m, settings_.force_n_max / way_m.norm()) * way_m;
            note(promises_.plain, (force_n - right_n).norm(), r.load.error + 1e-3);
        }
    }
    [[nodiscard]] ref::ToolJudgement judged(const Vec3& hand_m, const Quat& turn, const Vec6& way_m) const {
        std::vector<ref::Point> levers;
        for (std::uint32_t i = 0; i < lever_m_.size(); ++i)
            if (model_.contact().points().is_awake(i)) levers.push_back(turn * lever_m_[i]);
        return ref::judge_tool(
            [&](const Vec3& place_m, double within_m) { return cells_.near(place_m, within_m); }, ball_,
            hand_m, levers, gyration_m_, -way_m, 4.0 * ball_.margin);
    }
    // The least on a slide of two margins with what is left of the pull, and of a quarter of one against it: normals at an edge turn
    // by a twentieth in a margin, and a proxy that moves by a tenth of one may have passed its rest.
    [[nodiscard]] double unborne_m(const ref::ToolJudgement& here, const Vec3& hand_m, const Quat& turn,
                                   const Vec6& way_m) const {
        double least_m = here.unborne;
        for (const double sign : {1.0, -1.0}) {
            ref::ToolJudgement j = here;
            Pose at{hand_m, turn};
            Vec6 way = way_m;
            const int steps = sign > 0.0 ? 8 : 1;
            for (int i = 0; i < steps && least_m > 2.0 * ball_.margin; ++i) {
                const Vec6 step_m = sign * 0.25 * ball_.margin * j.left.normalized();
                at.p_m += step_m.head<3>();
                at.q = (quat_from_rotation_vector(step_m.tail<3>() / gyration_m_) * at.q).normalized();
                way += step_m;
                j = judged(at.p_m, at.q, way);
                if (j.deepest <= 2.0 * ball_.margin) least_m = std::min(least_m, j.unborne);
            }
        }
        return least_m;
    }
    void note(ref::Promise& promise, double measured, double allowed) {
        if (!promise.check(measured, allowed)) return;
        const Pose& at = hand_state_.T_world_tool;
        const Vec3 turn_rad = rotation_vector_rad(at.q);
        char text[240];
        std::snprintf(text, sizeof text,
                      "(%.6f, %.6f, %.6f) m, turned by (%.4f, %.4f, %.4f) rad, shading %d, friction %.1f: "
                      "%.4g, allowed %.4g",
                      at.p_m.x(), at.p_m.y(), at.p_m.z(), turn_rad.x(), turn_rad.y(), turn_rad.z(),
                      settings_.shading ? 1 : 0, settings_.friction, measured, allowed);
        promise.worst_at = text;
    }

    const SceneMeta& meta_;
    const Cells& cells_;
    SurfaceSettings settings_;
    ToolModel model_;
    ToolPromises promises_;
    SeededRandom& random_;
    Stray hand_;
    ref::Ball ball_;
    std::vector<Vec3> lever_m_;  // in the tool's axes
    double gyration_m_ = 0.0, reach_m_ = 0.0, damped_n_ = 0.0;
    ToolState hand_state_;
};

}  // namespace

void certify_tool(const SceneFile& scene, const CertifySettings& settings, ref::Promises& promises) {
    const SceneMeta meta = read_meta(scene);
    const SurfaceMesh mesh = read_surface(scene);
    const TouchTool tool = read_touch_tool(scene);
    const Cells cells(mesh, meta);
    SeededRandom random(settings.seed);
    const ToolPromises made{
        promises.emplace_back("tool.free",
                              "no ball of a point in use is in a triangle by more than two of its margins"),
        promises.emplace_back(
            "tool.settled",
            "a proxy called settled is two margins or less from a Karush-Kuhn-Tucker point of its twist"),
        promises.emplace_back(
            "tool.force",
            "without shading and friction, the wrench is that of the spring to the proxy, within the "
            "published error"),
        promises.emplace_back(
            "tool.change",
            "from step to step the wrench changes by 2.5 times what the motion explains, and twice the "
            "lag force"),
        promises.emplace_back("tool.energy", "an excursion from free to free gives back no more than 1 uJ")};
    SurfaceSettings usual;
    SurfaceSettings flat = usual, plain = usual;
    flat.shading = plain.shading = false;
    plain.friction = plain.damping_n_s_m = 0.0;
    std::vector<std::unique_ptr<ToolCertifier>> by_kind;
    for (const SurfaceSettings& kind : {usual, flat, plain})
        by_kind.push_back(std::make_unique<ToolCertifier>(mesh, tool, meta, cells, kind, made, random));
    const std::uint64_t strays = settings.poses / kStraySteps + 1;
    for (std::uint64_t i = 0; i < strays; ++i) {
        report(settings.progress, static_cast<double>(i) / static_cast<double>(strays), "the mesh tool");
        by_kind[i % by_kind.size()]->stray(kStraySteps);
    }
}

}  // namespace tact
