// Derivation. A body has points x_i = c + q b_i with weights w_i, sum w_i = 1, b_i from its centre of mass,
// so c is that centre. With U = -k_E sum w_i rho(x_i), a displacement dc and a small rotation dphi (model
//     axes) give dU = -k_E sum w_i grad rho(x_i) . (dc + dphi x (x_i - c))
//        = -k_E [ (sum w_i grad rho) . dc + (sum w_i (x_i - c) x grad rho) . dphi ].
// The seed prints the torque as w_i x grad rho; the lever arm is from the centre of mass, as here. World axes
// are parallel to model axes and dx_world = S dx_model (S = world_per_model), so what the hand feels is
//     F_world = (k_E / S) sum w_i grad rho,    Q_world = k_E sum w_i (x_i - c) x grad rho,
// which is the derivative of the same U by the tool's place and rotation: whatever path the hand takes, no
// energy is gained. As the weights sum to one, neither depends on how many points stand for the body.
//
// The grip keeps the vector from tool to centre of mass fixed in world axes and the rotation from tool to
// body fixed in tool axes. Then dc_world = dp_tool and dphi = the tool's rotation, so the wrench above, about
// the centre of mass, is exactly the wrench at the tool's origin; a grip with a lever would have to transfer
// the torque.
//
// Between two levels the wrenches are blended linearly. A blend is the derivative of the blended energies:
// still conservative while the knob stands still, and continuous when it turns.
#include "rt/force/docking/docking_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ipc/base/error.hpp"
#include "rt/force/docking/start_pose.hpp"

namespace tact {

namespace {

// Points between two looks at the clock: some 25 us here.
constexpr std::size_t kChunk = 2048;
// A level of so few points is computed whatever the deadline says: some 5 us.
constexpr std::size_t kAlways = 512;
// Where the level asked for is bigger, one of at most 1/kSafeShare of it is summed first, to fall back on.
constexpr std::size_t kSafeShare = 16;
constexpr int kCalibrationPoses = 128;
constexpr double kErrorMargin = 1.25;
constexpr double kToolRangeM = 10.0;  // a hand is never farther from the scene's centre

double checked_gain(const SceneMeta& meta, const DockingSettings& settings) {
    const bool scale_good = std::isfinite(meta.world_per_model) && meta.world_per_model > 0.0;
    const bool gain_good = std::isfinite(meta.energy_j_per_sigma) && meta.energy_j_per_sigma >= 0.0;
    if (!scale_good || !gain_good) {
        throw StartupError("setting up docking", "the scene's scale or gain is not finite and positive",
                           "bake the scene again");
    }
    const std::array<double, 3> given{settings.force_scale, settings.start_offset_m,
                                      settings.start_rotation_rad};
    for (const double v : given) {
        if (!std::isfinite(v)) {
            throw StartupError("setting up docking", "a start offset, rotation or force scale is not finite",
                               "give finite numbers");
        }
    }
    if (settings.force_scale < 0.0 || settings.force_scale > 100.0) {
        throw StartupError("setting up docking", "the force scale is not in [0, 100]",
                           "use 1, or a bit less");
    }
    return meta.energy_j_per_sigma * settings.force_scale;
}

StepResult out_of_range() {
    StepResult result;
    result.status = StepStatus::out_of_range;
    return result;
}

// 3 s^2 - 2 s^3: the force enters and leaves without a kink.
double ramp_gain(int ramp) {
    const double s = static_cast<double>(ramp) / DockingModel::kRampSteps;
    return s * s * (3.0 - 2.0 * s);
}

}  // namespace

DockingModel::DockingModel(const SceneMeta& meta, const DensityGrid& grid,
                           const std::vector<Structure>& structures, const std::vector<Codebook>& codebooks,
                           const DockingSettings& settings)
    : meta_(meta),
      energy_j_per_sigma_(checked_gain(meta, settings)),
      map_(grid, meta.map_background, meta.map_sigma) {
    if (structures.empty() || structures.size() > ModelBodies::kMax ||
        structures.size() != codebooks.size()) {
        throw StartupError("setting up docking",
                           "the scene has " + std::to_string(structures.size()) + " structures and " +
                               std::to_string(codebooks.size()) + " codebooks",
                           "bake a scene of 1 to " + std::to_string(ModelBodies::kMax) + " structures");
    }
    for (std::size_t i = 0; i < structures.size(); ++i) {
        if (!structures[i].home_com_model_m.allFinite()) {
            throw StartupError("setting up docking", "'" + structures[i].name + "' has no finite place",
                               "bake the scene again");
        }
        bodies_.T_model_body[i] = structures[i].home();
        add_body(structures[i], codebooks[i]);
    }
    bodies_.count = static_cast<std::uint32_t>(structures.size());
    bodies_home_ = bodies_;
    bodies_.T_model_body[0] =
        start_pose(structures[0].home(), settings.start_offset_m, settings.start_rotation_rad, settings.seed);
}

void DockingModel::add_body(const Structure& structure, const Codebook& codebook) {
    Body body;
    std::size_t before = 0;
    for (const Codebook::Level& level : codebook.levels) {
        if (level.size() <= before || level.size() >= structure.size()) {
            throw StartupError("reading the codebook of '" + structure.name + "'",
                               "its levels do not rise in size, or exceed the atoms", "bake the scene again");
        }
        before = level.size();
        body.levels.push_back({make_point_set(level.view(), structure.name), Duration{0}, 0.0});
    }
    const PointsView atoms{structure.x_m, structure.y_m, structure.z_m, structure.mass_fraction};
    body.levels.push_back({make_point_set(atoms, structure.name), Duration{0}, 0.0});
    if (body.levels.front().points.size() > kAlways) {
        throw StartupError(
            "reading the codebook of '" + structure.name + "'",
            "it has no level of at most " + std::to_string(kAlways) + " vectors, which must always fit",
            "bake the scene again");
    }
    calibrate(body, structure.home());
    parts_.push_back(std::move(body));
}

// The error of a level is the largest |F_level - F_atoms| over seeded poses: half within 15 A and 30 degrees
// of home, half anywhere in dense parts of the map, turned at random. It is an estimate of a bound, not a
// proof of one. The cost is the median of nine timed sums at home.
void DockingModel::calibrate(Body& body, const Pose& home) {
    const Level& atoms = body.levels.back();
    SeededRandom random(20261120);
    for (int k = 0; k < kCalibrationPoses; ++k) {
        Pose pose = home;
        if (k % 4 != 0) {
            pose = start_pose(home, 15e-10 * random.uniform(), 0.5236 * random.uniform(), random.next());
        } else {
            double best = -1e300;
            Vec3 gradient;
            for (int draw = 0; draw < 8; ++draw) {
                Vec3 p;
                for (int a = 0; a < 3; ++a) {
                    const double width =
                        map_.spacing_m()[a] * (map_.size()[static_cast<std::size_t>(a)] - 1.0);
                    p[a] = map_.origin_m()[a] + width * random.uniform();
                }
                const double density = map_.sample(p, gradient);
                if (density > best) best = density, pose.p_m = p;
            }
            pose.q = random.rotation();
        }
        const Vec3 exact = wrench(map_.sum(atoms.points.view(), pose)).force_n;
        for (Level& level : body.levels) {
            const Vec3 reduced = wrench(map_.sum(level.points.view(), pose)).force_n;
            level.error_n = std::max(level.error_n, kErrorMargin * (reduced - exact).norm());
        }
    }
    // Fewer vectors may do better by luck; the knob promises that errors do not rise with it.
    for (std::size_t l = body.levels.size() - 1; l-- > 0;) {
        body.levels[l].error_n = std::max(body.levels[l].error_n, body.levels[l + 1].error_n);
    }
    for (Level& level : body.levels) {
        std::array<Duration, 9> times{};
        DensitySums sums;
        for (Duration& time : times) {
            const Instant begin = Monotonic::now();
            if (!sum_level(level, home, Instant::max(), sums)) continue;
            time = Monotonic::now() - begin;
        }
        std::nth_element(times.begin(), times.begin() + 4, times.end());
        level.cost = times[4];
    }
}

KnobSpec DockingModel::knob() const noexcept {
    KnobSpec spec;
    spec.path = kKnobPath;
    spec.floor = 0.0F;
    // The first level of 200 vectors or more, as in the seed.
    const std::vector<Level>& levels = parts_[bodies_.active].levels;
    std::size_t start = 0;
    while (start + 1 < levels.size() && levels[start].points.size() < 200) ++start;
    spec.start = levels.size() > 1 ? static_cast<float>(start) / static_cast<float>(levels.size() - 1) : 1.0F;
    spec.slew_per_s = 4.0F;
    spec.haptic = true;
    return spec;
}

DockingModel::Plan DockingModel::plan(const Body& body, float fidelity) const noexcept {
    const double f = fidelity > 0.0F ? std::min(static_cast<double>(fidelity), 1.0) : 0.0;
    const std::size_t last = body.levels.size() - 1;
    const double place = f * static_cast<double>(last);
    const auto lower = std::min(static_cast<std::size_t>(place), last);
    const double blend = place - static_cast<double>(lower);
    return {lower, blend > 0.0 ? lower + 1 : lower, blend};
}

std::uint32_t DockingModel::items(float fidelity) const noexcept {
    const Body& body = parts_[bodies_.active];
    return static_cast<std::uint32_t>(body.levels[plan(body, fidelity).upper].points.size());
}

PathLoad DockingModel::predict(float fidelity) const noexcept {
    const Body& body = parts_[bodies_.active];
    const Plan p = plan(body, fidelity);
    const Level &lower = body.levels[p.lower], &upper = body.levels[p.upper];
    PathLoad load;
    load.cost_predicted = lower.cost + (p.upper != p.lower ? upper.cost : Duration{0});
    load.error = (1.0 - p.blend) * lower.error_n + p.blend * upper.error_n;
    load.items = static_cast<std::uint32_t>(upper.points.size());
    return load;
}

bool DockingModel::sum_level(const Level& level, const Pose& T_model_body, Instant deadline,
                             DensitySums& sums) const noexcept {
    sums = DensitySums{};
    const std::size_t n = level.points.size();
    for (std::size_t begin = 0; begin < n; begin += kChunk) {
        if (n > kAlways && deadline != Instant::max() && Monotonic::now() >= deadline) return false;
        const DensitySums part =
            map_.sum(level.points.view(begin, std::min(kChunk, n - begin)), T_model_body);
        sums.density_sigma += part.density_sigma;
        sums.gradient += part.gradient;
        sums.moment += part.moment;
    }
    return true;
}

Wrench DockingModel::wrench(const DensitySums& sums) const noexcept {
    return {energy_j_per_sigma_ / meta_.world_per_model * sums.gradient, energy_j_per_sigma_ * sums.moment};
}

StepResult DockingModel::evaluate(const Pose& T_model_body, const Budget& budget) const noexcept {
    const Instant begin = Monotonic::now();
    const Body& body = parts_[bodies_.active];
    if (!T_model_body.finite()) return out_of_range();
    StepResult result;
    result.load = predict(budget.fidelity);
    const Plan p = plan(body, budget.fidelity);
    const auto use = [&](std::size_t level, const DensitySums& sums) {
        result.wrench_world = wrench(sums);
        result.load.error = body.levels[level].error_n;
        result.load.items = static_cast<std::uint32_t>(body.levels[level].points.size());
    };
    DensitySums lower, upper;
    const std::size_t wanted = body.levels[p.lower].points.size();
    if (wanted > kAlways) {  // something to fall back on, small beside the whole
        std::size_t safe = 0;
        while (body.levels[safe + 1].points.size() <= std::min(kAlways, wanted / kSafeShare)) ++safe;
        if (sum_level(body.levels[safe], T_model_body, Instant::max(), lower)) use(safe, lower);
    }
    if (!sum_level(body.levels[p.lower], T_model_body, budget.deadline, lower)) {
        result.status = StepStatus::out_of_time;
    } else {
        use(p.lower, lower);
        if (p.upper != p.lower) {
            const bool late = budget.deadline != Instant::max() && Monotonic::now() >= budget.deadline;
            if (late || !sum_level(body.levels[p.upper], T_model_body, budget.deadline, upper)) {
                result.status = StepStatus::out_of_time;
            } else {
                const Wrench a = wrench(lower), b = wrench(upper);
                result.wrench_world.force_n = (1.0 - p.blend) * a.force_n + p.blend * b.force_n;
                result.wrench_world.torque_n_m = (1.0 - p.blend) * a.torque_n_m + p.blend * b.torque_n_m;
                const PathLoad promised = predict(budget.fidelity);
                result.load.error = promised.error;
                result.load.items = promised.items;
            }
        } else if (budget.deadline != Instant::max() && Monotonic::now() >= budget.deadline) {
            result.status = StepStatus::out_of_time;  // complete, but too late
        }
    }
    result.load.cost = Monotonic::now() - begin;
    return result;
}

void DockingModel::grip(const Pose& T_world_tool) noexcept {
    const Pose& body = bodies_.T_model_body[bodies_.active];
    com_from_tool_world_m_ = meta_.to_world(body.p_m) - T_world_tool.p_m;
    q_tool_body_ = (T_world_tool.q.conjugate() * body.q).normalized();
}

void DockingModel::reset(const ToolState& tool) noexcept {
    ramp_ = 0;
    clutched_ = true;  // a tool that is nowhere yet is gripped at the first good step
    if (!tool.T_world_tool.finite()) return;
    grip(tool.T_world_tool);
    clutched_ = (tool.buttons & 1U) != 0;
}

StepResult DockingModel::step(const ToolState& tool, const Budget& budget) noexcept {
    const Pose& hand = tool.T_world_tool;
    const double turn = hand.q.norm();
    if (!hand.finite() || hand.p_m.norm() > kToolRangeM || !(turn > 0.9 && turn < 1.1)) {
        ramp_ = 0;  // what follows is a new grip: the tool may be anywhere by then
        clutched_ = true;
        return out_of_range();
    }
    const bool clutch = (tool.buttons & 1U) != 0;
    if (clutched_ && !clutch) grip(hand);
    clutched_ = clutch;
    ramp_ = clutch ? std::max(ramp_ - 1, 0) : std::min(ramp_ + 1, kRampSteps);
    Pose& body = bodies_.T_model_body[bodies_.active];
    if (!clutch) {
        body.p_m = meta_.to_model(hand.p_m + com_from_tool_world_m_);
        body.q = (hand.q * q_tool_body_).normalized();
    }
    StepResult result = evaluate(body, budget);
    const double gain = ramp_gain(ramp_);
    result.wrench_world.force_n *= gain;
    result.wrench_world.torque_n_m *= gain;
    return result;
}

}  // namespace tact
