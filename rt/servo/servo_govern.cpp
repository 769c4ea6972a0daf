// The servo's side of the governor: what it is told, when it is asked, and what follows from its word.
#include <algorithm>
#include <array>

#include "rt/servo/servo.hpp"

namespace tact {

namespace {

constexpr double kMemory_s = 1.0;  // of what a whole step costs
constexpr double kSlowUpdateFraction = 0.9;

}  // namespace

void Servo::start_interval(Instant now) noexcept {
    governed_at_ = now;
    interval_cycles_ = interval_overruns_ = 0;
    interval_cost_ = interval_model_cost_ = Duration{0};
    interval_rest_ = Duration{0};
    interval_recomputed_ = 0.0;
}

// The visual paths come and go together.
void Servo::set_display_present(bool present) noexcept {
    governor_.set_present(kMeshIndex, present);
    if (settings_.bone) governor_.set_present(kParticlesIndex, present);
}

void Servo::govern(CycleState& c) noexcept {
    ++interval_cycles_;
    interval_model_cost_ += c.model_cost;
    interval_recomputed_ += c.recomputed_fraction;
    if (dry_) return;
    std::array<float, Governor::kPathsMax> before{};
    const auto paths = governor_.paths();
    for (std::size_t i = 0; i < paths.size(); ++i) before[i] = paths[i].level;

    const bool pending = c.housekeeping.gui_attached != 0 && display_.pending(c.now);
    if (sample_display(c)) {
        report_levels(c, before, true);
        return start_interval(c.now);
    }
    // What is measured before the picture obeyed says nothing about the levels that stand.
    if (pending && governor_.settings().law == Law::elastic) {
        if (!display_.pending(c.now)) start_interval(c.now);
        return;
    }
    const Duration interval = c.now - governed_at_;
    if (interval < settings_.governor_interval) return;
    law_rate_hz_ = rate_kept_up(c, rate_for_law(interval));
    model_cost_s_ = to_s(interval_model_cost_) / static_cast<double>(interval_cycles_);
    set_display_present(c.housekeeping.gui_attached != 0);
    const bool changed = governor_.step(law_rate_hz_, interval);
    const bool resized = levels_vertices_max_ != c.housekeeping.gui_vertices_max ||
                         levels_particles_max_ != c.housekeeping.gui_particles_max;
    report_levels(c, before, changed || resized);
    start_interval(c.now);
}

void Servo::report_levels(const CycleState& c, std::span<const float> before, bool changed) noexcept {
    const auto paths = governor_.paths();
    if (changed) ++levels_sequence_;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].level == before[i]) continue;
        report(EventCode::level_changed, static_cast<double>(i), static_cast<double>(paths[i].level),
               static_cast<std::uint16_t>(paths[i].reason));
        if (!paths[i].knob.haptic) display_.asked(levels_sequence_, c.now);
    }
    publish_levels(c);
}

bool Servo::sample_display(const CycleState& c) noexcept {
    const HousekeepingReport& h = c.housekeeping;
    if (h.gui_attached == 0) return false;
    const auto sample = display_.take({.frame = h.gui_frame,
                                       .levels_sequence = h.gui_levels_sequence,
                                       .taken_at_ns = h.gui_taken_at_ns,
                                       .work_s = h.gui_work_s,
                                       .cpu_s = h.gui_cpu_s,
                                       .drawn = h.gui_vertices > 0});
    return sample && governor_.update(*sample);
}

// A law holds the rate in the long run; between its words the loop itself gives way (rate_hold.hpp). A loop
// of fixed rate has its instants and its deadline for that, and what a person fixed stays as it is.
bool Servo::holds_rate() const noexcept {
    return settings_.free_running && !dry_ && governor_.settings().law != Law::fixed;
}

// Where a freely running loop is ahead of its goal and a picture is coarser than it could be, it waits: the
// picture has the time at once, long before the law has turned it finer. The instant at which it goes on.
Instant Servo::rest() noexcept {
    const Instant now = timestamp();
    const auto paths = governor_.paths();
    const bool wanted = std::any_of(paths.begin(), paths.end(), [](const GovernedPath& p) {
        return p.present && !p.knob.haptic && p.level < 1.0F;
    });
    if (!holds_rate() || !wanted) return now;
    const double rest_s = hold_.rest_s(now, governor_.settings().goal_hz);
    if (rest_s <= 0.0) return now;
    clock_.wait_until(now + Duration{static_cast<std::int64_t>(1e9 * rest_s)});
    const Instant end = timestamp();
    interval_rest_ += end - now;
    statistics_.work.rested(end - now);
    return end;
}

double Servo::work_fraction_of_step(const CycleState& c) noexcept {
    if (holds_rate()) return hold_.work_fraction(c.now, governor_.settings().goal_hz);
    hold_.restart();
    return 1.0;
}

void Servo::count_work(const CycleState& c) noexcept {
    if (c.recomputed_fraction < 1.0) return;
    whole_model_s_ += to_s(c.model_cost);
    whole_cost_s_ += to_s(c.cost);
    if (whole_cost_s_ < kMemory_s) return;
    whole_model_s_ *= 0.5;
    whole_cost_s_ *= 0.5;
}

// A slow half that takes longer than its turns last falls behind the hand, and what the force is felt on with it:
// to the law that is a rate too low, in proportion. From kSlowUpdateFraction of a turn on nothing rises any more.
double Servo::rate_kept_up(const CycleState& c, double rate_hz) const noexcept {
    const double slow_update_s = c.hand[0].model->slow_update_s();
    if (!(slow_update_s > 0.0)) return rate_hz;
    return std::min(rate_hz, governor_.settings().goal_hz * kSlowUpdateFraction * to_s(kSlowUpdatePeriod) /
                                 slow_update_s);
}

// A loop of fixed rate never shows more than its rate. What the law has to see is whether there is time to
// spare: the rate that the cycles of this interval would have allowed. It is cut at a tenth above the goal,
// so that levels come back by a few percent a step and not in one leap.
// A freely running loop that is held near its goal shows little else: the law has to see what whole steps
// without rests would have made of the same time. Work is counted, not time: a step that lost its turn in the
// middle would weigh too much. Dips that were lifted and peaks that were cut even out, so the mean of what
// the law sees is at the goal where the mean rate is.
double Servo::rate_for_law(Duration interval) const noexcept {
    const double measured_hz = static_cast<double>(interval_cycles_) / std::max(to_s(interval), 1e-9);
    if (settings_.free_running) {
        const double given_up = 1.0 - interval_recomputed_ / static_cast<double>(interval_cycles_);
        const double part = whole_cost_s_ > 0.0 ? whole_model_s_ / whole_cost_s_ : 1.0;
        const double awake = std::max(1.0 - to_s(interval_rest_) / to_s(interval), 0.1);
        return measured_hz * (1.0 - part * given_up) / awake;
    }
    if (interval_overruns_ > 0 || interval_cost_.count() <= 0) return measured_hz;
    const double possible_hz = static_cast<double>(interval_cycles_) / to_s(interval_cost_);
    return std::max(measured_hz, std::min(possible_hz, 1.1 * governor_.settings().goal_hz));
}

}  // namespace tact
