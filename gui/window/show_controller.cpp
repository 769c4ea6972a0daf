#include "gui/window/show_controller.hpp"

#include <algorithm>

#include "gui/window/describe.hpp"

namespace tact {
namespace {

constexpr std::size_t kEventsKept = 100;
constexpr std::size_t kEventsPerFrame = 64, kCyclesPerFrame = 16384;

void take_events(Controller& controller, DashboardState& state) {
    EventTopic event;
    for (std::size_t i = 0; i < kEventsPerFrame && controller.next_event(event); ++i) {
        if (event.code == static_cast<std::uint16_t>(EventCode::level_changed) && event.a >= 0.0 &&
            event.a < static_cast<double>(kPathsMax))
            state.history.knobs.add(
                state.history.at_s(event.taken_at_ns), static_cast<std::size_t>(event.a), event.b,
                event.detail < 255 ? static_cast<LevelReason>(event.detail) : static_cast<LevelReason>(255));
        EventLine line = describe(event, controller.have_levels ? &controller.levels : nullptr);
        add_event(std::move(line), state.events);
        if (state.events.size() > kEventsKept) state.events.pop_back();
    }
}

}  // namespace

void add_event(EventLine line, std::deque<EventLine>& events) {
    const bool counts =
        line.grade == Grade::watch || line.code == static_cast<std::uint16_t>(EventCode::level_changed);
    const auto earlier = std::find_if(events.begin(), events.end(),
                                      [&](const EventLine& e) { return counts && e.code == line.code; });
    if (earlier != events.end()) {
        line.count = earlier->count + 1;
        events.erase(earlier);
    }
    events.push_front(std::move(line));
}

void show_controller(Controller& controller, const CommandSender& commands, DashboardState& state) {
    take_events(controller, state);
    state.attached = controller.attached();
    state.link_text = controller.status_text();
    state.have_health = controller.have_health;
    state.have_levels = controller.have_levels;
    state.health = controller.health;
    state.levels = controller.levels;
    state.have_devices = controller.have_devices;
    state.devices = controller.devices;
    state.recorders = controller.have_recorders ? controller.recorders.recorders : 0;
    state.flights = controller.have_recorders ? controller.recorders.flights : 0;
    state.have_tracker = controller.have_tracker;
    state.tracker = controller.tracker;
    state.refused_records = controller.refused();
    state.events_missed = controller.events_missed();
    if (state.watching) return;  // what it says is of its own orders
    state.command_text = commands.text();
    using Stage = CommandSender::Stage;
    state.command_grade = commands.stage() == Stage::done   ? Grade::good
                          : commands.stage() == Stage::sent ? Grade::unknown
                                                            : Grade::watch;
}

void add_health(const HealthTopic& h, History& to) {
    to.rate_hz.add(to.now_s, h.force_rate_hz);
    to.lateness_p50_s.add(to.now_s, 1e-9 * static_cast<double>(h.lateness_p50_ns));
    to.lateness_p99_s.add(to.now_s, 1e-9 * static_cast<double>(h.lateness_p99_ns));
    to.lateness_max_s.add(to.now_s, 1e-9 * static_cast<double>(h.lateness_max_ns));
    to.cycle_cost_s.add(to.now_s, 1e-9 * static_cast<double>(h.cycle_cost_p50_ns));
}

void add_rates(const Controller& controller, const Controller::Fresh& fresh, DashboardState& to) {
    if (fresh.lateness) to.lateness.add(controller.lateness);
    if (fresh.tracker) to.tracker_rate.add(controller.tracker.taken_at_ns, controller.tracker.samples);
    if (!fresh.devices) return;
    for (std::size_t i = 0; i < kDeviceHands; ++i)
        to.device_rate[i].add(controller.devices.taken_at_ns, controller.devices.hand[i].samples);
}

void add_cycles(const Controller& controller, RingCursor& place, DashboardState& to) {
    const std::uint64_t missed = place.missed;
    TraceTopic cycle;
    // A loop faster than its reader must not block the frame.
    for (std::size_t i = 0; i < kCyclesPerFrame && controller.next_cycle(place, cycle); ++i)
        to.traces.scope.add(cycle, controller.have_health ? controller.health.period_ns : 0);
    to.traces.scope.add_missed(place.missed - missed);
}

void forget_rates(DashboardState& state) {
    state.traces.scope.clear();
    state.lateness.clear();
    state.tracker_rate.clear();
    for (CounterRate& rate : state.device_rate) rate.clear();
    state.history.knobs.clear();
}

void forget_run(DashboardState& state) {
    forget_rates(state);
    state.events.clear();
    History& h = state.history;
    for (PlotSeries* series : {&h.rate_hz, &h.lateness_p50_s, &h.lateness_p99_s, &h.lateness_max_s,
                               &h.cycle_cost_s, &h.frame_s, &h.busy_s})
        series->clear();
    for (PlotSeries& series : h.level) series.clear();
}

void add_load(const LoadTopic& load, const LevelsTopic* levels, History& to) {
    to.frame_s.add(to.now_s, load.frame_s);
    to.busy_s.add(to.now_s, load.busy_s);
    if (levels == nullptr) return;
    for (std::uint32_t i = 0; i < levels->count; ++i)
        to.level[i].add(to.now_s, static_cast<double>(levels->path[i].level));
}

}  // namespace tact
