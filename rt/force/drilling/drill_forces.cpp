// Forces of the tool's balls in one step, their stiffness, and the vibration of the burr.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt/force/drilling/drill_model.hpp"

namespace tact {
namespace {

// Half of the way over which it is measured, in radii of the head, and at least in voxels: below that a force shows the steps of its voxels.
constexpr double kStiffnessReach = 0.05, kStiffnessReachVoxels = 0.25;

}  // namespace

DrillModel::BallForces DrillModel::ball_forces(const ToolState& tool, const BlockDetail& detail, bool hurried,
                                               const Deadline& deadline) noexcept {
    BallForces sum;
    sum.late = hurried;
    depth_ = 0.0;
    head_ = {};
    const Quat q = tool.T_world_tool.q.normalized();
    const Twist& twist = tool.twist_world;
    const bool known = twist.linear_m_s.allFinite() && twist.angular_rad_s.allFinite();
    const Vec3 axis = q * Vec3::UnitZ();
    BurrLaw law = settings_.law;
    std::uint32_t most_blocks = 0;
    const double volume = per_voxel_m_ * per_voxel_m_ * per_voxel_m_ / 255.0;
    for (std::uint32_t i = 0; i < tool_.count; ++i) {
        const ToolBall& ball = tool_.ball[i];
        if (!sum.late && i > 0) sum.late = deadline.passed();
        const double radius = ball.radius_m / per_voxel_m_;
        // No first look for a rough one.
        const bool unknown = depths_[i] < 0.0 && detail.rough > 0.0;
        const double depth = sum.late || unknown ? 1.0 : depths_[i],
                     used = (sum.late ? kLate : detail).asked(depth) * radius;
        const BallMoments m = ball_moments(bone_.octree, kernels_, now_voxels_[i], radius, used, depth);
        sum.work.add(m);
        depths_[i] = 0.0;
        const double full_n = ball.weight * elastic_pa_[i] * ball.radius_m * ball.radius_m;
        if (!(m.m0 > 0.0)) {
            ways_out_[i].setZero();
            // Beside bone, a cap thinner than a voxel may be missed.
            if (m.bricks > 0) sum.voxel_error_n += voxel_error_n(full_n, 0.0, per_voxel_m_ / ball.radius_m);
            continue;
        }
        const Vec3 arm_m = q * ball.centre_tool_m;
        const Vec3 velocity_m_s =
            known ? Vec3(twist.linear_m_s + twist.angular_rad_s.cross(arm_m)) : Vec3(Vec3::Zero());
        const Vec3 spin_rad_s = ball.cuts ? Vec3(drive_.burr_rad_s * axis) : Vec3(Vec3::Zero());
        law.elastic_pa = elastic_pa_[i];
        const BurrForce f = burr_force(law, ball.radius_m, volume * m.m0, volume * per_voxel_m_ * m.m1,
                                       velocity_m_s, spin_rad_s, ways_out_[i]);
        depths_[i] = f.depth;
        sum.held_in = sum.held_in || f.held_in;
        if (f.depth < kWayOutFrom) ways_out_[i] = f.normal;
        if (m.blocks > most_blocks) {
            most_blocks = m.blocks;
            // As if it had been asked for at this depth.
            const double part = depth_part(depth < 0.0 ? f.depth : depth);
            sum.look = {radius, f.depth, used * part / depth_part(f.depth),
                        m.mixed / std::max(m.surface, 1U)};
        }
        if (ball.cuts)
            sum.pending_n += ball.weight * ball.weight *
                             pending_error_n(law, ball.radius_m, settings_.soft, f, volume * m.m0,
                                             volume * per_voxel_m_ * m.m1.norm(), velocity_m_s.norm());
        const Vec3 force_n = ball.weight * f.wrench.force_n;
        sum.wrench.force_n += force_n;
        sum.wrench.torque_n_m += ball.weight * f.wrench.torque_n_m + arm_m.cross(force_n);
        const double elastic_n = full_n * f.depth * std::sqrt(f.depth);
        sum.elastic_n += elastic_n;
        sum.shallow_n += shallow_share(f.depth) * elastic_n;
        sum.voxel_error_n += voxel_error_n(full_n, f.depth, per_voxel_m_ / ball.radius_m);
        if ((ball.cuts || i == 0) && f.depth > depth_) {
            depth_ = f.depth;
            head_ = f;
        }
    }
    return sum;
}

Wrench DrillModel::still_wrench(const Pose& T_world_tool, const BlockDetail& detail,
                                DrillWork& work) const noexcept {
    Wrench sum;
    const Quat q = T_world_tool.q.normalized();
    const Vec3 spin_rad_s = drive_.burr_rad_s * (q * Vec3::UnitZ());
    const double volume = per_voxel_m_ * per_voxel_m_ * per_voxel_m_ / 255.0;
    BurrLaw law = settings_.law;
    for (std::uint32_t i = 0; i < tool_.count; ++i) {
        const ToolBall& ball = tool_.ball[i];
        const double radius = ball.radius_m / per_voxel_m_;
        const Vec3 arm_m = q * ball.centre_tool_m;
        const Vec3 centre = bone_.octree.bricks().to_voxels(meta_.to_model(T_world_tool.p_m + arm_m));
        const BallMoments m = ball_moments(bone_.octree, kernels_, centre, radius,
                                           detail.asked(depths_[i]) * radius, depths_[i]);
        work.add(m);
        if (!(m.m0 > 0.0)) continue;
        law.elastic_pa = elastic_pa_[i];
        const BurrForce f =
            burr_force(law, ball.radius_m, volume * m.m0, volume * per_voxel_m_ * m.m1, Vec3::Zero(),
                       ball.cuts ? spin_rad_s : Vec3(Vec3::Zero()), ways_out_[i]);
        const Vec3 force_n = ball.weight * f.wrench.force_n;
        sum.force_n += force_n;
        sum.torque_n_m += ball.weight * f.wrench.torque_n_m + arm_m.cross(force_n);
    }
    const double size_n = sum.force_n.norm();
    if (size_n > settings_.force_n_max) {
        sum.force_n *= settings_.force_n_max / size_n;
        sum.torque_n_m *= settings_.force_n_max / size_n;
    }
    return sum;
}

void DrillModel::measure_stiffness(const Pose& T_world_tool, const BlockDetail& detail) noexcept {
    const double h_m = std::max(kStiffnessReach * head_radius_m_, kStiffnessReachVoxels * per_voxel_m_);
    const BallLook& look = last_.look;
    last_.still_look = {look.radius, look.depth, detail.asked(look.depth) * look.radius, look.mixed};
    const Pose at = measured_.next(T_world_tool, h_m, lever_m_);
    measured_.note(still_wrench(at, detail, last_.still), h_m, lever_m_);
}

// Across the shaft, turning with the burr; never faster than a tenth of the servo's rate, which a hand still feels as
// a rattle and no sampling turns into something else.
Vec3 DrillModel::shaken_n(const ToolState& tool, double elastic_n) noexcept {
    if (!(settings_.vibration > 0.0) || !(drive_.burr_rad_s > 0.0)) return Vec3::Zero();
    const double turn_rad = std::min(drive_.burr_rad_s * drive_.step_s, 0.2 * std::numbers::pi);
    phase_rad_ = std::fmod(phase_rad_ + turn_rad, 2.0 * std::numbers::pi);
    return grit_share() * settings_.vibration * std::min(elastic_n, settings_.force_n_max) *
           (tool.T_world_tool.q.normalized() * Vec3(std::cos(phase_rad_), std::sin(phase_rad_), 0.0));
}

}  // namespace tact
