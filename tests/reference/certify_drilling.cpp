// Burr and shaft at the default configuration. Random poses put the head at bone's surface; paths lead it along 40 mm/s
// over it. Each pose is judged at one of five levels. A last part lets the burr run and compares what it removes.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/topics/event.hpp"
#include "rt/start/start_drill.hpp"
#include "tests/reference/certify.hpp"
#include "tests/reference/drilling_reference.hpp"

namespace tact {
namespace {

namespace ref = reference;

constexpr double kStepS = 1e-3, kSpeedMS = 0.04;
constexpr int kPathSteps = 250;  // of a path
constexpr int kSettleSteps = 6;  // the size of blocks follows the depth of the step before
constexpr int kSlopeSteps =
    226;  // the stiffness is measured axis by axis, after a jump of the level has faded
constexpr int kFlushSteps = 64;           // longer than any group of bricks waits
constexpr double kRemovedLeast = 5000.0;  // levels; a path beside the bone removes less
constexpr double kRoundingN = 2e-3;       // a sliver of a voxel in the ball; not felt

// Densities by a formula of its own: bricks of 8^3, x fastest in brick and volume.
ref::Volume volume_of(const DrillBone& bone, double world_per_model) {
    const BoneBricks& b = bone.octree.bricks();
    ref::Volume v;
    for (std::size_t a = 0; a < 3; ++a) v.size[a] = b.size[a];
    v.voxel_m = world_per_model * b.voxel_m;
    const std::int64_t nx = (v.size[0] + 7) / 8, ny = (v.size[1] + 7) / 8;
    v.level = [density = bone.density, nx, ny](std::int64_t x, std::int64_t y, std::int64_t z) {
        const std::int64_t brick = (z / 8 * ny + y / 8) * nx + x / 8;
        return static_cast<double>(
            density[static_cast<std::size_t>(512 * brick + (z % 8 * 8 + y % 8) * 8 + x % 8)]);
    };
    return v;
}

class DrillCertifier {
public:
    DrillCertifier(const SceneFile& scene, const CertifySettings& settings, ref::Promises& promises)
        : settings_(settings),
          meta_(read_meta(scene)),
          bone_(scene),
          drill_(drill_settings(bone_.bone())),
          model_(meta_, bone_.bone(), drill_),
          volume_(volume_of(bone_.bone(), meta_.world_per_model)),
          random_(settings.seed),
          force_(promises.emplace_back(
              "drilling.force",
              "force differs from eqs 1, 2, 3, 13, 14 by no more than the published error")),
          torque_(promises.emplace_back("drilling.torque",
                                        "the same about the tool's origin, at the lever of its parts")),
          held_in_(promises.emplace_back(
              "drilling.held_in",
              "where bone is on all sides, the push is no larger than that of eq. 3, and is marked")),
          stiffness_(promises.emplace_back("drilling.stiffness",
                                           "slope of the reference force about a tool at rest, within 10 % "
                                           "of the stated stiffness, where no "
                                           "place of the slope is marked as held in")),
          shown_stiffness_(promises.emplace_back("drilling.shown_stiffness",
                                                 "slope of the shown force about a tool at rest, within 10 % "
                                                 "of the stated stiffness, everywhere")),
          mass_(promises.emplace_back("drilling.mass",
                                      "removed levels are those missing in the voxels, to the level")),
          erosion_(promises.emplace_back("drilling.erosion",
                                         "removed volume of a path is that of eq. 12 within 2 %")) {
        // Grid axes are parallel to the world's; the reference works in the world.
        volume_.origin_m = meta_.to_world(bone_.bone().octree.bricks().origin_m);
        for (std::int64_t z = 0; z < volume_.size[2]; ++z)
            for (std::int64_t y = 0; y < volume_.size[1]; ++y)
                for (std::int64_t x = 0; x < volume_.size[0]; ++x) {
                    if (volume_.bone(x, y, z) < 0.5) continue;
                    const double free = std::min({volume_.bone(x - 1, y, z), volume_.bone(x + 1, y, z),
                                                  volume_.bone(x, y - 1, z), volume_.bone(x, y + 1, z),
                                                  volume_.bone(x, y, z - 1), volume_.bone(x, y, z + 1)});
                    if (free < 0.25 && random_.uniform() < keep_) surface_m_.push_back(place_m(x, y, z));
                    if (surface_m_.size() > kSurfaceMost) thin_out();
                }
        if (surface_m_.empty())
            throw StartupError("certifying '" + scene.name() + "'", "the volume has no surface of bone",
                               "choose a scan with bone in it");
    }

    void run() {
        const std::uint64_t random = settings_.poses / 2, paths = (settings_.poses - random) / kPathSteps + 1;
        double done = 0.0;
        const double all = static_cast<double>(random + 2 * paths * kPathSteps);
        for (std::uint64_t i = 0; i < random; ++i, ++done) {
            if (i % 64 == 0) report(settings_.progress, done / all, "random poses");
            const float level = random_level();
            tool_.T_world_tool = near_surface();
            tool_.twist_world = {0.05 * random_.direction(), Vec3::Zero()};
            model_.turn_burr({.burr_rad_s = 0.0, .step_s = kStepS});
            if (i == 0) begin();
            for (int k = 1; k < kSettleSteps; ++k) static_cast<void>(step(level));
            judge(level, i % 16 == 0);
        }
        for (std::uint64_t p = 0; p < paths; ++p, done += 2 * kPathSteps) {
            report(settings_.progress, done / all, "paths");
            path(false);
            path(true);
        }
    }

private:
    static constexpr std::size_t kSurfaceMost = 200'000;

    static DrillSettings drill_settings(const DrillBone& bone) {
        DrillSettings s = burr_settings(RtConfig{}, 1);
        s.vibration = 0.0;
        const double least_m = kRadiusLeast * 1.000001 * bone.octree.bricks().voxel_m;
        s.tool.shaft_radius_m = std::max(s.tool.shaft_radius_m, least_m);
        s.tool.radius_m = std::max(s.tool.radius_m, s.tool.shaft_radius_m);
        return s;
    }
    void thin_out() {
        for (std::size_t i = 0; i < surface_m_.size() / 2; ++i) surface_m_[i] = surface_m_[2 * i];
        surface_m_.resize(surface_m_.size() / 2);
        keep_ *= 0.5;
    }
    [[nodiscard]] Vec3 place_m(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return volume_.origin_m +
               volume_.voxel_m * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    }
    [[nodiscard]] float random_level() { return 0.25F * static_cast<float>(random_.below(5)); }
    [[nodiscard]] Pose near_surface() {
        const double radius_m = drill_.tool.radius_m;
        return {surface_m_[random_.below(surface_m_.size())] + 1.1 * radius_m * random_.direction(),
                random_.rotation()};
    }
    void begin() {
        model_.reset(tool_);
        for (int k = 0; k < ForceFade::ramp_steps(kStepS) + 1; ++k) static_cast<void>(step(0.0F));
    }
    [[nodiscard]] StepResult step(float level) {
        Budget budget;
        budget.fidelity = level;
        return model_.step(tool_, budget);
    }

    struct Levels {
        double start, now;
    };
    struct Sum {
        Vec3 force_n = Vec3::Zero(), torque_n_m = Vec3::Zero();
        double elastic_n = 0.0;
        double lever_m = 0.0;  // farthest place of the touching parts from the tool's origin

        // Scaling to the largest force: its own error acts on the torque of balls that push against each other.
        double torque_share = 1.0;
        bool limited = false;
    };
    // A thin cap falls between the points of a voxel unless there are more of them.
    [[nodiscard]] ref::Moments moments(const Vec3& centre_m, double radius_m) const {
        ref::Moments m = ref::moments_in_ball(volume_, centre_m, radius_m);
        for (const auto& [depth, parts] : {std::pair{0.15, 16}, std::pair{0.02, 48}})
            if (ref::penetration(m.m0_m3, radius_m) < depth)
                m = ref::moments_in_ball(volume_, centre_m, radius_m, parts);
        return m;
    }
    [[nodiscard]] Sum wanted(const Pose& pose, double burr_rad_s) const {
        Sum sum;
        sum.lever_m = drill_.tool.radius_m;
        double parts_n = 0.0;
        const DrillTool& tool = model_.tool();
        for (std::uint32_t i = 0; i < tool.count; ++i) {
            const ToolBall& ball = tool.ball[i];
            const Vec3 arm_m = pose.q * ball.centre_tool_m;
            ref::Law law{.friction_n_s_m3 = drill_.law.friction_n_s_m3,
                         .impact_n_s_m3 = drill_.law.impact_n_s_m3,
                         .friction_share = drill_.law.friction_share};
            // Flat bone holds each ball with 1 N at this depth, or at half its radius.
            const double depth = std::min(drill_.depth_at_1_n_m / ball.radius_m, 0.5);
            law.elastic_pa = 1.0 / (ball.radius_m * ball.radius_m * std::pow(depth, 1.5));
            const ref::BurrWrench w = ref::burr_wrench(
                law, ball.radius_m, moments(pose.p_m + arm_m, ball.radius_m),
                tool_.twist_world.linear_m_s + tool_.twist_world.angular_rad_s.cross(arm_m),
                ball.cuts ? Vec3(burr_rad_s * (pose.q * Vec3::UnitZ())) : Vec3(Vec3::Zero()));
            sum.force_n += ball.weight * w.force_n;
            parts_n += ball.weight * w.force_n.norm();
            sum.torque_n_m += ball.weight * (w.torque_n_m + arm_m.cross(w.force_n));
            sum.elastic_n += ball.weight * w.elastic_n;
            if (w.elastic_n > 0.0) sum.lever_m = std::max(sum.lever_m, arm_m.norm() + ball.radius_m);
        }
        const double size_n = sum.force_n.norm();
        sum.limited = size_n > drill_.force_n_max;
        if (sum.limited) {
            sum.torque_share = 1.0 + parts_n / size_n;
            sum.force_n *= drill_.force_n_max / size_n;
            sum.torque_n_m *= drill_.force_n_max / size_n;
        }
        return sum;
    }
    void judge(float level, bool slope) {
        const double burr_rad_s = model_.burr_rad_s();
        const Sum right = wanted(tool_.T_world_tool, burr_rad_s);
        const StepResult r = step(level);
        const double allowed_n = r.load.error + kRoundingN;
        if ((r.trace_flags & kTraceHeldIn) != 0) {
            note(held_in_, r.wrench_world.force_n.norm(),
                 right.elastic_n * (1.0 + drill_.law.friction_share) + allowed_n +
                     6.0 * drill_.law.impact_n_s_m3 * drill_.tool.radius_m * drill_.tool.radius_m *
                         tool_.twist_world.linear_m_s.norm());
        } else {
            note(force_, (r.wrench_world.force_n - right.force_n).norm(), allowed_n);
            note(torque_, (r.wrench_world.torque_n_m - right.torque_n_m).norm(),
                 right.torque_share * right.lever_m * allowed_n);
        }
        if (slope && !right.limited && (r.trace_flags & kTraceHeldIn) == 0) stiff(level);
    }
    // Central differences of the reference, and of what the model shows, without the burr's friction. Where bone is on all sides the
    // model shows another push than the reference, so the slope of one says nothing about the other.
    // The model measures axis by axis, so the tool rests first.
    void stiff(float level) {
        const Twist twist = tool_.twist_world;
        const Pose rest = tool_.T_world_tool;
        tool_.twist_world = {};
        for (int k = 0; k < kSlopeSteps; ++k) static_cast<void>(step(level));
        const double h = std::max(0.05 * drill_.tool.radius_m, 0.25 * volume_.voxel_m);
        const double allowed_n_m = 1.1 * model_.stiffness().force_n_m;
        Eigen::Matrix3d slope = Eigen::Matrix3d::Zero(), shown = slope;
        bool held_in = false;
        for (int a = 0; a < 3; ++a) {
            for (const double way : {h, -h}) {
                tool_.T_world_tool = rest;
                tool_.T_world_tool.p_m[a] += way;
                slope.col(a) += wanted(tool_.T_world_tool, 0.0).force_n / (2.0 * way);
                StepResult r;
                for (int k = 0; k < kSettleSteps; ++k) r = step(level);
                shown.col(a) += r.wrench_world.force_n / (2.0 * way);
                held_in = held_in || (r.trace_flags & kTraceHeldIn) != 0;
            }
        }
        tool_.T_world_tool = rest;
        tool_.twist_world = twist;
        if (!held_in) note(stiffness_, slope.operatorNorm(), allowed_n_m);
        note(shown_stiffness_, shown.operatorNorm(), allowed_n_m);
    }
    void note(ref::Promise& promise, double measured, double allowed) {
        if (!promise.check(measured, allowed)) return;
        const Pose& at = tool_.T_world_tool;
        char text[160];
        std::snprintf(text, sizeof text, "(%.6f, %.6f, %.6f) m, depth %.2f R: %.4g, allowed %.4g", at.p_m.x(),
                      at.p_m.y(), at.p_m.z(), model_.depth(), measured, allowed);
        promise.worst_at = text;
    }

    // Leads the burr from a place at the surface along a smooth curve; running, it removes bone.
    void path(bool runs) {
        const float level = runs ? 1.0F : random_level();
        Pose pose = near_surface();
        Vec3 way = random_.direction();
        tool_ = {};
        tool_.T_world_tool = pose;
        model_.turn_burr({.burr_rad_s = 0.0, .step_s = kStepS});
        begin();
        const std::uint64_t removed_before = model_.removed_levels(), mass_before = runs ? mass() : 0;
        for (int i = 0; i < kPathSteps; ++i) {
            way = (way + 0.1 * random_.direction()).normalized();
            const Vec3 before = pose.p_m;
            pose.p_m += kSpeedMS * kStepS * way;
            tool_.T_world_tool = pose;
            tool_.twist_world = {kSpeedMS * way, Vec3::Zero()};
            if (runs) erode(before, pose);
            model_.turn_burr({.burr_rad_s = runs ? drill_.burr_rad_s : 0.0, .step_s = kStepS});
            judge(level, !runs && i % 16 == 0);
        }
        if (!runs) return;
        model_.turn_burr({.burr_rad_s = 0.0, .step_s = kStepS});
        for (int i = 0; i < kFlushSteps; ++i) static_cast<void>(step(level));  // cuts what still waits
        const std::uint64_t removed = model_.removed_levels() - removed_before;
        note(mass_, std::abs(static_cast<double>(mass_before) - static_cast<double>(mass() + removed)), 0.5);
        double by_equation = 0.0, found = 0.0;
        for (const auto& [voxel, levels] : levels_) {
            by_equation += levels.start - levels.now;
            found += levels.start - level_at(voxel);
        }
        levels_.clear();
        if (by_equation > kRemovedLeast) note(erosion_, std::abs(found - by_equation), 0.02 * by_equation);
    }
    // Eq. 12 in small parts of a step's way.
    void erode(const Vec3& from_m, const Pose& to) {
        constexpr int kParts = 4;
        const double a_per_s = drill_.rate_per_s * drill_.burr_rad_s / drill_.rate_at_rad_s;
        for (std::uint32_t i = 0; i < model_.tool().count; ++i) {
            const ToolBall& ball = model_.tool().ball[i];
            if (!ball.cuts) continue;
            for (int part = 0; part < kParts; ++part) {
                const Vec3 centre = (from_m + (part + 0.5) / kParts * (to.p_m - from_m) +
                                     to.q * ball.centre_tool_m - volume_.origin_m) /
                                    volume_.voxel_m;
                erode_ball(centre, ball.radius_m / volume_.voxel_m, ball.weight * a_per_s * kStepS / kParts);
            }
        }
    }
    void erode_ball(const Vec3& centre, double radius, double exposure) {
        std::array<std::int64_t, 3> low{}, high{};
        for (std::size_t a = 0; a < 3; ++a) {
            const double c = centre[static_cast<int>(a)];
            low[a] = std::max<std::int64_t>(static_cast<std::int64_t>(std::floor(c - radius)), 0);
            high[a] =
                std::min<std::int64_t>(static_cast<std::int64_t>(std::ceil(c + radius)), volume_.size[a] - 1);
        }
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
            for (std::int64_t y = low[1]; y <= high[1]; ++y)
                for (std::int64_t x = low[0]; x <= high[0]; ++x) {
                    const double r2 =
                        (Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) -
                         centre)
                            .squaredNorm() /
                        (radius * radius);
                    if (r2 >= 1.0) continue;
                    const std::int64_t voxel = (z * volume_.size[1] + y) * volume_.size[0] + x;
                    auto found = levels_.find(voxel);
                    if (found == levels_.end()) {
                        const double level = level_at(voxel);
                        if (level == 0.0) continue;
                        found = levels_.emplace(voxel, Levels{level, level}).first;
                    }
                    double& now = found->second.now;
                    const double softness = drill_.soft + (1.0 - drill_.soft) * now / 255.0;
                    now *= std::exp(-exposure * softness * (1.0 - r2));
                }
    }
    [[nodiscard]] double level_at(std::int64_t voxel) const {
        const std::int64_t x = voxel % volume_.size[0], y = voxel / volume_.size[0] % volume_.size[1],
                           z = voxel / volume_.size[0] / volume_.size[1];
        return volume_.level(x, y, z);
    }
    [[nodiscard]] std::uint64_t mass() const {
        std::uint64_t sum = 0;
        for (const std::uint8_t v : bone_.bone().density) sum += v;
        return sum;
    }

    const CertifySettings& settings_;
    SceneMeta meta_;
    mutable SceneBone bone_;
    DrillSettings drill_;
    DrillModel model_;
    ref::Volume volume_;
    SeededRandom random_;
    ref::Promise &force_, &torque_, &held_in_, &stiffness_, &shown_stiffness_, &mass_, &erosion_;
    std::vector<Vec3> surface_m_;
    double keep_ = 1.0;
    ToolState tool_;
    std::unordered_map<std::int64_t, Levels> levels_;  // of the voxels that the running burr has met
};

}  // namespace

void certify_drilling(const SceneFile& scene, const CertifySettings& settings, ref::Promises& promises) {
    DrillCertifier(scene, settings, promises).run();
}

}  // namespace tact
