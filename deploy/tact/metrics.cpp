#include "deploy/tact/metrics.hpp"

#include <cmath>
#include <cstring>

#include "deploy/tact/metrics_station.hpp"
#include "ipc/base/histogram.hpp"
#include "ipc/base/run_state.hpp"
#include "ipc/topics/frames.hpp"
#include "ipc/topics/text.hpp"
#include "ipc/version/version.hpp"

namespace tact::launch {
namespace {

constexpr double kNs = 1e-9;
constexpr auto kNotAReason = static_cast<RunReason>(255);
// Histogram edges of the lateness: from a quiet machine to delays that a person feels.
constexpr double kEdgesS[] = {1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2};

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\' || c == '"') out += '\\';
        out += c == '\n' ? ' ' : c;
    }
    return out;
}

std::string number(double value) {
    char text[40];
    static_cast<void>(std::snprintf(text, sizeof text, "%.9g", value));
    return text;
}

class Page {
public:
    explicit Page(const std::string& session) : session_("session=\"" + escaped(session) + "\"") {}
    void about(const char* name, const char* type, const char* help) {
        name_ = name;
        text_ += std::string("# HELP ") + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
    }
    void value(double v, const std::string& labels = "", const char* suffix = "") {
        if (!std::isfinite(v)) return;
        text_ +=
            name_ + suffix + "{" + session_ + (labels.empty() ? "" : "," + labels) + "} " + number(v) + "\n";
    }
    void one(const char* name, const char* type, const char* help, double v) {
        about(name, type, help);
        value(v);
    }
    [[nodiscard]] std::string take() { return std::move(text_); }

private:
    std::string session_, name_, text_;
};

std::string label(const char* name, const std::string& value) {
    return std::string(name) + "=\"" + escaped(value) + "\"";
}

void lateness(Page& page, const LatenessTopic& l) {
    page.about("tact_servo_lateness_seconds", "histogram",
               "lateness of the start of servo cycles, since the controller started");
    std::uint64_t seen = 0;
    std::size_t bucket = 0;
    double sum_s = 0.0;
    const auto upper_s = [](std::size_t b) {
        return kNs * static_cast<double>(DurationHistogram::upper_ns(b));
    };
    const auto take_up_to = [&](double edge_s) {
        for (; bucket < DurationHistogram::kBuckets && upper_s(bucket) <= edge_s; ++bucket) {
            seen += l.counts[bucket];
            sum_s += static_cast<double>(l.counts[bucket]) * upper_s(bucket);
        }
    };
    for (const double edge_s : kEdgesS) {
        take_up_to(edge_s);
        page.value(static_cast<double>(seen), label("le", number(edge_s)), "_bucket");
    }
    take_up_to(INFINITY);
    page.value(static_cast<double>(seen), label("le", "+Inf"), "_bucket");
    page.value(sum_s, "", "_sum");
    page.value(static_cast<double>(seen), "", "_count");
}

void health(Page& page, const HealthTopic& h) {
    const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
    page.one("tact_force_rate_hertz", "gauge", "force updates in the last second", h.force_rate_hz);
    page.one("tact_force_rate_goal_hertz", "gauge", "force rate that the governor holds", h.goal_hz);
    page.one("tact_servo_cycles_total", "counter", "servo cycles", count(h.cycle));
    page.one("tact_servo_overruns_total", "counter", "cycles that ended after the next one was due",
             count(h.overruns));
    page.one("tact_servo_skipped_periods_total", "counter", "periods skipped because of overruns",
             count(h.skipped));
    page.one("tact_force_deadline_misses_total", "counter",
             "steps of the force model that ended after their deadline", count(h.deadline_misses));
    page.one("tact_force_error_newtons", "gauge", "median bound of the force error since the start",
             static_cast<double>(h.force_error_n_p50));
    page.one("tact_servo_allocations_total", "counter", "heap calls on the servo thread inside cycles",
             count(h.allocations));
    page.one("tact_servo_locks_total", "counter", "locks on the servo thread inside cycles", count(h.locks));
    page.one("tact_servo_page_faults_total", "counter", "page faults of the servo thread",
             count(h.page_faults));
    page.one("tact_refused_records_total", "counter", "invalid records from the visual process",
             count(h.bad_input));
    page.one("tact_servo_work_max_seconds", "gauge", "longest work of a cycle in the last second",
             kNs * static_cast<double>(h.cycle_cost_max_ns));
    if (h.delay_p99_ns > 0)
        page.one("tact_device_delay_seconds", "gauge",
                 "delay from the encoders to the motors, p99 of the last second",
                 kNs * static_cast<double>(h.delay_p99_ns));
    page.about("tact_state", "gauge", "1 for the state that the controller is in");
    for (int s = 0; s <= static_cast<int>(RunState::fault); ++s)
        page.value(h.state == s ? 1.0 : 0.0, label("state", run_state_text(static_cast<RunState>(s))));
    page.one("tact_display_attached", "gauge", "1 if a window is attached", h.gui_attached != 0 ? 1.0 : 0.0);
    page.one("tact_display_rate_hertz", "gauge", "frames in the last second", h.gui_fps);
    if (h.gui_fps > 0.0)
        page.one("tact_frame_time_seconds", "gauge", "mean frame time in the last second", 1.0 / h.gui_fps);
    page.about("tact_device_bus_errors_total", "counter", "errors on the bus of a haptic device");
    for (std::size_t hand = 0; hand < kHandsMax; ++hand) {
        const BusCounts& b = h.device_bus[hand];
        for (const auto& [kind, n] : {std::pair{"checksum", b.checksum},
                                      {"refused", b.refused},
                                      {"repeated", b.repeated},
                                      {"lost", b.lost},
                                      {"transfer", b.transfers_failed},
                                      {"stall", b.stalls},
                                      {"reconnect", b.reconnects}})
            page.value(n, label("hand", std::to_string(hand + 1)) + "," + label("kind", kind));
    }
}

void devices(Page& page, const DevicesTopic& d) {
    const auto each = [&](const char* name, const char* type, const char* help, const auto& of,
                          const auto& has) {
        page.about(name, type, help);
        for (std::size_t hand = 0; hand < kHandsMax; ++hand)
            if (d.hand[hand].valid != 0 && has(d.hand[hand]))
                page.value(of(d.hand[hand]), label("hand", std::to_string(hand + 1)));
    };
    const auto always = [](const DeviceHand&) { return true; };
    each(
        "tact_device_samples_total", "counter", "samples from the device of a hand",
        [](const DeviceHand& h) { return static_cast<double>(h.samples); }, always);
    each(
        "tact_device_sample_age_seconds", "gauge",
        "age of the oldest sample used by a cycle in the last 0.1 s",
        [](const DeviceHand& h) { return kNs * static_cast<double>(h.age_ns_most); },
        [](const DeviceHand& h) { return h.age_ns_most >= 0; });
    each(
        "tact_motor_heat_ratio", "gauge", "heat of the motors; 1: only the continuous force is left",
        [](const DeviceHand& h) { return static_cast<double>(h.heat); },
        [](const DeviceHand& h) { return h.force_n_continuous > 0.0F; });
    each(
        "tact_motor_winding_celsius", "gauge",
        "temperature of the hottest winding of a device, calculated by its driver",
        [](const DeviceHand& h) { return static_cast<double>(h.winding_c); },
        [](const DeviceHand& h) { return h.winding_c_max > 0.0F; });
    each(
        "tact_motor_winding_max_celsius", "gauge", "winding temperature that the driver allows",
        [](const DeviceHand& h) { return static_cast<double>(h.winding_c_max); },
        [](const DeviceHand& h) { return h.winding_c_max > 0.0F; });
}

void tracker(Page& page, const TrackerTopic& t) {
    page.one("tact_tracker_fresh", "gauge", "1 if the head is tracked", t.state == 2 ? 1.0 : 0.0);
    page.one("tact_tracker_samples_total", "counter", "good poses of the head tracker",
             static_cast<double>(t.samples));
    page.about("tact_tracker_errors_total", "counter", "errors in frames and link of the head tracker");
    for (const auto& [kind, n] : {std::pair{"missed", t.missed},
                                  {"refused", t.refused},
                                  {"dropped", t.dropped},
                                  {"flood", t.floods},
                                  {"bus", t.bus_errors},
                                  {"link", t.link_losses}})
        page.value(static_cast<double>(n), label("kind", kind));
}

void levels(Page& page, const LevelsTopic& l) {
    const std::size_t count = std::min<std::size_t>(l.count, kPathsMax);
    const auto each = [&](const char* name, const char* help, const auto& of) {
        page.about(name, "gauge", help);
        for (std::size_t i = 0; i < count; ++i)
            page.value(of(l.path[i]), label("path", field_text(l.path[i].path, kPathNameMax)));
    };
    each("tact_level", "fidelity of a path, 0 to 1",
         [](const PathLevel& p) { return static_cast<double>(p.level); });
    each("tact_level_items", "number of items of a path at its level: points, vertices, rays",
         [](const PathLevel& p) { return static_cast<double>(p.items); });
    each("tact_level_cost_seconds", "measured time of a path's step",
         [](const PathLevel& p) { return p.cost_s; });
}

void picture(Page& page, const FrameMetrics& f) {
    const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
    page.one("tact_frames_total", "counter", "frames since the window started", count(f.frames));
    page.one("tact_frames_late_total", "counter", "frames shown more than half a period after their due time",
             count(f.late));
    if (f.due_s > 0.0) page.one("tact_frame_due_seconds", "gauge", "period of the display", f.due_s);
    page.about("tact_frame_seconds", "summary", "frame time of the last frames");
    for (const auto& [q, s] :
         {std::pair{"0.5", f.p50_s}, std::pair{"0.99", f.p99_s}, std::pair{"1", f.most_s}})
        page.value(static_cast<double>(s), label("quantile", q));
    const auto times = [&page](const char* name, const char* help, const char* key, std::size_t n,
                               const auto& text, const PassMetrics* of, bool drawn) {
        page.about(name, "summary", help);
        for (std::size_t i = 0; i < n; ++i) {
            const float p50_s = drawn ? of[i].drawn_p50_s : of[i].work_p50_s;
            const float p99_s = drawn ? of[i].drawn_p99_s : of[i].work_p99_s;
            if (p50_s < 0.0F) continue;  // unknown
            for (const auto& [q, s] : {std::pair{"0.5", p50_s}, std::pair{"0.99", p99_s}})
                page.value(static_cast<double>(s), label(key, text(i)) + "," + label("quantile", q));
        }
    };
    const auto pass = [](std::size_t i) { return std::string(pass_text(static_cast<Pass>(i))); };
    const auto path = [](std::size_t i) { return std::string(visual_path_text(i)); };
    times("tact_pass_work_seconds", "processor time of one rendering pass", "pass", kPasses, pass, f.pass,
          false);
    times("tact_pass_drawn_seconds", "rendering time of one pass, if known", "pass", kPasses, pass, f.pass,
          true);
    times("tact_path_work_seconds", "processor time of a visual path per frame", "path", kVisualPaths, path,
          f.path, false);
    times("tact_path_drawn_seconds", "rendering time of a visual path per frame, if known", "path",
          kVisualPaths, path, f.path, true);
    page.one("tact_display_gl_objects", "gauge", "objects of the graphics driver in use",
             count(f.gl_objects));
    page.one("tact_display_heap_bytes", "gauge", "heap of the visual process", count(f.heap_bytes));
    page.one("tact_display_resident_bytes", "gauge", "resident memory of the visual process",
             count(f.resident_bytes));
}

}  // namespace

Metrics::Metrics(std::string session) : session_(std::move(session)) {
    faults_[run_reason_name(kNotAReason)] = 0;
    for (int r = 0; r <= static_cast<int>(kLastRunReason); ++r)
        if (const auto reason = static_cast<RunReason>(r); latches_fault(reason))
            faults_[run_reason_name(reason)] = 0;
}

void Metrics::follow(const RtRegion& region, std::uint64_t generation) {
    if (generation_ != generation) {
        generation_ = generation;
        missed_before_ += cursor_.missed;
        cursor_ = {};
        ++controllers_;
    }
    ended_in_order_.reset();
    EventTopic event{};
    while (region.events.next(cursor_, event)) {
        if (event.code != static_cast<std::uint16_t>(EventCode::fault_latched)) continue;
        const bool known = event.a >= 0.0 && event.a <= static_cast<double>(kLastRunReason);
        const auto reason = known ? static_cast<RunReason>(static_cast<int>(event.a)) : kNotAReason;
        ++faults_[run_reason_name(latches_fault(reason) ? reason : kNotAReason)];
    }
}

void Metrics::left(const RtRegion& region, std::uint64_t generation) {
    follow(region, generation);
    const auto h = newest(region.health);
    ended_in_order_ = h && h->state == static_cast<std::uint8_t>(RunState::off);
}

std::string Metrics::text(const RtRegion* region) const {
    Page page(session_);
    page.about("tact_build_info", "gauge", "1; the label is the version of the exporter");
    page.value(1.0, label("version", version()));
    page.one("tact_up", "gauge", "1 if a controller runs", region != nullptr ? 1.0 : 0.0);
    page.one("tact_controllers_seen_total", "counter", "controllers attached to since the exporter started",
             static_cast<double>(controllers_));
    page.about("tact_faults_total", "counter", "faults that stopped the force, by cause");
    for (const auto& [cause, count] : faults_) page.value(static_cast<double>(count), label("cause", cause));
    const std::string station = station_metrics(label("session", session_));
    page.one("tact_events_missed_total", "counter",
             "controller events that the exporter did not read in time; faults may be among them",
             static_cast<double>(missed_before_ + cursor_.missed));
    if (region == nullptr) {
        if (ended_in_order_)
            page.one("tact_controller_ended_in_order", "gauge",
                     "0 if the last controller was killed or crashed, 1 if it ended in order",
                     *ended_in_order_ ? 1.0 : 0.0);
        return page.take() + station;
    }
    if (const auto h = newest(region->health)) health(page, *h);
    if (const auto d = newest(region->devices)) devices(page, *d);
    if (const auto t = newest(region->tracker)) tracker(page, *t);
    if (const auto l = newest(region->lateness)) lateness(page, *l);
    if (const auto l = newest(region->levels)) levels(page, *l);
    if (const auto p = newest(region->picture); p && p->taken_at_ns > 0 && plausible(p->metrics))
        picture(page, p->metrics);
    return page.take() + station;
}

}  // namespace tact::launch
