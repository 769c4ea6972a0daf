// Every structure of the scene alone in the map. Poses: half within 20 A and 30 degrees of home, half anywhere in the box, and
// along paths that leave home. At each pose all atoms and every codebook level are judged against one reference sum over all
// atoms; at some, the body rests until its stiffness is measured; and some paths are closed.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "ipc/base/random.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "tests/reference/certify.hpp"
#include "tests/reference/docking_reference.hpp"

namespace tact {
namespace {

namespace ref = reference;

constexpr double kAngstromM = 1e-10;
constexpr double kNearM = 20.0 * kAngstromM, kNearRad = 0.5236;
constexpr int kPathPoses = 100, kRestSteps = 700, kRestEvery = 40, kLoopEvery = 200, kLoopSteps = 400;
constexpr double kPrecision = 1e-4, kPi = 3.14159265358979323846;

struct DockingPromises {
    ref::Promise &force, &torque, &error, &stiffness, &energy;
};

ref::Grid grid_of(const DensityGrid& from, const SceneMeta& meta) {
    ref::Grid grid;
    for (std::size_t a = 0; a < 3; ++a) grid.size[a] = static_cast<int>(from.size[a]);
    grid.origin_m = from.origin_m;
    grid.spacing_m = from.spacing_m;
    grid.values.assign(from.values.begin(), from.values.end());
    grid.background = meta.map_background;
    grid.sigma = meta.map_sigma;
    return grid;
}

ref::Atoms atoms_of(const Structure& s) {
    ref::Atoms atoms;
    for (std::size_t i = 0; i < s.size(); ++i) {
        atoms.at_m.emplace_back(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                static_cast<double>(s.z_m[i]));
        atoms.weight.push_back(static_cast<double>(s.mass_fraction[i]));
    }
    return atoms;
}

class DockingCertifier {
public:
    DockingCertifier(const SceneMeta& meta, const DensityGrid& grid, const ref::Spline& spline,
                     const Structure& structure, const Codebook& codebook, DockingPromises promises,
                     std::uint64_t seed)
        : meta_(meta),
          grid_(grid),
          spline_(spline),
          atoms_(atoms_of(structure)),
          levels_(codebook.levels.size()),
          model_(meta, grid, {structure}, {codebook}, {}),
          promises_(promises),
          gain_{model_.energy_j_per_sigma(), meta.world_per_model},
          random_(seed) {
        for (const Vec3& at : atoms_.at_m) radius_m_ = std::max(radius_m_, at.norm());
        least_voxel_m_ = grid.spacing_m.minCoeff();
    }

    void pose(std::uint64_t number) {
        if (number % kPathPoses == 0) leg_ = random_leg();
        const bool along = number / kPathPoses % 2 == 1;
        Pose at = along ? path(static_cast<double>(number % kPathPoses) / kPathPoses) : random_pose();
        judge(at);
        if (number % kRestEvery == 0) rest(at);
        if (number % kLoopEvery == 0) loop();
    }

private:
    struct Leg {
        Vec3 way_m = Vec3::Zero(), turn_rad = Vec3::Zero(), aside_m = Vec3::Zero();
    };
    [[nodiscard]] Leg random_leg() {
        return {random_.within(kNearM), random_.within(kNearRad), 0.2 * kNearM * random_.direction()};
    }
    [[nodiscard]] Pose path(double s) const {
        Pose at = model_.home();
        at.p_m += s * leg_.way_m + std::sin(2.0 * kPi * s) * leg_.aside_m;
        at.q = quat_from_rotation_vector(s * leg_.turn_rad) * at.q;
        return at;
    }
    [[nodiscard]] Pose random_pose() {
        Pose at = model_.home();
        if (random_.uniform() < 0.5) {
            at.p_m += random_.within(kNearM);
            at.q = quat_from_rotation_vector(random_.within(kNearRad)) * at.q;
        } else {
            for (int a = 0; a < 3; ++a)
                at.p_m[a] = grid_.origin_m[a] + random_.uniform() * grid_.spacing_m[a] *
                                                    (grid_.size[static_cast<std::size_t>(a)] - 1.0);
            at.q = random_.rotation();
        }
        return at;
    }
    [[nodiscard]] float fidelity(std::size_t level) const {
        return levels_ > 0 ? static_cast<float>(level) / static_cast<float>(levels_) : 1.0F;
    }
    [[nodiscard]] StepResult live(const Pose& at, float level) const {
        Budget budget;
        budget.fidelity = level;
        return model_.evaluate(at, budget);
    }
    [[nodiscard]] ref::Sums reference_at(const Pose& at) const {
        return ref::sum(spline_, atoms_, {at.p_m, at.q});
    }

    void judge(const Pose& at) {
        const ref::Wrench right = ref::wrench(reference_at(at), gain_);
        const double floor_n =
            kPrecision *
            (right.force_n.norm() + gain_.energy_j_per_sigma / (gain_.world_per_model * least_voxel_m_));
        const double lever_m = gain_.world_per_model * radius_m_;
        const StepResult whole = live(at, 1.0F);
        note(promises_.force, at, (whole.wrench_world.force_n - right.force_n).norm(), floor_n);
        note(promises_.torque, at, (whole.wrench_world.torque_n_m - right.torque_n_m).norm(),
             kPrecision * right.torque_n_m.norm() + lever_m * floor_n);
        for (std::size_t level = 0; level < levels_; ++level) {
            const StepResult part = live(at, fidelity(level));
            note(promises_.error, at, (part.wrench_world.force_n - right.force_n).norm(),
                 part.load.error + floor_n);
        }
    }
    // The hand holds the body still; the stiffness is then that of central differences of the force at the level.
    void rest(const Pose& at) {
        const float level = fidelity(random_.below(levels_ + 1));
        ModelOrder place;
        place.kind = ModelOrder::Kind::place;
        place.body = model_.bodies().id[model_.bodies().active];
        place.T_model_body = at;
        if (!model_.order(place)) return;
        ToolState tool;
        tool.T_world_tool = {meta_.to_world(at.p_m), Quat::Identity()};
        model_.reset(tool);
        Budget budget;
        budget.fidelity = level;
        for (int i = 0; i < kRestSteps; ++i) static_cast<void>(model_.step(tool, budget));
        ref::Stiffness right;
        if (level == 1.0F) {
            right = ref::stiffness(reference_at(at), gain_);
        } else {
            right = by_differences(at, level);
        }
        const ModelStiffness stated = model_.stiffness();
        note(promises_.stiffness, at, right.force_n_m, 1.1 * stated.force_n_m + 1e-3);
        note(promises_.stiffness, at, right.torque_n_m_rad, 1.1 * stated.torque_n_m_rad + 1e-6);
    }
    [[nodiscard]] ref::Stiffness by_differences(const Pose& at, float level) const {
        Eigen::Matrix3d shift, turn;
        const double h_m = 0.1 * least_voxel_m_, h_rad = h_m / radius_m_;
        for (int a = 0; a < 3; ++a) {
            Pose fore = at, back = at;
            fore.p_m[a] += h_m;
            back.p_m[a] -= h_m;
            shift.col(a) = (live(fore, level).wrench_world.force_n - live(back, level).wrench_world.force_n) /
                           (2.0 * h_m * gain_.world_per_model);
            fore = back = at;
            fore.q = quat_from_rotation_vector(h_rad * Vec3::Unit(a)) * at.q;
            back.q = quat_from_rotation_vector(-h_rad * Vec3::Unit(a)) * at.q;
            turn.col(a) =
                (live(fore, level).wrench_world.torque_n_m - live(back, level).wrench_world.torque_n_m) /
                (2.0 * h_rad);
        }
        const auto norm = [](const Eigen::Matrix3d& m) {
            const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (m + m.transpose()),
                                                                        Eigen::EigenvaluesOnly);
            return solver.eigenvalues().cwiseAbs().maxCoeff();
        };
        return {norm(shift), norm(turn)};
    }
    // Out and back to the same pose in a circle of position and rotation.
    void loop() {
        const float level = fidelity(random_.below(levels_ + 1));
        const Pose middle = random_pose();
        const Vec3 a = 3.0 * kAngstromM * random_.direction(), b = 3.0 * kAngstromM * random_.direction();
        const Vec3 u = 0.15 * random_.direction(), v = 0.15 * random_.direction();
        const auto place = [&](int i) {
            const double angle = 2.0 * kPi * i / kLoopSteps;
            Pose at = middle;
            at.p_m += std::cos(angle) * a + std::sin(angle) * b;
            at.q = quat_from_rotation_vector(std::cos(angle) * u + std::sin(angle) * v) * middle.q;
            return at;
        };
        double gained_j = 0.0;
        Pose before = place(0);
        Wrench wrench = live(before, level).wrench_world;
        for (int i = 1; i <= kLoopSteps; ++i) {
            const Pose now = place(i);
            const Wrench next = live(now, level).wrench_world;
            const Vec3 moved_m = gain_.world_per_model * (now.p_m - before.p_m);
            const Vec3 turned_rad = rotation_vector_rad(now.q * before.q.conjugate());
            gained_j += 0.5 * (wrench.force_n + next.force_n).dot(moved_m) +
                        0.5 * (wrench.torque_n_m + next.torque_n_m).dot(turned_rad);
            before = now;
            wrench = next;
        }
        note(promises_.energy, middle, std::abs(gained_j), 1e-6);
    }
    void note(ref::Promise& promise, const Pose& at, double measured, double allowed) {
        if (!promise.check(measured, allowed)) return;
        char text[200];
        const Vec3 away_a = (at.p_m - model_.home().p_m) / kAngstromM;
        std::snprintf(text, sizeof text,
                      "(%.3f, %.3f, %.3f) A from home, q (%.5f, %.5f, %.5f, %.5f): %.4g, allowed %.4g",
                      away_a.x(), away_a.y(), away_a.z(), at.q.x(), at.q.y(), at.q.z(), at.q.w(), measured,
                      allowed);
        promise.worst_at = text;
    }

    const SceneMeta& meta_;
    const DensityGrid& grid_;
    const ref::Spline& spline_;
    ref::Atoms atoms_;
    std::size_t levels_;
    DockingModel model_;
    DockingPromises promises_;
    ref::Gain gain_;
    SeededRandom random_;
    double radius_m_ = 0.0, least_voxel_m_ = 0.0;
    Leg leg_;
};

}  // namespace

void certify_docking(const SceneFile& scene, const CertifySettings& settings, ref::Promises& promises) {
    SceneMeta meta = read_meta(scene);
    const DensityGrid grid = read_force_map_grid(scene);
    const ref::Spline spline(grid_of(grid, meta));
    const DockingPromises made{
        promises.emplace_back("docking.force",
                              "with all atoms, the force is that of the spline in double precision"),
        promises.emplace_back("docking.torque", "the same for the torque about the centre of mass"),
        promises.emplace_back("docking.error",
                              "a codebook level differs from all atoms by the published error at most"),
        promises.emplace_back("docking.stiffness", "at rest, the stiffness is within 10 % of the stated one"),
        promises.emplace_back("docking.energy",
                              "a closed path of position and rotation gains no more than 1 uJ")};
    const std::uint32_t bodies = meta.body_count;
    for (std::uint32_t i = 0; i < bodies; ++i) {
        SceneMeta alone = meta;
        alone.body_count = 1;
        const Structure structure = read_structure(scene, i);
        DockingCertifier certifier(alone, grid, spline, structure, read_codebook(scene, i), made,
                                   settings.seed + i);
        const std::uint64_t poses = settings.poses / bodies + 1;
        for (std::uint64_t k = 0; k < poses; ++k) {
            if (k % 16 == 0)
                report(settings.progress, (i + static_cast<double>(k) / static_cast<double>(poses)) / bodies,
                       structure.name.c_str());
            certifier.pose(k);
        }
    }
}

}  // namespace tact
