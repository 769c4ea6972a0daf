#include "rt/servo/servo.hpp"

#include <algorithm>

#include "ipc/base/error.hpp"
#include "ipc/topics/levels.hpp"

namespace tact {

namespace {

// The picture's path. Its floor is what a person still recognizes; its slew is the law's.
constexpr KnobSpec kMeshKnob{.path = kMeshPath, .floor = 0.01F, .start = 1.0F};
// Rays: with fewer, what is a wall and what is an opening is not told apart.
constexpr KnobSpec kVolumeKnob{.path = kVolumePath, .floor = 0.03F, .start = 1.0F};
// A tenth of the dust and the water still says where the burr cuts and what is hidden.
constexpr KnobSpec kParticlesKnob{.path = kParticlesPath, .floor = 0.1F, .start = 1.0F};

// A stop ramps out in rt/safety's ramp_out_s; the amplifier goes off after this at the latest.
constexpr Duration kStopMax = std::chrono::milliseconds(100);

ChainSettings for_device(ChainSettings chain, const DeviceInfo& info) {
    chain.force_n_max = std::min(chain.force_n_max, info.force_n_max);
    chain.torque_n_m_max = std::min(chain.torque_n_m_max, info.torque_n_m_max);
    chain.wall_stiffness_n_m = std::min(chain.wall_stiffness_n_m, info.stiffness_n_m_max);
    chain.force_n_continuous = info.force_n_continuous;
    chain.workspace_half_m = info.workspace_half_m;
    if (info.position_step_m > 0.0) chain.translation.position_step = info.position_step_m;
    return chain;
}

}  // namespace

Servo::Servo(const ServoParts& parts, const ServoSettings& settings)
    : clock_(parts.clock),
      region_(parts.region),
      mailbox_(parts.mailbox),
      lines_(parts.lines),
      script_(parts.script),
      settings_(settings),
      arena_(sizeof(CycleState) + 4096),
      c_(arena_.take<CycleState>(1).data()),
      pacer_(settings.period, parts.clock.now()),
      watchdogs_(settings.watchdogs),
      governor_(settings.governor) {
    if (parts.hands.empty() || parts.hands.size() > kHandsMax)
        throw std::logic_error("servo: one or two hands");
    c_->hands = static_cast<std::uint32_t>(parts.hands.size());
    for (std::size_t i = 0; i < parts.hands.size(); ++i) {
        HandCycle& h = c_->hand[i];
        h.device = parts.hands[i].device;
        h.model = parts.hands[i].model;
        h.torque = parts.hands[i].info.torque_n_m_max > 0.0;
        h.chain = OutputChain(for_device(settings.chain, parts.hands[i].info));
    }
    c_->housekeeping.gui_heartbeat_ns = -1;
    introduce(parts);
    const bool ok = governor_.add(settings_.bone ? kVolumeKnob : kMeshKnob) == kMeshIndex &&
                    governor_.add(c_->hand[0].model->knob()) == kForceIndex &&
                    (!settings_.bone || governor_.add(kParticlesKnob) == kParticlesIndex);
    if (!ok)
        throw StartupError("the knobs of the scene", "the force model's knob is impossible",
                           "report this scene");
    set_display_present(false);
    const ModelBodies bodies = c_->hand[0].model->bodies();
    if (bodies.active < bodies.count) governed_structure_ = bodies.structure[bodies.active];
    bound_by_delay();
    arena_.seal();
}

void Servo::warm_up() noexcept {
    // Bounded in time too: a step of 100 000 atoms takes a millisecond.
    constexpr Duration kMax = std::chrono::milliseconds(200);
    const Instant begin = clock_.now();
    for (std::uint32_t i = 0; i < settings_.dry_cycles && clock_.now() - begin < kMax; ++i) dry_cycle();
    start(clock_.now());
}

void Servo::dry_cycle() noexcept {
    dry_ = true;
    cycle();
    dry_ = false;
}

void Servo::start(Instant now) noexcept {
    CycleState& c = *c_;
    StartTopic begun = begun_;
    begun.started_at_ns = to_ns(now);
    begun.dry_steps = c.step;
    region_.start.publish(begun);
    c.cycle = 0;
    c.before = now;
    c.overran = false;
    c.behind = Duration{0};
    c.out_of_time = 0;
    for (std::uint32_t i = 0; i < c.hands; ++i) c.hand[i].model->reset(c.hand[i].tool);
    pacer_.restart(now + settings_.period);
    watchdogs_.forget();
    statistics_.start(now);
    hold_.restart();
    health_at_ = now;
    start_interval(now);
    c.run = next_status(c.run, {.open = true}, now);
    report(EventCode::loop_started, 0.0, 0.0);
    publish_levels(c);
    publish_health(c);
}

void Servo::cycle() noexcept {
    CycleState& c = *c_;
    wake(c);
    const RtSection inside;
    sense(c);
    pose(c);
    model(c);
    shape(c);
    safety(c);
    actuate(c);
    publish(c);
    govern(c);
    close(c);
}

void Servo::run() noexcept {
    while (!finished_) cycle();
}

// What a cycle depends on is recorded, its looks at the clock among it.
Instant Servo::timestamp() noexcept {
    const Instant now = clock_.now();
    CycleState& c = *c_;
    if (c.timestamps < c.timestamp.size()) c.timestamp[c.timestamps++] = now;
    return now;
}

void Servo::wake(CycleState& c) noexcept {
    ++c.step;
    c.timestamps = 0;
    if (settings_.free_running || dry_) {
        c.now = c.planned = rest();
        c.lateness = Duration{0};
    } else {
        c.planned = pacer_.planned();
        clock_.wait_until(c.planned);
        c.now = timestamp();
        c.lateness = c.now - c.planned;
        if (!dry_) statistics_.late(c.lateness);
    }
    c.dt = c.cycle == 0 ? Duration{0} : c.now - c.before;
    c.before = c.now;
    ++c.cycle;
}

void Servo::sense(CycleState& c) noexcept {
    read_mailbox(c);
    check_lines(c);
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        h.read_status = h.device->read(h.sample, c.now);
        h.sample_usable = h.read_status != IoStatus::lost && h.sample.T_dev_tool.finite() &&
                          h.sample.twist_dev.linear_m_s.allFinite() &&
                          h.sample.twist_dev.angular_rad_s.allFinite();
        if (h.sample.sequence > 0) h.age_most = std::max(h.age_most, c.now - h.sample.taken_at);
        if (h.read_status == IoStatus::ok && h.sample.delay > Duration{0})
            statistics_.delayed(h.sample.delay);
    }
}

void Servo::pose(CycleState& c) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        if (!h.sample_usable) continue;  // the model goes on with the last good one; the watchdog decides
        h.tool.T_world_tool = settings_.T_world_dev * h.sample.T_dev_tool;
        h.tool.twist_world = {settings_.T_world_dev.q * h.sample.twist_dev.linear_m_s,
                              settings_.T_world_dev.q * h.sample.twist_dev.angular_rad_s};
        h.tool.buttons = h.sample.buttons;
    }
}

bool Servo::pressed(const CycleState& c, Pedal pedal, std::uint32_t hand, LineInput line) const noexcept {
    switch (pedal) {
        case Pedal::button:
            return hand < c.hands && (c.hand[hand].tool.buttons & kDrillPedal) != 0;
        case Pedal::line:  // one that nobody can read is not pressed
            return lines_ != nullptr && c.lines.sample.sequence != 0 &&
                   c.lines.age <= settings_.lines_age_max && (c.lines.sample.inputs & line) != 0;
        case Pedal::always:
            return true;
    }
    return false;
}

// Where no force is let through, nothing is cut either, and nothing runs.
void Servo::read_pedals(CycleState& c) noexcept {
    const DrivesSettings& s = settings_.drives;
    const bool may = c.run.state == RunState::active && !dry_;
    const bool turns = may && pressed(c, s.burr, 0, kLineBurr);
    c.drives.burr_rad_s = turns ? s.burr_rad_s : 0.0;
    c.drives.irrigation = may && s.irrigation_m3_s > 0.0 && (s.irrigation_always || turns);
    c.drives.suction = may && s.suction_m3_s > 0.0 && pressed(c, s.suction, 1, kLineSuction);
}

void Servo::model(CycleState& c) noexcept {
    take_model(c);
    ask_for_model(c);
    read_pedals(c);
    const Instant begin = timestamp();
    const Instant end = settings_.model_deadline ? begin + settings_.model_max : Instant::max();
    c.budget = {.fidelity = script_ != nullptr ? script_->level : governor_.level(kForceIndex),
                .deadline = end,
                .work_fraction = static_cast<float>(work_fraction_of_step(c))};
    c.recomputed_fraction = 0.0;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        h.model->drive({.burr_rad_s = i == 0 ? c.drives.burr_rad_s : 0.0, .step_s = to_s(c.dt)});
        h.deadline = {};
        if (script_ != nullptr)
            h.deadline = {.checks = 0, .passed_at = script_->deadline_check[i], .replayed = true};
        c.budget.deadline = Deadline(end, &h.deadline);
        h.step = h.model->step(h.tool, c.budget);
        if (h.step.status == StepStatus::out_of_time) ++c.out_of_time;
        c.recomputed_fraction += static_cast<double>(h.step.load.recomputed_fraction) / c.hands;
    }
    c.model_cost = timestamp() - begin;
}

void Servo::safety(CycleState& c) noexcept {
    WatchdogInput watched{.now = c.now,
                          .sample_taken_at = c.now,
                          .lateness = std::max(c.lateness, c.behind),
                          .overran = c.overran,
                          .lines = c.lines.stops,
                          .lines_age = c.lines.age,
                          .supervisor = supervisor_dropped(c)};
    c.events.hand_present = true;
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        const HandCycle& h = c.hand[i];
        watched.sample_taken_at = std::min(watched.sample_taken_at, h.sample.taken_at);
        watched.device_lost =
            watched.device_lost || h.read_status == IoStatus::lost || h.write_status == IoStatus::lost;
        watched.device_fault =
            watched.device_fault || h.read_status == IoStatus::fault || !h.sample_usable ||
            h.sample.state == DeviceState::fault ||
            (h.sample.state == DeviceState::watchdog_tripped && settings_.watchdogs.device_watchdog_latches);
        watched.force_finite = watched.force_finite && h.wanted_world.finite();
        c.events.hand_present = c.events.hand_present && h.sample.hand_present;
    }
    c.trip = watchdogs_.check(watched);
    if (watchdogs_.warns()) report(EventCode::overrun, to_us(c.cost), static_cast<double>(pacer_.overruns()));

    const RunStatus before = c.run;
    c.events.trip = c.trip.reason;
    const int signal = mailbox_.stop_signal.load(std::memory_order_relaxed);
    c.events.stop = signal != 0;
    if (c.events.stop && !stopping_) {
        report(EventCode::stopping, static_cast<double>(signal), 0.0);
        record_mailbox(MailboxKind::stop,
                       {.sequence = 0, .value = static_cast<double>(signal), .kind = 0, .index = 0});
    }
    stopping_ = c.events.stop;
    bool still = true;
    for (std::uint32_t i = 0; i < c.hands; ++i) still = still && c.hand[i].out.gain <= 0.0;
    c.events.close =
        c.events.stop && !dry_ && (still || (!amplifier_on(c.run.state) && c.now - c.run.since > kStopMax));
    if (!dry_) c.run = next_status(c.run, c.events, c.now);
    answer_state_order(c, before.state);
    rearm_lines(c, before.state);

    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        // Where an emulated device's watchdog latches no fault, a cycle without enable gives it its edge, and
        // the ramp starts anew.
        const bool dropped = h.sample.state == DeviceState::watchdog_tripped;
        if (dropped && amplifier_on(c.run.state)) report(EventCode::device_watchdog, to_us(c.dt) * 1e-3, 0.0);
        const Quat back = settings_.T_world_dev.q.conjugate();
        h.out = h.chain.apply(
            {.wanted_dev = {back * h.wanted_world.force_n, back * h.wanted_world.torque_n_m},
             .T_dev_tool = h.sample.T_dev_tool,
             .dt = c.dt,
             .force_on = force_may_flow(c.run.state),
             .gate_open = c.run.state != RunState::off && c.run.state != RunState::fault && !dropped,
             .amplifier = amplifier_on(c.run.state),
             .wall_gain = h.walls.gain()});
        h.shown_world = {settings_.T_world_dev.q * h.out.wrench_dev.force_n,
                         settings_.T_world_dev.q * h.out.wrench_dev.torque_n_m};
        report_limits(c, h);
        report_notice(h, i);
    }
    if (c.run.state == before.state) return;
    report(EventCode::state_changed, static_cast<double>(before.state), static_cast<double>(c.run.state));
    if (c.run.state == RunState::fault) note_fault(c);
    if (c.run.state == RunState::off) finished_ = true;
    health_due_ = true;
}

void Servo::actuate(CycleState& c) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        h.write_status = h.device->write(
            {.wrench_dev = h.out.wrench_dev, .enable = h.out.enable, .heartbeat = c.cycle}, c.now);
    }
    drive_lines(c);
}

void Servo::publish(CycleState& c) noexcept {
    publish_tools(c);
    if (dry_) return;
    statistics_.rate.count();
    statistics_.work.add(c.recomputed_fraction);
    if (c.now - health_at_ >= std::chrono::milliseconds(100)) {
        statistics_.rate.turn(c.now);
        statistics_.work.turn(c.now);
        health_at_ = c.now;
        health_due_ = true;
        publish_devices(c);
        if (statistics_.second_over(c.now)) publish_lateness(c);
        bound_by_delay();
    }
    if (health_due_) publish_health(c);
}

void Servo::close(CycleState& c) noexcept {
    const Instant end = timestamp();
    c.cost = end - c.now;
    publish_cycle(c, dry_);
    if (dry_) return;
    statistics_.spent(c.cost);
    interval_cost_ += c.cost;
    count_work(c);
    if (settings_.free_running) {
        c.behind = c.cost;  // without a plan, a long cycle is the only way to be late
    } else {
        c.behind = end - c.planned - settings_.period;
        c.overran = pacer_.ended(end);
    }
    if (c.overran) {
        ++interval_overruns_;
        overrun_at_ns_ = to_ns(end);
        if (end - overrun_reported_at_ > std::chrono::milliseconds(100)) {
            overrun_reported_at_ = end;
            report(EventCode::overrun, to_us(end - c.planned), static_cast<double>(pacer_.overruns()));
        }
    }
    publish_trace(c);
}

}  // namespace tact
