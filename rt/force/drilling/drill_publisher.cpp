#include "rt/force/drilling/drill_publisher.hpp"

#include <algorithm>

#include "rt/force/drilling/drill_model.hpp"

namespace tact {
namespace {

static_assert(static_cast<int>(BurrShape::sphere) == static_cast<int>(DrillShape::sphere) &&
              static_cast<int>(BurrShape::cylinder) == static_cast<int>(DrillShape::cylinder) &&
              static_cast<int>(BurrShape::cone) == static_cast<int>(DrillShape::cone) &&
              static_cast<int>(BurrGrit::cutting) == static_cast<int>(DrillGrit::cutting) &&
              static_cast<int>(BurrGrit::diamond) == static_cast<int>(DrillGrit::diamond));

TouchTopic touch_of(const DrillModel& tool, const ModelCycle& cycle) noexcept {
    TouchTopic t{};
    t.taken_at_ns = to_ns(cycle.now);
    t.cycle = cycle.cycle;
    std::copy_n(tool.T_model_tool().p_m.data(), 3, t.probe_model_m);
    std::copy_n(tool.T_model_tool().p_m.data(), 3, t.proxy_model_m);
    t.radius_model_m = tool.head_radius_m() / tool.meta().world_per_model;
    const Vec3& push_n = tool.head_force().wrench.force_n;
    const double size_n = push_n.norm();
    if (tool.depth() > 0.0 && size_n > 0.0) {
        t.planes = 1;
        const Vec3 normal = push_n / size_n;
        for (int k = 0; k < 3; ++k) t.normal_model[0][k] = static_cast<float>(normal[k]);
        t.push_n[0] = static_cast<float>(size_n);
    }
    return t;
}

DrillHand hand_of(const DrillModel& tool, const ModelCycle& cycle, const DrillRates& rates) noexcept {
    const DrillToolSettings& s = tool.settings().tool;
    const ToolDrive& driven = tool.driven();
    const bool wet = driven.enabled && rates.irrigation_m3_s > 0.0 && (rates.irrigation_always || driven.on);
    const bool sucks = driven.on && rates.suction_m3_s > 0.0;
    DrillHand h{};
    std::copy_n(tool.T_model_tool().p_m.data(), 3, h.pos_model_m);
    std::copy_n(tool.T_model_tool().q.coeffs().data(), 4, h.quat_model_tool_xyzw);
    h.removed_levels = tool.removed_levels();
    h.radius_m = static_cast<float>(s.radius_m);
    h.length_m = static_cast<float>(s.shape == BurrShape::sphere ? 2.0 * s.radius_m : s.length_m);
    h.tip_radius_m = static_cast<float>(s.shape == BurrShape::cone ? s.tip_radius_m : s.radius_m);
    h.shaft_radius_m = static_cast<float>(s.shaft_radius_m);
    h.shaft_length_m = static_cast<float>(s.shaft_radius_m > 0.0 ? s.shaft_length_m : 0.0);
    h.burr_rad_s = static_cast<float>(tool.burr_rad_s());
    h.depth = static_cast<float>(tool.depth());
    h.elastic_n = static_cast<float>(tool.elastic_n());
    h.force_n = static_cast<float>(cycle.step.wrench_world.force_n.norm());
    h.cut_levels = static_cast<std::uint32_t>(tool.cut().removed);
    h.kind = s.cuts ? DrillKind::burr : DrillKind::suction_tube;
    h.shape = static_cast<DrillShape>(s.shape);
    h.grit = static_cast<DrillGrit>(tool.settings().grit);
    h.irrigation = s.cuts && wet ? 1.0F : 0.0F;
    h.suction = !s.cuts && sucks ? 1.0F : 0.0F;
    return h;
}

}  // namespace

void DrillPublisher::add(const DrillModel& tool, const ModelCycle& cycle) noexcept {
    if (cycle.hand >= kDrillHands) return;
    if (cycle.hand == 0) touch_.publish(touch_of(tool, cycle));
    next_.hand[cycle.hand] = hand_of(tool, cycle, rates_);
    removed_ += static_cast<std::int64_t>(tool.removed_levels());
    next_.level_m3 = tool.level_m3();
    if (tool.settings().tool.cuts) {
        next_.burr_rad_s_most = static_cast<float>(tool.settings().burr_rad_s);
        next_.changing_burr = tool.stale() ? 1 : 0;
    }
    if (++added_ < tools_) return;
    const StrokeHistory& strokes = tool.bone().strokes;
    next_.removed_levels =
        static_cast<std::uint64_t>(std::max(removed_ - tool.bone().returned_levels, std::int64_t{0}));
    next_.strokes = strokes.strokes();
    next_.undoable = static_cast<std::uint16_t>(strokes.undoable());
    next_.redoable = static_cast<std::uint16_t>(strokes.redoable());
    next_.stroke_under_way = strokes.under_way() ? 1 : 0;
    next_.exchanging = strokes.exchanging() ? 1 : 0;
    next_.taken_at_ns = to_ns(cycle.now);
    next_.cycle = cycle.cycle;
    next_.irrigation_m3_s_most = static_cast<float>(rates_.irrigation_m3_s);
    next_.suction_m3_s_most = static_cast<float>(rates_.suction_m3_s);
    drill_.publish(next_);
    next_ = {};
    removed_ = 0;
    added_ = 0;
}

}  // namespace tact
