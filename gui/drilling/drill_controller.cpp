#include "gui/drilling/drill_controller.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

namespace tact {
namespace {

constexpr std::size_t kEventsKept = 100;
constexpr std::uint16_t kOwnEvent = 0xFFFF;  // not an EventCode of the controller
constexpr std::size_t kSideLetters = 2;
constexpr double kAgainM = 3e-4;  // hysteresis before a warning repeats

std::string near_text(const std::string& name, double distance_m) {
    char text[128];
    if (distance_m < 0.0)
        std::snprintf(text, sizeof text, "burr in the %s", name.c_str());
    else
        std::snprintf(text, sizeof text, "burr %.1f mm from the %s", 1e3 * distance_m, name.c_str());
    return text;
}

ToolDescription describe_tool(const DrillHand& hand) {
    ToolDescription t;
    t.valid = hand.kind != DrillKind::none;
    t.shape = static_cast<int>(hand.shape);
    t.grit = hand.grit;
    t.diameter_m = 2.0 * static_cast<double>(hand.radius_m);
    t.length_m = static_cast<double>(hand.length_m);
    t.rpm = static_cast<double>(hand.burr_rad_s) * 60.0 / (2.0 * std::numbers::pi);
    t.water = hand.irrigation > 0.0F;
    t.suction = hand.suction > 0.0F;
    t.depth = static_cast<double>(hand.depth);
    return t;
}

}  // namespace

void DrillController::use(std::shared_ptr<const SceneContent> content) {
    metrics_.reset();
    watch_.reset();
    content_ = std::move(content);
    bone_ = content_ ? content_->of<BoneContent>() : nullptr;
    if (bone_ == nullptr) return;
    const BoneContent& bone = *bone_;
    watch_ = std::make_unique<StructureWatch>(bone.distances, content_->meta.world_per_model);
    metrics_ =
        std::make_unique<DrillMetrics>(bone.volume.bricks, bone.labels, bone.distances, content_->meta);
    nearness_.assign(bone.distances.size(), Nearness::far);
}

void DrillController::report(DashboardState& state, std::string text, Grade grade) const {
    state.events.push_front({state.now_ns, kOwnEvent, 1, std::move(text), grade});
    if (state.events.size() > kEventsKept) state.events.pop_back();
}

void DrillController::take_cycles(Controller& controller) {
    TraceTopic cycle{};
    while (controller.next_cycle(cycle)) metrics_->cycle(cycle);
    const std::uint64_t missed = controller.cycles_missed();
    if (missed > missed_) metrics_->unseen(missed - missed_);
    missed_ = missed;
}

void DrillController::take_bricks(std::span<const BrickChange> changes, DashboardState& state) {
    for (const BrickChange& c : changes) {
        const std::uint8_t injured = metrics_->brick(c.brick, c.before, c.after, c.cut_now);
        if (injured != 0) report(state, bone_->labels.structure[injured - 1U].name + " cut", Grade::bad);
    }
}

void DrillController::show(const DrillTopic& drill, DashboardState& dashboard, DrillingState& state) {
    const BoneLabelsView& labels = bone_->labels;
    state.burr = describe_tool(drill.hand[0]);
    state.suction_tube = describe_tool(drill.hand[1]);
    state.undoable = drill.undoable;
    state.redoable = drill.redoable;
    state.exchanging = drill.exchanging != 0;
    state.changing_burr = drill.changing_burr != 0;
    state.burr_rad_s_most = static_cast<double>(drill.burr_rad_s_most);
    state.irrigation_m3_s = static_cast<double>(drill.irrigation_m3_s_most);
    state.suction_m3_s = static_cast<double>(drill.suction_m3_s_most);
    state.removed_m3 = drill.level_m3 * static_cast<double>(drill.removed_levels);
    const auto by_burr = watch_->look(drill, 0), by_suction_tube = watch_->look(drill, 1);
    state.structures.clear();
    for (std::size_t i = 0; i < by_burr.size(); ++i) {
        const BoneStructure& what = labels.structure[by_burr[i].label - 1];
        const auto& c = what.rgba;
        state.structures.push_back(
            {what.name, IM_COL32(c[0], c[1], c[2], 255), by_burr[i].distance_m, by_burr[i].closing_m_s,
             i < by_suction_tube.size() ? by_suction_tube[i].distance_m : 1e9,
             bone_->patient
                 ? patient_letters(bone_->patient->axes * by_burr[i].towards_model).substr(0, kSideLetters)
                 : std::string()});
        const double away_m = by_burr[i].distance_m;
        const Nearness now = away_m < kDrillNearM[0]   ? Nearness::red
                             : away_m < kDrillNearM[1] ? Nearness::amber
                                                       : Nearness::far;
        if (now > nearness_[i]) {
            nearness_[i] = now;
            if (state.burr.rpm > 0.0)
                report(dashboard, near_text(what.name, away_m),
                       now == Nearness::red ? Grade::bad : Grade::watch);
        } else if (now < nearness_[i]) {
            const double border_m = kDrillNearM[nearness_[i] == Nearness::red ? 0 : 1];
            if (away_m > border_m + kAgainM) nearness_[i] = now;
        }
    }
    std::sort(state.structures.begin(), state.structures.end(),
              [](const auto& a, const auto& b) { return a.burr_m < b.burr_m; });
    const double nearest_m = state.structures.empty() ? 1e9 : state.structures.front().burr_m;
    state.nearness = !(state.burr.rpm > 0.0)      ? Grade::good
                     : nearest_m < kDrillNearM[0] ? Grade::bad
                     : nearest_m < kDrillNearM[1] ? Grade::watch
                                                  : Grade::good;
}

void DrillController::follow(Controller& controller, std::span<const BrickChange> changes,
                             DashboardState& dashboard, DrillingState& state) {
    if (!metrics_) {
        state = {};
        return;
    }
    state.labelled = !bone_->labels.structure.empty();
    state.known = controller.attached() && controller.have_drill;
    if (state.known) metrics_->tools(controller.drill);
    take_cycles(controller);
    take_bricks(changes, dashboard);
    if (state.known) show(controller.drill, dashboard, state);
    const DrillMetricsRow f = metrics_->metrics();
    state.drilling_s = f.drilling_s;
    state.excess_s = f.excess_s;
    state.strokes = f.strokes.count;
    state.stroke_m = f.strokes.mean_length_m();
    state.stroke_m_s = f.strokes.mean_speed_m_s();
    state.injuries = f.injuries;
    if (controller.have_tool) {
        const double* const n = controller.tool.force_world_n;
        state.force_n = Vec3(n[0], n[1], n[2]).norm();
        state.held_in = metrics_->held_in();
    }
}

void DrillController::save(const std::string& path, const std::optional<BurrVisibility>& visibility,
                           const nlohmann::json& more) const {
    if (path.empty() || !metrics_) return;
    nlohmann::json report = drill_report(metrics_->metrics(), bone_->labels, visibility, bone_->patient);
    if (more.is_object()) report.update(more);
    write_drill_report(path, report);
}

}  // namespace tact
