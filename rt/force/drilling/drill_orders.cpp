// Orders to the tool: strokes undone and redone, another burr in the hand, its drives.
#include <algorithm>
#include <cmath>
#include <typeinfo>

#include "ipc/topics/drill.hpp"
#include "rt/force/drilling/drill_model.hpp"
#include "rt/force/drilling/drill_publisher.hpp"

namespace tact {

bool fit_to_voxels(DrillSettings& s, const SceneMeta& meta, const BoneBricks& bricks) {
    const double least_m = kRadiusLeast * (1.0 + 1e-9) * meta.world_per_model * bricks.voxel_m;
    if (!(s.tool.shaft_radius_m > 0.0) || s.tool.shaft_radius_m >= least_m) return false;
    if (!s.tool.cuts) s.tool.radius_m = least_m;
    if (least_m > s.tool.radius_m) return false;
    s.tool.shaft_radius_m = least_m;
    return true;
}

bool DrillModel::order(const ModelOrder& order) noexcept {
    if (order.kind != ModelOrder::Kind::setting || !settings_.tool.cuts) return false;
    const auto command = static_cast<CommandKind>(order.command);
    switch (command) {
        case CommandKind::undo_stroke:
            return bone_.strokes.undo();
        case CommandKind::redo_stroke:
            return bone_.strokes.redo();
        case CommandKind::set_burr:
            return ask_for_burr(order);
        default:
            return set_drive(command, order.value);
    }
}

bool DrillModel::set_drive(CommandKind kind, double value) noexcept {
    const auto within = [value](double most) { return value >= 0.0 && value <= most; };
    if (kind == CommandKind::set_burr_speed && within(kBurrRadSMost)) {
        settings_.burr_rad_s = value;
        return true;
    }
    if (publisher_ == nullptr) return false;
    if (kind == CommandKind::set_irrigation && within(kIrrigationM3SMost)) {
        publisher_->rates().irrigation_m3_s = value;
        return true;
    }
    if (kind == CommandKind::set_suction && within(kSuctionM3SMost)) {
        publisher_->rates().suction_m3_s = value;
        return true;
    }
    return false;
}

bool DrillModel::ask_for_burr(const ModelOrder& order) noexcept {
    const std::uint32_t shape = order.body & 0xFFU, grit = order.body >> 8U;
    const double diameter_m = order.value, length_m = order.T_model_body.p_m.x();
    if (burr_asked_ || shape > static_cast<std::uint32_t>(BurrShape::cone) ||
        grit > static_cast<std::uint32_t>(BurrGrit::diamond) ||
        !(diameter_m >= kBurrDiameterLeastM && diameter_m <= kBurrDiameterMostM))
        return false;
    const double voxels = 0.5 * diameter_m / per_voxel_m_;
    if (voxels < kRadiusLeast || voxels > kRadiusMost) return false;
    const bool ball = static_cast<BurrShape>(shape) == BurrShape::sphere;
    if (!ball && !(length_m >= diameter_m && length_m <= kBurrLengthMostM)) return false;
    burr_ = {.shape = static_cast<BurrShape>(shape),
             .grit = static_cast<BurrGrit>(grit),
             .radius_m = 0.5 * diameter_m,
             .length_m = ball ? diameter_m : length_m};
    burr_asked_ = true;
    return true;
}

std::unique_ptr<ForceModel> DrillModel::rebuild(const ModelBodies& /*bodies*/) const {
    DrillSettings s = started_;
    s.grit = burr_.grit;
    s.tool.shape = burr_.shape;
    s.tool.radius_m = burr_.radius_m;
    s.tool.length_m = burr_.length_m;
    s.tool.tip_radius_m = std::min(started_.tool.tip_radius_m, burr_.radius_m);
    s.tool.shaft_radius_m = std::min(started_.tool.shaft_radius_m, kNeckShare * burr_.radius_m);
    const DrillToolSettings& first = started_.tool;
    const double head_m = s.tool.radius_m + s.tool.length_m;
    const double beyond_m = std::max(first.shaft_length_m - first.radius_m - first.length_m, 0.0);
    static_cast<void>(fit_to_voxels(s, meta_, bone_.octree.bricks()));
    if (s.tool.shaft_radius_m < kRadiusLeast * per_voxel_m_) s.tool.shaft_radius_m = 0.0;
    s.tool.shaft_length_m = head_m + std::min(beyond_m, 2.0 * kShaftBallsMost * s.tool.shaft_radius_m);
    std::unique_ptr<DrillModel> made(new DrillModel(meta_, bone_, s, pushing_bit_));
    if (rehearsal_.step_s > 0.0) made->foresee(rehearse_drill(s, per_voxel_m_, rehearsal_.step_s));
    made->started_ = started_;
    made->publisher_ = publisher_;
    return made;
}

bool DrillModel::adopt(const ForceModel& old) noexcept {
    if (typeid(old) != typeid(*this)) return false;
    const auto& before = static_cast<const DrillModel&>(old);
    if (&before.bone_ != &bone_) return false;
    erosion_.follow(before.erosion_);
    fade_.follow(before.fade_);
    settings_.burr_rad_s = before.settings_.burr_rad_s;
    spin_rad_s_ = before.spin_rad_s_;
    drive_ = before.drive_;
    driven_ = before.driven_;
    T_model_tool_ = before.T_model_tool_;
    phase_rad_ = before.phase_rad_;
    level_ = before.level_;
    asked_ = before.asked_;
    grips_ = before.grips_;
    tools_ = before.tools_ + 1;
    postponed_ = before.postponed_;
    jumps_ = before.jumps_;
    return true;
}

}  // namespace tact
