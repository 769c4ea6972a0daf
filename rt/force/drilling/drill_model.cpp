#include "rt/force/drilling/drill_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ipc/base/error.hpp"
#include "ipc/topics/event.hpp"
#include "rt/force/drilling/drill_publisher.hpp"

namespace tact {
namespace {

constexpr double kNoHandM = 1e3;  // no hand is there
// Smallest of the radius with which the stiffness is measured; larger where the level's are, since those make the force
// whose slope it is. With larger ones the slope of small blocks is off by up to 40 %.
constexpr double kBlockStiffness = 0.5 * kBlockMost;
BlockDetail stiffness_detail(const BlockDetail& d) noexcept {
    return {.block = std::max(d.block, kBlockStiffness), .rough = d.rough};
}
constexpr double kRoughUntil = 0.2;                      // level
constexpr float kLateLevel = -1.0F, kLevelJump = 0.03F;  // a knob's slew rate moves less in a step
constexpr double kUsualStep = 0.02;
constexpr double kContactKnownS = 0.25, kContactForgottenS = 10.0;

bool hand_is_there(const Pose& pose) noexcept {
    const double turn = pose.q.squaredNorm();
    return pose.finite() && pose.p_m.cwiseAbs().maxCoeff() < kNoHandM && turn > 0.25 && turn < 4.0;
}

void check_range(double value, double least, double most, const char* name) {
    if (std::isfinite(value) && value >= least && value <= most) return;
    throw StartupError("preparing the drill", std::string(name) + " is " + std::to_string(value),
                       "choose from " + std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

void check_drill_settings(const DrillSettings& s) {
    check_range(s.law.elastic_pa, 1e3, 1e8, "elastic_pa");
    check_range(s.law.friction_n_s_m3, 0.0, 1e6, "friction_n_s_m3");
    check_range(s.law.friction_share, 0.0, 10.0, "friction_share");
    check_range(s.depth_at_1_n_m, 0.0, 0.1, "depth_at_1_n_m");
    check_range(s.law.impact_n_s_m3, 0.0, 1e7, "impact_n_s_m3");
    check_range(s.burr_rad_s, 0.0, 1e5, "burr_rad_s");
    check_range(s.rate_per_s, 0.0, 1e4, "rate_per_s");
    check_range(s.rate_at_rad_s, 1.0, 1e5, "rate_at_rad_s");
    check_range(s.soft, 1.0, 20.0, "soft");
    check_range(s.force_n_max, 0.1, 100.0, "force_n_max");
    check_range(s.vibration, 0.0, 0.5, "vibration");
    check_range(s.diamond_share, 0.0, 1.0, "diamond_share");
}

DrillModel::DrillModel(const SceneMeta& meta, DrillBone& bone, const DrillSettings& settings)
    : DrillModel(meta, bone, settings, bone.add_tool()) {}

DrillModel::DrillModel(const SceneMeta& meta, DrillBone& bone, const DrillSettings& settings,
                       std::uint32_t hand)
    : meta_(meta),
      bone_(bone),
      pushing_bit_(hand),
      settings_((check_drill_settings(settings), settings)),
      started_(settings),
      spin_rad_s_(settings.burr_rad_s),
      tool_(make_drill_tool(settings.tool)),
      kernels_(best_brick_kernels()),
      erosion_(bone.octree, bone.density, bone.revision, settings.seed, &bone.strokes) {
    depths_.fill(-1.0);
    per_voxel_m_ = meta.world_per_model * bone.octree.bricks().voxel_m;
    if (!std::isfinite(per_voxel_m_) || !(per_voxel_m_ > 0.0))
        throw StartupError("preparing the drill", "the scene has no scale", "bake it anew");
    for (std::uint32_t i = 0; i < tool_.count; ++i) {
        if (tool_.ball[i].cuts || i == 0) head_radius_m_ = std::max(head_radius_m_, tool_.ball[i].radius_m);
    }
    turns_ = ErosionTurns(head_radius_m_ / per_voxel_m_);
    for (std::uint32_t i = 0; i < tool_.count; ++i) {
        const double radius_m = tool_.ball[i].radius_m;
        if (radius_m < kRadiusLeast * per_voxel_m_)
            throw StartupError(
                "preparing the drill",
                "a part of the tool has a radius of " + std::to_string(1e3 * radius_m) + " mm, below a voxel",
                "choose a larger burr and shaft, or bake smaller voxels");
        if (radius_m > kRadiusMost * per_voxel_m_)
            throw StartupError("preparing the drill", "the burr is larger than 200 voxels",
                               "choose a smaller one, or bake larger voxels");
        elastic_pa_[i] = settings.depth_at_1_n_m > 0.0 ? elastic_for(radius_m, settings.depth_at_1_n_m)
                                                       : settings.law.elastic_pa;
        const double full = elastic_pa_[i] * radius_m * radius_m;
        const double x = std::min(std::cbrt(std::pow(settings.force_n_max / full, 2.0)), 2.0);
        lever_m_ = std::max(lever_m_, tool_.ball[i].centre_tool_m.norm() + radius_m);
        if (radius_m == head_radius_m_)
            stiffness_n_m_ = std::max(stiffness_n_m_, 1.5 * elastic_pa_[i] * radius_m * std::sqrt(x));
    }
}

void DrillModel::drive(const ToolDrive& drive) noexcept {
    ForceModel::drive(drive);
    driven_ = drive;
    const double most = kSpinRadS2 * std::clamp(drive.step_s, 0.0, kStepSMost);
    spin_rad_s_ += std::clamp(settings_.burr_rad_s - spin_rad_s_, -most, most);
    turn_burr({.burr_rad_s = drive.on ? spin_rad_s_ : 0.0, .step_s = drive.step_s});
}

void DrillModel::turn_burr(const BurrDrive& drive) noexcept {
    const bool right = std::isfinite(drive.burr_rad_s) && drive.burr_rad_s >= 0.0 && drive.burr_rad_s < 1e6 &&
                       drive.step_s > 0.0 && std::isfinite(drive.step_s);
    drive_ = right ? drive : BurrDrive{};
    drive_.step_s = std::min(drive_.step_s, kStepSMost);
    usual_step_s_ *= drive_.step_s > usual_step_s_ ? 1.0 + kUsualStep : 1.0 - kUsualStep;
}

BlockDetail DrillModel::detail_of(float fidelity) noexcept {
    const double level =
        fidelity >= 0.0F ? std::min(static_cast<double>(fidelity), 1.0) : 0.0;  // NaN: the floor
    return {.block = kBlockCoarse * std::pow(kBlockFine / kBlockCoarse, level),
            .rough = std::max(1.0 - level / kRoughUntil, 0.0)};
}

KnobSpec DrillModel::knob() const noexcept {
    // 0.3 R: log(0.3 / 0.5) / log(0.1 / 0.5). A large head starts where it fits any budget.
    const float start = turns_.groups() > ErosionTurns::kGroupsLeast ? 0.0F : 0.3174F;
    return {.path = kKnobPath, .floor = 0.0F, .start = start, .slew_per_s = 4.0F, .haptic = true};
}

double DrillModel::rate_per_s() const noexcept {
    return cuts_ ? grit_share() * settings_.rate_per_s * drive_.burr_rad_s / settings_.rate_at_rad_s *
                       fade_.gain()
                 : 0.0;
}

DrillWork DrillModel::expected(float fidelity, double step_s) const noexcept {
    const BlockDetail detail = detail_of(fidelity);
    const auto asked = [&](const BlockDetail& d) { return d.asked(last_.look.depth) * last_.look.radius; };
    DrillWork work = expected_work(last_.work, last_.look, asked(detail));
    if (last_.still_look.block > 0.0)
        work.add(expected_work(last_.still, last_.still_look, asked(stiffness_detail(detail))));
    if (led_) {
        const std::uint32_t groups = turns_.groups_at(fidelity, step_s);
        const double share = static_cast<double>(groups) / turns_.groups();
        work.cut = share * turns_.bricks().computed;
        work.changed = share * turns_.bricks().changed;
        work.walked = turns_.walked() * turns_.passes_of(groups);
    }
    return work;
}

PathLoad DrillModel::predict(float fidelity) const noexcept {
    PathLoad load;
    const DrillWork work = expected(fidelity, usual_step_s_);
    load.items = work.items();
    load.cost_predicted = drill_cost(work, rehearsal_.speed());
    // A contact then shows what it costs in truth.
    if (contact_s_ < kContactKnownS) load.cost_foreseen = rehearsal_.contact_cost(fidelity);
    // A group waits for all steps between its cuts.
    const std::uint32_t groups = turns_.groups_at(fidelity, usual_step_s_);
    const double steps = static_cast<double>(turns_.groups()) / groups;
    const double pending = 0.5 * (steps - 1.0) * rate_per_s() * usual_step_s_;
    load.error = error_n(last_, detail_of(fidelity), pending);
    return load;
}

// Scaling down to force_n_max turns a vector's error e at scale s into sqrt(2) s e at most, and into no more than e.
double DrillModel::error_n(const BallForces& sum, const BlockDetail& detail, double pending) const noexcept {
    const double error = block_error_n(detail, sum.elastic_n, sum.shallow_n) + sum.voxel_error_n;
    const double scale = std::min(std::numbers::sqrt2 * sum.scale, 1.0);
    return std::min(scale * error, 2.0 * settings_.force_n_max) +
           std::min(sum.scale * sum.pending_n * pending, 2.0 * settings_.force_n_max);
}

void DrillModel::follow_contact(bool touches) noexcept {
    free_s_ = touches ? 0.0 : free_s_ + drive_.step_s;
    if (touches)
        contact_s_ += drive_.step_s;
    else if (free_s_ > kContactForgottenS)
        contact_s_ = 0.0;
}

void DrillModel::reset(const ToolState& tool) noexcept {
    asked_ = true;
    led_ = false;
    fade_.cut();
    forget_depths();
    ++grips_;
    if (hand_is_there(tool.T_world_tool))
        T_model_tool_ = {meta_.to_model(tool.T_world_tool.p_m), tool.T_world_tool.q.normalized()};
}

void DrillModel::forget_depths() noexcept {
    depths_.fill(-1.0);
    ways_out_.fill(Vec3::Zero());
}

ModelBodies DrillModel::bodies() const noexcept {
    ModelBodies list;
    list.count = 1;
    list.T_model_body[0] = T_model_tool_;
    list.id[0] = 1;
    list.grips = grips_;
    list.tools = tools_;
    return list;
}

void DrillModel::publish_to(DrillPublisher& publisher) {
    publisher_ = &publisher;
    publisher.attach();
}

void DrillModel::publish(const ModelCycle& cycle) noexcept {
    if (publisher_ != nullptr) publisher_->add(*this, cycle);
}

StepResult DrillModel::step(const ToolState& tool, const Budget& budget) noexcept {
    const Instant begin = Monotonic::now();
    StepResult result;
    const DrillWork planned = expected(budget.fidelity, drive_.step_s);
    result.load.cost_predicted = drill_cost(planned, rehearsal_.speed());
    last_ = {};
    fade_.begin_step(drive_.step_s);
    if (asked_) erosion_.begin();
    if (!hand_is_there(tool.T_world_tool)) {
        fade_.cut();
        led_ = cuts_ = false;
        depth_ = elastic_n_ = 0.0;
        result.status = StepStatus::out_of_range;
    } else if (asked_) {
        T_model_tool_ = {meta_.to_model(tool.T_world_tool.p_m), tool.T_world_tool.q.normalized()};
        double way_m = 0.0;
        for (std::uint32_t i = 0; i < tool_.count; ++i) {
            const Vec3 centre_world_m = tool.T_world_tool.p_m + T_model_tool_.q * tool_.ball[i].centre_tool_m;
            const Vec3 before = now_voxels_[i];
            now_voxels_[i] = bone_.octree.bricks().to_voxels(meta_.to_model(centre_world_m));
            if (led_ && tool_.ball[i].cuts)
                way_m = std::max(way_m, per_voxel_m_ * (now_voxels_[i] - before).norm());
        }
        if (led_ && way_m > std::max(kJumpRadii * head_radius_m_, kJumpM)) {
            led_ = false;
            ++jumps_;
        }
        const bool exchanging = bone_.strokes.exchanging(),
                   held = exchanging || burr_asked_ || (tool.buttons & 1U) != 0;
        if (exchanging) led_ = false;
        if (exchanged_ && !exchanging) forget_depths();
        exchanged_ = exchanging;
        if (held)
            fade_.fall();
        else
            fade_.rise();
        const bool hurried = budget.deadline.passed();
        const BlockDetail detail = detail_of(budget.fidelity);
        const double pending = turns_.pending();
        last_ = ball_forces(tool, detail, hurried, budget.deadline);
        BallForces& sum = last_;
        elastic_n_ = sum.elastic_n;
        Wrench wrench = sum.wrench;
        wrench.force_n += shaken_n(tool, sum.elastic_n);
        const double size_n = wrench.force_n.norm(),
                     scale = size_n > settings_.force_n_max ? settings_.force_n_max / size_n : 1.0;
        sum.scale = scale;
        const double gain = fade_.gain() * scale;
        const Wrench felt{gain * wrench.force_n, gain * wrench.torque_n_m};
        const double error = error_n(sum, sum.late ? kLate : detail, pending);
        // Other blocks give another force: not at once.
        const float level = sum.late ? kLateLevel : budget.fidelity;
        if (std::abs(level - level_) > kLevelJump)
            fade_.absorb(felt, error_before_n_ + error, head_radius_m_);
        level_ = level;
        error_before_n_ = error;
        result.wrench_world = fade_.show(felt);
        result.load.error = error + fade_.leaving_n(head_radius_m_);
        follow_contact(sum.elastic_n > 0.0);
        if (sum.elastic_n > 0.0 && !sum.late)
            measure_stiffness(tool.T_world_tool, stiffness_detail(detail));
        else if (!(sum.elastic_n > 0.0))
            measured_.reset();

        cuts_ = !held && drive_.burr_rad_s > 0.0;
        bool late = sum.late || budget.deadline.passed();
        std::uint32_t groups_left = 0;
        if (!led_) {
            turns_.forget(now_voxels_);
            led_ = true;
        } else {
            const double rate = rate_per_s();
            turns_.expose(rate * drive_.step_s, rate * kStepSMost);
            const std::uint32_t groups = turns_.groups_at(budget.fidelity, drive_.step_s);
            if (late && turns_.pending() > 0.0) {
                groups_left = groups;
                ++postponed_;
            } else {
                const ErosionTurns::Done done = turns_.cut(erosion_, {.kernels = &kernels_,
                                                                      .tool = &tool_,
                                                                      .now_voxels = &now_voxels_,
                                                                      .per_voxel_m = per_voxel_m_,
                                                                      .soft = settings_.soft,
                                                                      .groups = groups,
                                                                      .deadline = &budget.deadline});
                if (done.cut < done.wanted) {
                    late = true;
                    groups_left = done.wanted - done.cut;
                    ++postponed_;
                }
            }
        }
        if (late) result.status = StepStatus::out_of_time;
        last_.work.cut = erosion_.pass().visited;
        last_.work.changed = erosion_.pass().bricks;
        last_.work.walked = erosion_.pass().walked;
        const DrillWork all = work();
        result.load.items = all.items();
        // A whole step is compared with the work that it did: what was not foreseen of it is no interrupt.
        if (!late) result.load.cost_predicted = drill_cost(all, rehearsal_.speed());
        if (late) {
            DrillWork left;
            left.changed = std::max(turns_.bricks().changed / turns_.groups(), 1.0) * groups_left;
            DrillWork whole = all;
            whole.add(left);
            const Duration done = drill_cost(all, rehearsal_.speed()),
                           most = std::max(drill_cost(whole, rehearsal_.speed()),
                                           drill_cost(planned, rehearsal_.speed()));
            result.load.work_done = static_cast<float>(std::clamp(to_s(done) / to_s(most), 0.01, 1.0));
        }
    }
    bone_.pushing = fade_.gain() > 0.0 ? bone_.pushing | pushing_bit_ : bone_.pushing & ~pushing_bit_;
    if (settings_.tool.cuts) {
        if (bone_.strokes.exchanging() && bone_.pushing == 0) bone_.exchange();
        bone_.strokes.step(drive_.step_s, erosion_.pass().removed > 0);
    }
    if (drive_.burr_rad_s > 0.0) result.trace_flags |= kTraceBurrTurns;
    if (erosion_.pass().removed > 0) result.trace_flags |= kTraceCuts;
    if (last_.held_in) result.trace_flags |= kTraceHeldIn;
    result.load.cost = std::max(Monotonic::now() - begin, Duration(1));
    return result;
}

}  // namespace tact
