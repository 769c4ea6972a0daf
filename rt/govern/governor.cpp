// The law "elastic".
//
// Force loop and display share processors. Let g be the processor fraction of the display. The loop gets a
// constant part of the rest (all of it, or its fair share beside other programs): r ~ 1 - g. With the level V
// and the elasticity n = d ln g / d ln V of the display's cost,
//     d ln r / d ln V = - n g / (1 - g),      so an error e = (r - r_g) / r_g requires
//     ln V <- ln V + k e (1 - g) / (n g).
// g and n are measured (processor time of the visual process, display_cost.hpp); the load of other programs and
// the cost of an update need not be known. The law "sensitus" is the same with a constant s in place of
// k (1 - g) / (n g). That factor grows from below 1 at full detail to 50 at a coarse level, so "sensitus"
// returns slowly where V is small.
//
// Levels fall at once by the full step (k = 1). They rise by half a step, kHold_s after the last fall. A step
// is limited to kDownMost down and kUpMost up.
//
// Where the display takes little of the core, k (1 - g) / (n g) is large, and a core whose speed drifts by a few percent would
// drive the level up and down by a factor. For a small error the factor is therefore at most kCalm, up and down; it reaches
// the whole one, in proportion to e², at kFar. rate_hold.hpp covers the rest meanwhile. Other programs come and go: what
// was lost to a large error returns in steps of kUpMost once the rate is too high. A loop of fixed rate has its own core: a
// large error is then its own work, which does not end.
//
// That holds where a step can do less (set_held). A model that always does all of its work leaves the rate to the display alone:
// then small errors count too, and further steps in the same direction grow, up to kAloneMost times.
//
// Frame times follow the same model:
//     ln V <- ln V - ln(t / t_g) / n.
#include "rt/govern/governor.hpp"

#include <algorithm>
#include <cmath>

#include "rt/govern/step_limits.hpp"

namespace tact {

namespace {

constexpr double kHold_s = 0.5;
constexpr double kDownGain = 1.0, kUpGain = 0.5, kFrameUpGain = 0.8;
// A display that never pauses takes whatever processor time is left, at any level, so the model does not hold.
// A large rate error then lowers the level by at least this step, until the display pauses again.
constexpr double kDownToPause = 0.7, kNoPause = 0.97, kFarOff = 0.04;
constexpr double kDampingGrows = 1.4, kDampingShrinks = 0.55, kDampingLeast = 0.1, kLargeError = 0.12;
// Further steps down while it does not pause grow by a factor, up to a limit.
constexpr double kBusyGrows = 1.4, kBusyMost = 8.0;
constexpr double kCalm = 0.8, kFar = 0.3;
constexpr double kAloneGrows = 1.4, kAloneMost = 3.0;
constexpr double kTolerance = 0.015, kToleranceAlone = 0.007;  // of the law "elastic", added to the flicker
constexpr double kAim = 1.002;              // of the goal: centres the remaining flicker on the goal
constexpr double kDisplayTolerance = 0.02;  // excess of a frame's time over its goal
constexpr double kDisplayMargin = 0.93;     // fraction of the goal time up to which a frame may grow
constexpr double kDisplayAim = 0.97;        // of the goal time, of a frame that took too long
// Below this elasticity, halving the level saves less than a fourteenth of a frame: the level stays.
constexpr double kWorthwhile = 0.1;
constexpr double kShareLeast = 0.02, kShareMost = 0.9;
constexpr double kBudgetLeast = 0.05;  // least budget of a fitted path

bool possible(const KnobSpec& knob) noexcept {
    return knob.floor >= 0.0F && knob.floor <= 1.0F && knob.start >= knob.floor && knob.start <= 1.0F &&
           knob.slew_per_s > 0.0F;
}

bool time_like(double s) noexcept { return std::isfinite(s) && s >= 0.0 && s < 1e6; }

}  // namespace

Governor::Governor(const GovernorSettings& settings) noexcept : settings_(settings) {}

std::size_t Governor::add(const KnobSpec& knob) noexcept {
    if (count_ == kPathsMax || !possible(knob)) return kPathsMax;
    paths_[count_] = {.knob = knob, .level = knob.start, .requested = knob.start};
    return count_++;
}

void Governor::replace(std::size_t path, const KnobSpec& knob) noexcept {
    if (path >= count_ || !possible(knob)) return;
    GovernedPath& p = paths_[path];
    const bool by_hand = settings_.law == Law::fixed && p.requested != p.knob.start;
    p = {.knob = knob,
         .level = knob.start,
         .requested = by_hand ? std::max(p.requested, knob.floor) : knob.start,
         .present = p.present};
    forget_rate();
}

bool Governor::apply_requests(double dt_s) noexcept {
    bool changed = false;
    for (std::size_t i = 0; i < count_; ++i) {
        GovernedPath& p = paths_[i];
        if (p.level == p.requested) continue;
        const float step = p.knob.slew_per_s * static_cast<float>(dt_s);
        p.level = p.requested > p.level ? std::min(p.level + step, p.requested) : p.requested;
        p.reason = LevelReason::by_command;
        changed = true;
    }
    return changed;
}

bool Governor::say_hold() noexcept {
    bool changed = false;
    for (std::size_t i = 0; i < count_; ++i) {
        if (paths_[i].fitted) continue;
        changed = changed || paths_[i].reason != LevelReason::hold;
        paths_[i].reason = LevelReason::hold;
    }
    return changed;
}

RateIs Governor::judge(double rate_hz, double dt_s) noexcept {
    if (settings_.law == Law::sensitus) return judge_rate(rate_hz, settings_.goal_hz, settings_.tolerance);
    rate_.add(rate_hz, kAim * settings_.goal_hz);
    since_down_s_ += dt_s;
    const RateIs rate = rate_.judge(held_ ? kTolerance : kToleranceAlone);
    return rate == RateIs::high && since_down_s_ < kHold_s ? RateIs::right : rate;
}

Governor::Factors Governor::factors(double rate_hz, RateIs rate) const noexcept {
    if (settings_.law == Law::sensitus) {
        const double f = sensitus_factor(rate_hz, settings_.goal_hz, settings_.gain, settings_.tolerance);
        return {f, f};
    }
    const double gain = rate == RateIs::low ? kDownGain : kUpGain, e = gain * rate_.error();
    const double g = std::clamp(display_fraction_, kShareLeast, kShareMost);
    const double n = display_cost_.at(visual_levels()).elasticity();
    const double whole = (1.0 - g) / (n * g), far = std::min(std::abs(rate_.error()) / kFar, 1.0);
    const double by =
        busy_growth_ * std::max(std::min(whole, kCalm * alone_growth_), gain * whole * far * far);
    double visual = std::clamp(by * rate_.error(), -kDownMost, kUpMost);
    if (rate == RateIs::high) visual = std::max(visual, std::min(given_up_, kUpMost));
    if (rate_.error() < -kFarOff && display_busy_ > kNoPause) visual = std::min(visual, -kDownToPause);
    return {std::exp(damping_ * visual), std::exp(std::clamp(e, -kDownMost, kUpMost))};
}

// The model of the display may be off by a multiple. Steps to and fro halve each other until they are small; steps in one
// direction grow again, and a large error calls for a whole step. A display that never pauses takes the same share of the core
// at many levels: a rate that stays too low calls for ever larger steps.
void Governor::damp(RateIs rate) noexcept {
    if (damped_ != RateIs::right) damping_ *= rate == damped_ ? kDampingGrows : kDampingShrinks;
    if (std::abs(rate_.error()) > kLargeError) damping_ = 1.0;
    damping_ = std::clamp(damping_, kDampingLeast, 1.0);
    alone_growth_ = !held_ && rate == damped_ ? std::min(kAloneGrows * alone_growth_, kAloneMost) : 1.0;
    const bool goes_on = rate == RateIs::low && damped_ == RateIs::low && display_busy_ > kNoPause;
    busy_growth_ = goes_on ? std::min(busy_growth_ * kBusyGrows, kBusyMost) : 1.0;
    damped_ = rate;
}

// Factor by which visual levels may rise before a frame takes too long; unlimited without a display goal.
double Governor::display_margin() const noexcept {
    if (settings_.display_goal_hz <= 0.0) return 1e9;
    if (frame_s_ <= 0.0) return 1.0;  // the cost of the present levels is not known yet
    const double spare = kDisplayMargin / (settings_.display_goal_hz * frame_s_);
    if (spare <= 1.0) return 1.0;
    return std::exp(
        std::min(kFrameUpGain * std::log(spare) / display_cost_.at(visual_levels()).elasticity(), kUpMost));
}

bool Governor::step(double rate_hz, Duration dt) noexcept {
    const double dt_s = std::max(to_s(dt), 0.0);
    if (settings_.law == Law::fixed) return apply_requests(dt_s);
    if (!std::isfinite(rate_hz) || rate_hz < 0.0) return false;
    const RateIs rate = judge(rate_hz, dt_s);
    since_visual_s_ += dt_s;
    if (rate == RateIs::right) {
        if (rebalance_visual()) return true;
        return display_binds_ ? false : say_hold();
    }
    damp(rate);
    const Factors by = factors(rate_hz, rate);
    bool moved = false;
    if (rate == RateIs::low) {
        moved = scale_visual(by.visual, dt_s, LevelReason::rate_low, LevelReason::at_floor);
        if (moved && settings_.free_running && rate_.error() < -kLargeError) given_up_ += scaled_ln_;
        display_binds_ = display_binds_ && !moved;
        if (!moved) moved = scale(true, by.haptic, dt_s, LevelReason::rate_low, LevelReason::at_floor);
        if (moved) since_down_s_ = 0.0;
    } else {
        moved = scale(true, by.haptic, dt_s, LevelReason::rate_high, LevelReason::at_top);
        const double room = display_margin();
        if (!moved && room > 1.0) {
            const LevelReason up = display_binds_ ? LevelReason::display_high : LevelReason::rate_high;
            moved = scale_visual(std::min(by.visual, room), dt_s, up, LevelReason::at_top);
            if (moved) given_up_ = std::max(given_up_ - scaled_ln_, 0.0);
        }
    }
    if (!moved && rate == RateIs::high && rebalance_visual()) return true;
    if (moved) rate_.restart();
    return moved;
}

bool Governor::update(const DisplaySample& picture) noexcept {
    if (!time_like(picture.work_s) || !time_like(picture.processor_s) || !time_like(picture.period_s))
        return false;
    if (picture.period_s > 0.0) {
        const double share = std::min(picture.processor_s / picture.period_s, 64.0);
        display_fraction_ += (display_fraction_ > 0.0 ? 0.2 : 1.0) * (share - display_fraction_);
    }
    DisplayCost::PerPath share{};
    for (std::size_t i = 0; i < count_; ++i)
        if (picture.work_s > 0.0 && time_like(picture.path_s[i]))
            share[i] = picture.path_s[i] / picture.work_s;
    display_cost_.add(visual_levels(), share, picture.processor_s);
    const double busy = picture.period_s > 0.0 ? std::min(picture.work_s / picture.period_s, 1.0) : 0.0;
    display_busy_ += 0.4 * (busy - display_busy_);
    if (settings_.law == Law::fixed || settings_.display_goal_hz <= 0.0 || picture.work_s <= 0.0)
        return false;

    // A very slow first frame counts at once; otherwise the fastest of three frames counts, so a hitch does not.
    const double goal_s = 1.0 / settings_.display_goal_hz;
    const bool first = frame_s_ <= 0.0;
    const double believed = first ? (picture.work_s > 2.0 * goal_s ? picture.work_s : 0.0)
                                  : std::min({picture.work_s, frames_before_s_[0], frames_before_s_[1]});
    frames_before_s_ = {first ? 0.0 : frames_before_s_[1], picture.work_s};
    frame_s_ = first ? picture.work_s : frame_s_ + 0.3 * (picture.work_s - frame_s_);
    if (believed <= (1.0 + kDisplayTolerance) * goal_s) return false;
    double factor = 1.0;
    if (settings_.law == Law::sensitus) {
        factor =
            sensitus_factor(1.0 / believed, settings_.display_goal_hz, settings_.gain, settings_.tolerance);
    } else {
        const double n = display_cost_.at(visual_levels()).elasticity();
        if (n < kWorthwhile) return false;
        factor = std::exp(std::max(-std::log(believed / (kDisplayAim * goal_s)) / n, -kDownMost));
    }
    if (!scale_visual(factor, 0.0, LevelReason::display_low, LevelReason::at_floor)) return false;
    display_binds_ = true;
    since_down_s_ = 0.0;
    rate_.restart();
    return true;
}

// Scales all present paths of one kind by one factor. True: at least one of them moved.
bool Governor::scale(bool haptic, double factor, double dt_s, LevelReason up_or_down,
                     LevelReason stuck) noexcept {
    bool moved = false;
    for (std::size_t i = 0; i < count_; ++i) {
        GovernedPath& p = paths_[i];
        if (!takes_part(p) || p.knob.haptic != haptic || (p.fitted && !settings_.free_running)) continue;
        float& value = p.fitted ? p.budget : p.level;
        const double floor = p.fitted ? kBudgetLeast : static_cast<double>(p.knob.floor);
        const double before = static_cast<double>(value);
        const double base = factor > 1.0 ? std::max(before, kLeastLevel) : before;
        const double least = std::max(floor, std::min(before, kLeastLevel));
        double wanted = std::clamp(base * factor, least, 1.0);
        if (factor > 1.0) wanted = std::min(wanted, before + static_cast<double>(p.knob.slew_per_s) * dt_s);
        const auto level = static_cast<float>(wanted);
        moved = moved || level != value;
        if (!p.fitted) p.reason = level == value ? stuck : up_or_down;
        value = level;
    }
    if (moved && !haptic) frame_s_ = 0.0;
    return moved;
}

bool Governor::set_goal_hz(double goal_hz) noexcept {
    if (!(goal_hz >= 1.0 && goal_hz <= 1e7)) return false;
    settings_.goal_hz = goal_hz;
    forget_rate();
    return true;
}

bool Governor::set_level(std::size_t path, double level) noexcept {
    if (path >= count_) return false;
    GovernedPath& p = paths_[path];
    const auto requested = static_cast<float>(level);  // a floor as it is printed is at the floor
    if (!(requested >= p.knob.floor && level <= 1.0)) return false;
    if (settings_.law != Law::fixed) set_law(Law::fixed);
    p.requested = requested;
    p.reason = LevelReason::by_command;
    return true;
}

bool Governor::start_at_level(std::size_t path, double level) noexcept {
    if (!set_level(path, level)) return false;
    paths_[path].level = paths_[path].requested;
    return true;
}

bool Governor::set_fitted_level(std::size_t path, float level, LevelReason reason) noexcept {
    if (path >= count_ || settings_.law == Law::fixed || !(level >= 0.0F && level <= 1.0F)) return false;
    GovernedPath& p = paths_[path];
    p.fitted = true;
    p.reason = reason;
    const float before = p.level;
    p.level = std::max(level, p.knob.floor);
    return p.level != before;
}

// The law "fixed" starts from the present levels, so that no level jumps.
void Governor::set_law(Law law) noexcept {
    if (law == Law::fixed && settings_.law != Law::fixed) {
        for (std::size_t i = 0; i < count_; ++i) paths_[i].requested = paths_[i].level;
    }
    settings_.law = law;
    forget_rate();
}

void Governor::set_present(std::size_t path, bool present) noexcept {
    if (path >= count_) return;
    if (!paths_[path].knob.haptic && present != paths_[path].present) {
        forget_rate();
        display_fraction_ = display_busy_ = frame_s_ = 0.0;
        display_binds_ = false;
    }
    paths_[path].present = present;
}

}  // namespace tact
