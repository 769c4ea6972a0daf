// The servo's side of the governor: what it is told, when it is asked, and what follows from its word.
#include <algorithm>
#include <array>

#include "rt/loop/servo.hpp"

namespace tact {

void Servo::start_interval(Instant now) noexcept {
    governed_at_ = now;
    interval_cycles_ = interval_overruns_ = 0;
    interval_cost_ = interval_model_cost_ = Duration{0};
}

void Servo::govern(CycleState& c) noexcept {
    ++interval_cycles_;
    interval_model_cost_ += c.model_cost;
    if (dry_) return;
    std::array<float, Governor::kPathsMax> before{};
    const auto paths = governor_.paths();
    for (std::size_t i = 0; i < paths.size(); ++i) before[i] = paths[i].level;

    const bool pending = c.house.gui_attached != 0 && picture_.pending(c.now);
    if (look_at_picture(c)) {
        say_levels(c, before, true);
        return start_interval(c.now);
    }
    // What is measured before the picture obeyed says nothing about the levels that stand.
    if (pending && governor_.settings().law == Law::elastic) {
        if (!picture_.pending(c.now)) start_interval(c.now);
        return;
    }
    const Duration interval = c.now - governed_at_;
    if (interval < settings_.governor_interval) return;
    law_rate_hz_ = rate_for_law(interval);
    model_cost_s_ = to_s(interval_model_cost_) / static_cast<double>(interval_cycles_);
    governor_.set_present(kMeshIndex, c.house.gui_attached != 0);
    const bool changed = governor_.step(law_rate_hz_, interval);
    say_levels(c, before, changed || levels_vertices_max_ != c.house.gui_vertices_max);
    start_interval(c.now);
}

void Servo::say_levels(const CycleState& c, std::span<const float> before, bool changed) noexcept {
    const auto paths = governor_.paths();
    if (changed) ++levels_sequence_;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].level == before[i]) continue;
        say(EventCode::level_changed, static_cast<double>(i), static_cast<double>(paths[i].level));
        if (!paths[i].knob.haptic) picture_.asked(levels_sequence_, c.now);
    }
    publish_levels(c);
}

bool Servo::look_at_picture(const CycleState& c) noexcept {
    const HouseReport& h = c.house;
    if (h.gui_attached == 0) return false;
    const auto look = picture_.take({.frame = h.gui_frame,
                                     .levels_sequence = h.gui_levels_sequence,
                                     .taken_at_ns = h.gui_taken_at_ns,
                                     .work_s = h.gui_work_s,
                                     .cpu_s = h.gui_cpu_s,
                                     .drawn = h.gui_vertices > 0});
    return look && governor_.look(*look);
}

// A loop of fixed rate never shows more than its rate. What the law has to see is whether there is time to
// spare: the rate that the cycles of this interval would have allowed. It is cut at a tenth above the goal,
// so that levels come back by a few percent a step and not in one leap.
double Servo::rate_for_law(Duration interval) const noexcept {
    const double measured_hz = static_cast<double>(interval_cycles_) / std::max(to_s(interval), 1e-9);
    if (settings_.free_running || interval_overruns_ > 0 || interval_cost_.count() <= 0) return measured_hz;
    const double possible_hz = static_cast<double>(interval_cycles_) / to_s(interval_cost_);
    return std::max(measured_hz, std::min(possible_hz, 1.1 * governor_.settings().goal_hz));
}

}  // namespace tact
