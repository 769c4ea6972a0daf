#include "rt/threads/housekeeping.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "ipc/topics/text.hpp"
#include "rt/threads/thread_setup.hpp"

namespace tact {

namespace {

constexpr int kPollMs = 10;    // longest wait of a command
constexpr int kPollLedMs = 4;  // while a pointer leads a hand

std::atomic<ServoMailbox*> signalled{nullptr};
static_assert(std::atomic<ServoMailbox*>::is_always_lock_free);

extern "C" void on_signal(int number) {
    ServoMailbox* const mailbox = signalled.load(std::memory_order_relaxed);
    if (mailbox != nullptr) mailbox->stop_signal.store(number, std::memory_order_relaxed);
}

}  // namespace

bool plausible(const LoadTopic& load) {
    const auto time = [](double s) { return std::isfinite(s) && s >= 0.0 && s < 1e9; };
    bool good = time(load.frame_s) && time(load.busy_s) && time(load.cpu_s) && std::isfinite(load.fps) &&
                load.fps >= 0.0 && load.fps < 1e6 && load.vertices_drawn <= load.vertices_max &&
                load.vertices_max < 1U << 31U && load.particles <= load.particles_max &&
                load.particle_moves <= load.particles_max && load.particles_max < 1U << 31U &&
                load.molecule_triangles <= load.molecule_triangles_max &&
                load.molecule_triangles_max < 1U << 31U && load.pixels <= load.pixels_max &&
                load.pixels_max < 1U << 31U && load.refined <= 2;
    for (const double s : load.part_s) good = good && time(s);
    for (const double s : load.path_s) good = good && time(s);
    return good;
}

Housekeeping::Housekeeping(HousekeepingSettings settings, OwnedRegion<RtRegion>& region,
                           ServoMailbox& mailbox, LinkServer& link)
    : settings_(std::move(settings)),
      region_(region),
      mailbox_(mailbox),
      link_(link),
      builder_(mailbox, settings_.servo_thread_id),
      mouse_({settings_.mouse, settings_.T_dev_world, region.generation(), settings_.lead_device}) {
    report_.gui_heartbeat_ns = -1;
}

void Housekeeping::catch_signals(ServoMailbox& mailbox) {
    signalled.store(&mailbox);
    struct sigaction action {};
    action.sa_handler = &on_signal;  // no SA_RESTART: interrupts the poll of the housekeeping thread
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) sigaction(number, &action, nullptr);
    signal(SIGPIPE, SIG_IGN);
}

void Housekeeping::order(CommandKind kind, double value, std::uint32_t index) {
    mailbox_.orders.push(
        {.sequence = 0, .value = value, .kind = static_cast<std::uint32_t>(kind), .index = index});
}

void Housekeeping::run() {
    const Instant begin = Monotonic::now();
    Instant reported_at = begin;
    while (!mailbox_.ended.load(std::memory_order_acquire)) {
        serve_link();
        serve_gui();
        follow_mouse();
        log_events();
        builder_.poll();
        mailbox_.model.collect().reset();
        const Instant now = Monotonic::now();
        if (now - reported_at >= std::chrono::milliseconds(100)) {
            const std::uint64_t faults = page_faults_of(settings_.servo_thread_id);
            report_.page_faults =
                faults > settings_.page_faults_at_start ? faults - settings_.page_faults_at_start : 0;
            reported_at = now;
            notify_service(now);
            spdlog::default_logger_raw()->flush();  // reports dropped log lines once there is room
        }
        report();
        const bool over = settings_.seconds > 0.0 && to_s(now - begin) >= settings_.seconds;
        int none = 0;
        if (over) mailbox_.stop_signal.compare_exchange_strong(none, -1, std::memory_order_relaxed);
        if (mailbox_.stop_signal.load(std::memory_order_relaxed) != 0) service_.stopping();
    }
    log_events();
}

void Housekeeping::serve_link() {
    LinkServer::News news = link_.poll(mouse_.leads() ? kPollLedMs : kPollMs);
    count_recorders();
    for (std::size_t i = 0; i < news.orders; ++i) apply_order(news.order[i]);
    if (news.gui_left) {
        gui_ = {};
        mouse_.let_go();
        report_.gui_attached = 0;
        spdlog::info("visual process detached");
    }
    if (news.gui_arrived) {
        std::string refusal;
        gui_ = MappedRegion<GuiRegion>::map(std::move(news.gui_fd), refusal);
        if (gui_.empty()) {
            ++bad_input_;
            spdlog::warn("refused the region of the visual process {}: {}", news.gui_pid, refusal);
            return;
        }
        commands_.restart(gui_->commands);  // ignores commands for an earlier controller
        mouse_.restart(gui_->mouse);
        loads_seen_ = frames_seen_ = 0;
        report_.gui_attached = 1;
        report_.gui_generation = gui_.generation();
        report_.gui_heartbeat_ns = to_ns(Monotonic::now());
        spdlog::info("visual process {} attached", news.gui_pid);
    }
}

void Housekeeping::apply_order(const LinkServer::News::Order& o) {
    if (o.what == LinkOrder::stop) {
        spdlog::info("the instructor, process {}, disarms", o.pid);
        return order(CommandKind::disarm, 0.0, 0);
    }
    MarkTopic t{};
    t.taken_at_ns = to_ns(Monotonic::now());
    t.count = ++marks_;
    t.pid = o.pid;
    std::copy(std::begin(o.pos_model_m), std::end(o.pos_model_m), t.pos_model_m);
    region_->mark.publish(t);
}

void Housekeeping::count_recorders() {
    const LinkServer::Recorders now = link_.recorders();
    if (now == recorders_) return;
    recorders_ = now;
    RecordersTopic t{};
    t.taken_at_ns = to_ns(Monotonic::now());
    t.recorders = now.recorders;
    t.flights = now.flights;
    region_->recorders.publish(t);
}

void Housekeeping::pass_on_frames() {
    const std::uint64_t count = gui_->frames.count();
    FramesTopic frames{};
    if (count == frames_seen_ || !gui_->frames.read(frames)) return;
    frames_seen_ = count;
    if (!plausible(frames.metrics)) {
        ++bad_input_;
        return;
    }
    DisplayTopic picture{};
    picture.taken_at_ns = to_ns(Monotonic::now());  // the other process's time stamp is not trusted
    picture.metrics = frames.metrics;
    region_->picture.publish(picture);
}

void Housekeeping::serve_gui() {
    if (gui_.empty()) return;
    const std::uint64_t loads = gui_->load.count();
    LoadTopic load{};
    if (loads != loads_seen_ && gui_->load.read(load)) {
        loads_seen_ = loads;
        if (plausible(load)) {
            report_.gui_heartbeat_ns = to_ns(Monotonic::now());
            report_.gui_fps = load.fps;
            report_.gui_busy_s = load.busy_s;
            report_.gui_frame = load.frame;
            report_.gui_levels_sequence = load.levels_sequence;
            report_.gui_taken_at_ns = load.taken_at_ns;
            report_.gui_work_s = std::accumulate(std::begin(load.part_s), std::end(load.part_s), 0.0);
            report_.gui_cpu_s = load.cpu_s;
            report_.gui_vertices = load.vertices_drawn;
            report_.gui_vertices_max = load.vertices_max;
            report_.gui_particles_max = load.particles_max;
            report_.gui_particles_s = load.part_s[static_cast<std::size_t>(FramePart::particles)];
            const auto path_s = [&load](VisualPathIndex i) {
                return load.path_s[static_cast<std::size_t>(i)];
            };
            report_.gui_mesh_s = path_s(VisualPathIndex::mesh);
            report_.gui_volume_s = path_s(VisualPathIndex::volume);
            report_.gui_molecules_s = path_s(VisualPathIndex::molecules);
            report_.gui_resolution_s = path_s(VisualPathIndex::resolution);
            report_.gui_molecules_max = load.molecule_triangles_max;
            report_.gui_pixels_max = load.pixels_max;
            report_.gui_refined = load.refined;
            report_.gui_particles = load.particles;
            report_.gui_molecules = load.molecule_triangles;
            report_.gui_pixels = load.pixels;
            if (settings_.arm_with_gui && load.vertices_drawn > 0) {
                settings_.arm_with_gui = false;
                order(CommandKind::arm, 0.0, 0);
            }
        } else {
            ++bad_input_;
        }
    }
    pass_on_frames();
    bad_input_ += commands_.pass_on(gui_->commands, settings_.path_names, mailbox_.orders);
}

void Housekeeping::follow_mouse() {
    const Instant now = Monotonic::now();
    if (!gui_.empty()) bad_input_ += mouse_.pass_on(gui_->mouse, now);
    if (mouse_.follow(now)) region_->mouse.publish(mouse_.state(now));
}

void Housekeeping::log_events() {
    EventTopic event{};
    for (int i = 0; i < 64 && region_->events.next(events_, event); ++i) {
        const auto code = static_cast<EventCode>(event.code);
        if (code == EventCode::fault_latched) {
            spdlog::error("cycle {}: {}", event.cycle, event_text(event));
            spdlog::error("fix: {}", fault_fix(event));
        } else if (code == EventCode::level_changed || code == EventCode::slew_limited ||
                   code == EventCode::torque_slew_limited) {
            spdlog::debug("cycle {}: {}", event.cycle, event_text(event));
        } else {
            spdlog::info("cycle {}: {}", event.cycle, event_text(event));
        }
    }
    FaultSnapshot s{};
    if (mailbox_.fault.count() == faults_seen_ || !mailbox_.fault.read(s)) return;
    faults_seen_ = mailbox_.fault.count();
    spdlog::error(
        "at the fault: cycle {}, late {:.1f} us, sample {:.1f} us old, at ({:.4f}, {:.4f}, {:.4f}) m, wanted "
        "({:.3f}, {:.3f}, {:.3f}) N, applied before ({:.3f}, {:.3f}, {:.3f}) N",
        s.cycle, static_cast<double>(s.lateness_ns) * 1e-3, static_cast<double>(s.sample_age_ns) * 1e-3,
        s.pos_world_m[0], s.pos_world_m[1], s.pos_world_m[2], s.wanted_n[0], s.wanted_n[1], s.wanted_n[2],
        s.applied_before_n[0], s.applied_before_n[1], s.applied_before_n[2]);
}

void Housekeeping::report() {
    report_.bad_input = bad_input_ + link_.refused();
    mailbox_.housekeeping.publish(report_);
}

void Housekeeping::notify_service(Instant now) {
    HealthTopic h{};
    if (!region_->health.read(h)) return;
    service_.update({.heartbeat = mailbox_.pulse.beat_ns.load(std::memory_order_relaxed),
                     .state = run_state_text(static_cast<RunState>(h.state)),
                     .rate_hz = h.force_rate_hz},
                    now);
}

}  // namespace tact
