// CSV, JSON and summary of the rate experiments.
#include <algorithm>
#include <cmath>

#include "deploy/tact/files.hpp"
#include "tests/reproduce/rates.hpp"
#include "tests/reproduce/text.hpp"

namespace tact::launch {
namespace {

std::string whole(double v) { return std::to_string(std::lround(v)); }

double off_percent(double value, double of) { return of > 0.0 ? 100.0 * (value - of) / of : 0.0; }

nlohmann::json json_of(const RateSummary& s, double goal_hz, double settled_s) {
    if (s.seconds <= 0.0) return nullptr;
    nlohmann::json j{{"seconds", s.seconds},
                     {"rate_mean_hz", s.rate_mean_hz},
                     {"rate_worst_1s_hz", s.rate_worst_1s_hz},
                     {"step_work_done_anew", {{"mean", s.recomputed_fraction_mean}}},
                     {"strangers_share_of_core", s.foreign_share},
                     {"windows_disturbed_percent", s.disturbed_percent},
                     {"share_of_core",
                      {{"controller", s.used_share[0]},
                       {"visual", s.used_share[1]},
                       {"load", s.used_share[2]},
                       {"tick_source", s.used_share[3]}}},
                     {"vertices_mean", s.vertices_mean},
                     {"vertices_sd", s.vertices_sd},
                     {"structures_part_mean", s.structures_mean},
                     {"pixels_part_mean", s.pixels_mean},
                     {"level_changes", s.level_changes},
                     {"fps_mean", s.fps_mean},
                     {"level_force_min", s.level_force_min}};
    if (goal_hz > 0.0) {
        j["deviation_from_goal_percent"] = off_percent(s.rate_mean_hz, goal_hz);
        j["undisturbed_windows_below_95_percent_of_goal_percent"] = s.share_below_percent;
        j["settled_after_s"] = settled_s >= 0.0 ? nlohmann::json(settled_s) : nlohmann::json();
    }
    return j;
}

nlohmann::json json_of(const WorstWindow& w, double goal_hz) {
    if (w.t_s <= 0.0) return nullptr;
    nlohmann::json j{{"rate_hz", w.rate_hz},
                     {"at_s", w.t_s},
                     {"undisturbed_rate_hz", w.quiet_rate_hz},
                     {"step_work_done_anew_least", w.recomputed_fraction_least}};
    if (goal_hz > 0.0) j["percent_of_goal"] = 100.0 * w.rate_hz / goal_hz;
    return j;
}

// Appends the percentage of disturbed windows to the note.
std::string disturbed(const std::string& note, const RateSummary& s) {
    if (s.disturbed_percent <= 0.0) return note;
    return note + (note.empty() ? "" : "; ") +
           text("%.0f %% of the windows were disturbed by other programs or by a slower core",
                s.disturbed_percent);
}

std::string worst(const char* part, const WorstWindow& w, double goal_hz) {
    if (w.t_s <= 0.0) return "";
    const std::string quiet = w.quiet_rate_hz > 0.0
                                  ? text("undisturbed %.0f %%", 100.0 * w.quiet_rate_hz / goal_hz)
                                  : std::string("none undisturbed");
    return text(", worst 0.1 s %s load %.0f (%.0f %%; %s)", part, w.rate_hz, 100.0 * w.rate_hz / goal_hz,
                quiet.c_str());
}

// For a run with a goal: mean rate after settling, and the worst window of each part.
std::string held(const Run& run, const RateSummary& s) {
    return text("%.0f of %.0f (%+.1f %%)", s.rate_mean_hz, run.goal_hz,
                off_percent(s.rate_mean_hz, run.goal_hz)) +
           worst("without", run.worst_free, run.goal_hz) + worst("with", run.worst_loaded, run.goal_hz) +
           text("; %.0f %% of the work of each step recomputed", 100.0 * s.recomputed_fraction_mean);
}

}  // namespace

void write_rates(const Rates& r, const std::filesystem::path& out) {
    // Identifiers of the runs in the figures (draw.py).
    const std::pair<const Run*, const char*> kCases[] = {{&r.off, "off"},
                                                         {&r.low, "low"},
                                                         {&r.high, "high"},
                                                         {&r.on, "on"},
                                                         {&r.on_published, "on_paper"},
                                                         {&r.fifo_off, "fifo_off"},
                                                         {&r.fifo_on, "fifo_on"}};
    std::string csv =
        "run,case,goal_hz,t_s,external_load,force_rate_100ms_hz,strangers_share,update_processor_us,step_"
        "work_"
        "done_anew,disturbed,level_mesh,level_force,vertices,triangles,fps,part\n";
    for (const auto& [run, name] : kCases) {
        if (run->samples.empty()) continue;
        for (const RateRow& row : rate_rows(run->samples, run->phase.settle_s, r.fast_s(*run))) {
            const RateSample& s = row.sample;
            const RateWindow100& w = row.window;
            csv += text("\"%s\",%s,%.0f,%.3f,%d,%.2f,%.4f,%.2f,%.4f,%d,%.5f,%.5f,%u,%.0f,%.2f,%s\n",
                        run->name.c_str(), name, run->goal_hz, s.t_s, s.load ? 1 : 0, w.rate_hz,
                        w.foreign_share, 1e6 * w.update_s, w.recomputed_fraction, w.disturbed ? 1 : 0,
                        s.level_mesh, s.level_force, s.vertices, r.triangles(s.vertices), s.fps,
                        kRunPartNames[static_cast<std::size_t>(row.part)]);
        }
    }
    write_whole(out / "rates.csv", csv);
}

nlohmann::json json_of(const Rates& r) {
    nlohmann::json runs = nlohmann::json::array();
    for (const Run* const run : r.runs())
        runs.push_back({{"name", run->name},
                        {"law", run->law},
                        {"goal_hz", run->goal_hz > 0.0 ? nlohmann::json(run->goal_hz) : nlohmann::json()},
                        {"without_load", json_of(run->free, run->goal_hz, run->settled_free_s)},
                        {"with_load", json_of(run->loaded, run->goal_hz, run->settled_loaded_s)},
                        {"worst_100ms",
                         {{"start", json_of(run->worst_start, run->goal_hz)},
                          {"without_load", json_of(run->worst_free, run->goal_hz)},
                          {"with_load", json_of(run->worst_loaded, run->goal_hz)}}},
                        {"load_share_of_core", run->load_share}});
    return {{"quick", r.settings.quick},
            {"conditions",
             {{"core", r.core},
              {"precedence", precedence_text(r.settings.precedence)},
              {"scheduling", "ordinary, fair shares, except for the runs named FIFO"},
              {"time_slice", r.finely_shared ? "1 ms, by a tick source in all runs" : "the kernel's tick"},
              {"fps_max", r.settings.core.fps_max},
              {"window", "320x240"},
              {"drawing", "software, one thread"}}},
            {"scale",
             {{"vertices", r.scene.vertices},
              {"points_summed", r.scene.points_summed},
              {"atom_repeats", r.scale.atom_repeats},
              {"map_finer", r.scale.map_finer}}},
            {"reachable_under_load_hz", r.reach_hz},
            {"disturbed_windows",
             {{"update_time_over_fast_time_max", kSlowerMax},
              {"other_programs_fraction_max", kForeignShareMax},
              {"fast_us", 1e6 * r.fast_update_s},
              {"fast_us_fifo", 1e6 * r.fifo_fast_update_s},
              {"fast_is", "lower quartile over all windows of all runs with this scheduling"}}},
            {"runs", runs}};
}

std::vector<SummaryRow> summary_of(const Rates& r) {
    const double fall = -off_percent(r.off.loaded.rate_mean_hz, r.off.free.rate_mean_hz);
    const auto fewer = [&](const RateSummary& now, const RateSummary& before) {
        return -off_percent(r.triangles(now.vertices_mean), r.triangles(before.vertices_mean));
    };
    std::vector<SummaryRow> rows{
        {"5", "C: updates/s without adaptation", "about 550", whole(r.off.free.rate_mean_hz),
         disturbed("a current core is faster: each atom is summed " + std::to_string(r.scale.atom_repeats) +
                       " times (" + std::to_string(r.scene.points_summed) +
                       " points instead of the published 200) and the surface has " +
                       whole(r.triangles(r.scene.vertices)) + " triangles",
                   r.off.free)},
        {"5", "B: goal 800", "held", held(r.low, r.low.free),
         disturbed("the goal is 1.45 times C, as in the paper", r.low.free)},
        {"5", "A: goal 1200", "not reached",
         text("%.0f of %.0f, %.0f %% of the work of each step recomputed", r.high.free.rate_mean_hz,
              r.high.goal_hz, 100.0 * r.high.free.recomputed_fraction_mean),
         "the coarsest rendering still takes " + text("%.0f %% of the core (%.0f frames/s)",
                                                      100.0 * r.high.free.used_share[1],
                                                      r.high.free.fps_mean)},
        {"5, 6", "reduction of triangles at goal 800, percent", "72", whole(fewer(r.low.free, r.off.free)),
         text("%.0f to %.0f triangles on average, at %.1f instead of %.1f frames/s; published: 10140 to 2776",
              r.triangles(r.off.free.vertices_mean), r.triangles(r.low.free.vertices_mean),
              r.low.free.fps_mean, r.off.free.fps_mean)},
        {"7", "updates/s with load, no adaptation", "300 to 400 (-27 to -45 %)",
         text("%.0f (-%.0f %%)", r.off.loaded.rate_mean_hz, fall), disturbed("", r.off.loaded)},
        {"8", "updates/s with load, law " + r.settings.law, "near its goal", held(r.on, r.on.loaded),
         disturbed(text("without adaptation %.0f %% below this goal; settled %.1f s after the start of the "
                        "load; %.0f %% fewer triangles",
                        -off_percent(r.off.loaded.rate_mean_hz, r.on.goal_hz), r.on.settled_loaded_s,
                        fewer(r.on.loaded, r.off.loaded)),
                   r.on.loaded)}};
    if (!r.on_published.samples.empty())
        rows.push_back({"8", "the same, law sensitus", "near its goal",
                        held(r.on_published, r.on_published.loaded),
                        disturbed("the published law", r.on_published.loaded)});
    for (const Run* const run : {&r.on, &r.on_published}) {
        const RateSummary& s = run->loaded;
        if (s.seconds <= 0.0) continue;
        rows.push_back({"8", "triangles with load, law " + run->law, "not published",
                        text("%.0f +- %.0f, %d changes of the level in %.0f s", r.triangles(s.vertices_mean),
                             r.triangles(s.vertices_mean + s.vertices_sd) - r.triangles(s.vertices_mean),
                             s.level_changes, s.seconds),
                        ""});
    }
    const std::vector<SummaryRow> laws = summary_of(r.pairs());
    rows.insert(rows.end(), laws.begin(), laws.end());
    if (!r.fifo_on.samples.empty()) {
        const auto row = [&](const Run& run, const std::string& name, const std::string& differs) {
            rows.push_back({"8", name, "not tried",
                            held(run, run.loaded) + text("; %.1f frames/s", run.loaded.fps_mean), differs});
        };
        row(r.fifo_off, "the same with FIFO, no adaptation",
            "with priority, the force loop needs no law, at the cost of the frame rate");
        row(r.fifo_on, "the same with FIFO, law " + r.settings.law,
            text("the law holds the display goal of 15 frames/s with %.0f %% fewer triangles",
                 fewer(r.fifo_on.loaded, r.fifo_off.loaded)));
    }
    rows.push_back(
        {"7, 8", "share of the core used by the load, percent", "not published",
         text("%.0f without adaptation, %.0f with", 100.0 * r.off.load_share, 100.0 * r.on.load_share), ""});
    return rows;
}

}  // namespace tact::launch
