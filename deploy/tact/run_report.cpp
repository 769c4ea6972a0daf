#include "deploy/tact/run_report.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>

#include "deploy/tact/observer.hpp"
#include "deploy/tact/systems.hpp"
#include "ipc/base/device_notice.hpp"
#include "ipc/topics/frames_json.hpp"
#include "ipc/topics/level_text.hpp"
#include "ipc/topics/text.hpp"
#include "ipc/version/version.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

double us(double ns) { return ns * 1e-3; }

std::string hex(std::uint64_t value) {
    std::array<char, 20> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
    return text.data();
}

json lateness_us(const LatenessTopic& l) {
    const auto at = [&l](double p) {
        return us(static_cast<double>(DurationHistogram::percentile_ns(l.counts, l.total, l.max_ns, p)));
    };
    return {{"p50", at(0.5)},
            {"p99", at(0.99)},
            {"p999", at(0.999)},
            {"max", us(static_cast<double>(l.max_ns))},
            {"count", l.total}};
}

json governor(const RtRegion& region, std::int64_t now_ns) {
    const auto levels = newest(region.levels);
    if (!levels) return nullptr;
    json paths = json::object();
    for (std::size_t i = 0; i < std::min<std::size_t>(levels->count, kPathsMax); ++i) {
        const PathLevel& p = levels->path[i];
        paths[field_text(p.path, kPathNameMax)] = {
            {"level", p.level},
            {"floor", p.floor},
            {"items", p.items},
            {"items_max", p.items_max},
            {"drawn", p.haptic != 0 ? json(nullptr) : json(p.drawn)},
            {"cost_us", p.cost_s * 1e6},
            {"error", p.error},
            {"reason", level_reason_text(static_cast<LevelReason>(p.reason))},
            {"status", level_status_text(p, now_ns)},
            {"changed_at_ns", p.changed_at_ns},
            {"haptic", p.haptic != 0}};
    }
    return {{"law", field_text(levels->law, kLawNameMax)},
            {"goal_hz", levels->goal_hz},
            {"rate_seen_hz", levels->rate_hz},
            {"paths", paths}};
}

// For each hand: the notice of its device and the bus counters of a driver that counts.
json devices(const HealthTopic& h) {
    json all = json::array();
    for (std::size_t i = 0; i < std::size(h.device_bus); ++i) {
        const BusCounts& b = h.device_bus[i];
        const bool counts = b.packets > 0 || !b.clean();
        if (i > 0 && !counts && h.device_notice[i] == 0) continue;  // this hand does not exist
        json device = {{"notice", device_notice_text(static_cast<DeviceNotice>(h.device_notice[i]))}};
        device["bus"] = !counts ? json(nullptr)
                                : json{{"packets", b.packets},
                                       {"checksum", b.checksum},
                                       {"refused", b.refused},
                                       {"repeated", b.repeated},
                                       {"lost", b.lost},
                                       {"transfers_failed", b.transfers_failed},
                                       {"stalls", b.stalls},
                                       {"reconnects", b.reconnects},
                                       {"commands_refused", b.commands_refused},
                                       {"bad_seconds", b.bad_seconds}};
        all.push_back(device);
    }
    return all;
}

json head(const RtRegion& region) {
    const auto h = newest(region.head);
    if (!h) return nullptr;  // no tracker, or no pose yet
    return {{"state", head_state_text(h->state)},
            {"link", head_link_text(h->link)},
            {"sequence", h->sequence},
            {"taken_at_ns", h->taken_at_ns},
            {"pos_screen_m", h->pos_screen_m},
            {"quat_screen_head_xyzw", h->quat_screen_head_xyzw},
            {"quality", h->quality},
            {"distortion", h->distortion}};
}

// Of every hand, the newest pose and force.
json tools(const RtRegion& region) {
    json all = json::array();
    for (const auto& tool : region.tool)
        if (const auto t = newest(tool))
            all.push_back({{"pos_world_m", t->pos_world_m},
                           {"quat_world_tool_xyzw", t->quat_world_tool_xyzw},
                           {"force_world_n", t->force_world_n},
                           {"buttons", t->buttons}});
    return all;
}

// Which hands a pointer in the window may lead, or leads.
json mouse(const RtRegion& region) {
    const auto m = newest(region.mouse);
    if (!m || !sensible(*m)) return nullptr;
    constexpr const char* kLeads[] = {"none", "may", "leads", "silent"};
    json hands = json::array();
    json by = json::array();
    for (const std::uint8_t lead : m->lead) hands.push_back(kLeads[lead]);
    for (const std::uint8_t device : m->by) by.push_back(kLeadDeviceNames[device]);
    return {{"hands", hands},
            {"devices", by},
            {"accepted", m->accepted},
            {"refused", m->refused},
            {"silences", m->stale}};
}

// Of the cycles with force since the start.
void add_armed_metrics(const HealthTopic& h, json& j) {
    const bool armed = h.armed_cycles > 0;
    const auto figure = [armed](double value) { return armed ? json(value) : json(nullptr); };
    j["armed_cycles"] = h.armed_cycles;
    j["deadline_misses"] = h.deadline_misses;
    j["deadline_miss_share"] = figure(static_cast<double>(h.deadline_misses) /
                                      static_cast<double>(std::max(h.armed_cycles, std::uint64_t{1})));
    j["deadline_miss_share_last_second"] = figure(static_cast<double>(h.deadline_miss_share));
    j["deadline_us"] = h.model_ns_max > 0 ? json(us(static_cast<double>(h.model_ns_max))) : json(nullptr);
    j["force_error_n_p50"] = figure(static_cast<double>(h.force_error_n_p50));
    j["force_step_n_max"] = figure(static_cast<double>(h.force_step_n_max));
    j["level_settled_s"] = figure(static_cast<double>(h.level_settled_s));
}

json ending_json(const Ending& e) {
    return {{"exit_code", e.by_signal ? json(nullptr) : json(e.number)},
            {"signal", e.by_signal ? json(e.number) : json(nullptr)},
            {"asked", e.asked},
            {"text", e.text()}};
}

}  // namespace

json controller_report(const RtRegion& region) {
    json j;
    const auto health = newest(region.health);
    if (!health) return j;
    const HealthTopic& h = *health;
    j["state"] = run_state_text(static_cast<RunState>(h.state));
    j["reason"] = run_reason_text(static_cast<RunReason>(h.reason));
    if (h.lines != 0) {
        j["lines"] = {{"state", lines_text(static_cast<LinesShown>(h.lines))},
                      {"reason", run_reason_text(static_cast<RunReason>(h.lines_reason))}};
    }
    j["force_rate_hz"] = h.force_rate_mean_hz;
    j["servo"] = {{"rate_window_hz", h.force_rate_hz},
                  {"period_us", h.period_ns > 0 ? json(us(static_cast<double>(h.period_ns))) : json(nullptr)},
                  {"free_running", h.period_ns == 0},
                  {"cycles", h.cycle},
                  {"overruns", h.overruns},
                  {"skipped", h.skipped},
                  {"allocations", h.allocations},
                  {"locks", h.locks},
                  {"page_faults", h.page_faults},
                  {"cycle_cost_us",
                   {{"p50", us(static_cast<double>(h.cycle_cost_p50_ns))},
                    {"max", us(static_cast<double>(h.cycle_cost_max_ns))}}},
                  {"schedule_flags", h.schedule_flags},
                  {"schedule", schedule_text(h.schedule_flags)},
                  {"fresh", {{"mean", h.recomputed_fraction_mean}, {"least", h.recomputed_fraction_least}}},
                  {"rested", h.rested},
                  {"bad_input", h.bad_input},
                  {"events", h.events}};
    if (const auto lateness = newest(region.lateness)) j["servo"]["lateness_us"] = lateness_us(*lateness);
    add_armed_metrics(h, j);
    j["gui"] = {{"attached", h.gui_attached != 0},
                {"fps", h.gui_fps},
                {"vertices", h.gui_vertices},
                {"heartbeat_age_ms", h.gui_heartbeat_age_ns >= 0
                                         ? json(static_cast<double>(h.gui_heartbeat_age_ns) * 1e-6)
                                         : json(nullptr)}};
    // Implausible frame metrics are omitted.
    const auto picture = newest(region.picture);
    j["gui"]["frames"] = picture && picture->taken_at_ns > 0 && plausible(picture->metrics)
                             ? frames_json(picture->metrics)
                             : json(nullptr);
    j["devices"] = devices(h);
    j["governor"] = governor(region, h.taken_at_ns);
    j["head"] = head(region);
    j["tools"] = tools(region);
    j["mouse"] = mouse(region);
    j["scene"] = {{"path", field_text(region.scene_path, sizeof region.scene_path)},
                  {"checksum", hex(region.scene_checksum)}};
    return j;
}

json run_report(const RtRegion* region, const SystemRun& system, const RunDescription& description) {
    json j = region != nullptr ? controller_report(*region) : json::object();
    if (region != nullptr) {
        j["bodies"] = json::array();  // stable keys: every report has them
        j["fit"] = nullptr;
        system.report(*region, j);
    }
    if (j.contains("gui")) {
        // The controller's last value is from the time when the window was closing.
        j["gui"]["fps_last"] = j["gui"]["fps"];
        if (description.fps_median) j["gui"]["fps"] = *description.fps_median;
        j["gui"]["ran"] = description.fps_median.has_value();
    }
    if (!j.contains("scene")) j["scene"] = {{"path", description.scene.string()}, {"checksum", nullptr}};
    j["session"] = description.session;
    j["seconds"] = description.length_s;
    j["versions"] = {{"tact", version()}, {"compiler", __VERSION__}};
    json ended = {{"ok", description.intended}, {"why", description.why_ended}};
    for (const auto& [name, ending] : description.endings) ended[name] = ending_json(ending);
    j["ended"] = ended;
    return j;
}

std::string report_text(const json& report) {
    return report.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string report_summary(const json& r) {
    std::array<char, 512> line{};
    std::string text;
    const auto add = [&](const char* format, auto... values) {
        std::snprintf(line.data(), line.size(), format, values...);
        text += line.data();
    };
    const auto number = [](const json& j) { return j.is_number() ? j.get<double>() : 0.0; };
    if (r.contains("servo") && r["servo"].contains("lateness_us")) {
        const json& l = r["servo"]["lateness_us"];
        add("force rate %.1f Hz; lateness us p50 %.1f, p99 %.1f, p99.9 %.1f, max %.0f; overruns %.0f\n",
            number(r["force_rate_hz"]), number(l["p50"]), number(l["p99"]), number(l["p999"]),
            number(l["max"]), number(r["servo"]["overruns"]));
        add("deadline misses %.0f (%.3f %% of the armed cycles); force error p50 %.3f N, largest force "
            "change per "
            "cycle %.3f N; level settled after %.2f s\n",
            number(r["deadline_misses"]), 100.0 * number(r["deadline_miss_share"]),
            number(r["force_error_n_p50"]), number(r["force_step_n_max"]), number(r["level_settled_s"]));
        if (r["servo"]["free_running"].get<bool>())
            add("free running; recomputed fraction %.0f %% in the last 0.1 s, minimum %.0f %%; idle %.0f %% "
                "of the time\n",
                100.0 * number(r["servo"]["fresh"]["mean"]), 100.0 * number(r["servo"]["fresh"]["least"]),
                100.0 * number(r["servo"]["rested"]));
        add("servo thread: %.0f allocations, %.0f locks, %.0f page faults; %s\n",
            number(r["servo"]["allocations"]), number(r["servo"]["locks"]), number(r["servo"]["page_faults"]),
            r["servo"]["schedule"].get<std::string>().c_str());
    }
    for (const System& system : systems()) text += system.summary(r);
    return text;
}

}  // namespace tact::launch
