#include "rt/servo/publish_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

namespace tact::servo {

namespace {

void put_path(PathLevel& p, const GovernedPath& path) noexcept {
    const std::string_view name = path.knob.path;
    std::memcpy(p.path, name.data(), std::min(name.size(), kPathNameMax - 1));
    p.level = path.level;
    p.floor = path.knob.floor;
    p.reason = static_cast<std::uint8_t>(path.reason);
    p.haptic = path.knob.haptic ? 1 : 0;
}

}  // namespace

void publish_levels(CycleState& c, const ServoSettings& settings, RtRegion& region) noexcept {
    LevelsTopic t{};
    t.taken_at_ns = to_ns(c.now);
    t.sequence = c.report.levels_sequence;
    t.goal_hz = c.governor.settings().goal_hz;
    t.rate_hz = c.govern.law_rate_hz;
    t.display_goal_hz = static_cast<float>(c.governor.settings().display_goal_hz);
    const std::string_view law = kLawNames[static_cast<std::size_t>(c.governor.settings().law)];
    std::memcpy(t.law, law.data(), std::min(law.size(), kLawNameMax - 1));
    const auto paths = c.governor.paths();
    t.count = static_cast<std::uint32_t>(std::min(paths.size(), kPathsMax));
    for (std::size_t i = 0; i < t.count; ++i) {
        put_path(t.path[i], paths[i]);
        t.path[i].changed_at_ns = c.report.level_changed_at_ns[i];
    }
    for (std::size_t i = 0; i < settings.visual_paths.size(); ++i) {
        const VisualPath& visual = settings.visual_paths[i];
        PathLevel& p = t.path[visual_index(i)];
        p.items_max = c.report.items_max[i] = c.housekeeping.*visual.items_max;
        p.items = static_cast<std::uint32_t>(std::lround(static_cast<double>(p.level) * p.items_max));
        p.drawn = c.housekeeping.gui_attached != 0 ? c.housekeeping.*visual.drawn : 0;
        p.cost_s = c.housekeeping.*visual.cost_s;
    }
    const ForceModel& model = *c.hand[0].model;
    PathLevel& force = t.path[kForcePathIndex];
    force.items = model.items(force.level);
    force.items_max = model.items(1.0F);
    force.cost_s = c.govern.model_cost_s;
    force.error = c.hand[0].step.load.error;
    region.levels.publish(t);
}

}  // namespace tact::servo
