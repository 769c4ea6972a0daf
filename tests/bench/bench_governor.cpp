#include "tests/bench/bench_governor.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"
#include "tests/bench/core_speed.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr auto kSpeedSample = std::chrono::milliseconds(300);  // beside each run

GovernorRun run(const fs::path& folder, const BenchScene& scene, double rate_hz, double seconds,
                const double* level) {
    const fs::path report = folder / "run.json", config = folder / "latch.toml";
    launch::write_whole(
        config, "[safety]\ntiming_latches = \"always\"\nlate_us_max = 1e6\nsample_age_us_max = 1e6\n");
    std::vector<std::string> arguments{"run",       scene.path.string(),     "--no-gui",  "--quiet",
                                       "--config",  config.string(),         "--session", "bench-governor",
                                       "--seconds", std::to_string(seconds), "--json",    report.string()};
    arguments.insert(arguments.end(), scene.arguments.begin(), scene.arguments.end());
    if (rate_hz > 0.0)
        arguments.insert(arguments.end(), {"--rate", std::to_string(rate_hz)});
    else
        arguments.emplace_back("--free-run");
    if (level != nullptr)
        arguments.insert(arguments.end(), {"--level", scene.knob + "=" + std::to_string(*level)});
    std::error_code ignored;
    fs::remove(report, ignored);
    run_program("tact", arguments, folder / "run.log",
                std::chrono::seconds(60) + std::chrono::milliseconds(std::llround(1e3 * seconds)));
    const json parsed = json::parse(launch::read_small(report), nullptr, false);
    const json::json_pointer code("/ended/tact-rt/exit_code");
    if (parsed.is_discarded() || (!parsed.contains("governor") && parsed.value(code, 1) != 0))
        throw StartupError("run " + scene.name, "the run failed: " + launch::read_small(folder / "run.log"),
                           "run the scene by hand: tact run SCENE");
    return governor_run_of(parsed);
}

}  // namespace

GovernorRun governor_run_of(const json& report) {
    const auto number = [&report](const char* key) {
        return report.value(key, json(nullptr)).is_number() ? report[key].get<double>() : 0.0;
    };
    const json governor = report.value("governor", json(nullptr));
    const bool published = governor.is_object();
    GovernorRun r;
    r.fault = !published || report.value("armed_cycles", std::uint64_t{0}) == 0 ||
              report.value("state", "") == "fault" || !report["ended"].value("ok", false);
    r.miss_share = number("deadline_miss_share");
    r.error_n = number("force_error_n_p50");
    r.step_n = number("force_step_n_max");
    r.settled_s = number("level_settled_s");
    r.rate_hz = number("force_rate_hz");
    if (!published) return r;
    for (const auto& [name, path] : governor["paths"].items())
        if (path.value("haptic", false)) r.level = path.value("level", 0.0);
    return r;
}

bool valid_level(const GovernorRun& fixed) {
    return !fixed.fault && fixed.miss_share < GovernorBenchSettings::kMissShareMost;
}

GovernorRun median_of(const std::vector<GovernorRun>& runs) {
    GovernorRun median;
    for (const auto value : {&GovernorRun::miss_share, &GovernorRun::error_n, &GovernorRun::step_n,
                             &GovernorRun::level, &GovernorRun::settled_s, &GovernorRun::rate_hz}) {
        std::vector<double> values;
        values.reserve(runs.size());
        for (const GovernorRun& r : runs) values.push_back(r.*value);
        std::sort(values.begin(), values.end());
        median.*value = values[values.size() / 2];
    }
    median.fault = std::any_of(runs.begin(), runs.end(), [](const GovernorRun& r) { return r.fault; });
    return median;
}

json governor_row(const GovernorRun& adaptive, const std::vector<GovernorRun>& fixed) {
    using S = GovernorBenchSettings;
    const GovernorRun* best = nullptr;
    for (const GovernorRun& f : fixed) {
        if (!valid_level(f)) continue;
        if (best == nullptr || f.error_n < best->error_n) best = &f;
    }
    const auto at_most = [](double value, double most) { return value <= most + 1e-9; };
    const bool on_time = !adaptive.fault && adaptive.miss_share < S::kMissShareMost;
    const bool settled = at_most(adaptive.settled_s, S::kSettledMost_s);
    const bool accurate = best == nullptr || at_most(adaptive.error_n, S::kErrorRatioMost * best->error_n);
    const bool smooth = best == nullptr || at_most(adaptive.step_n, S::kStepRatioMost * best->step_n);
    return {{"force_rate_hz", adaptive.rate_hz},
            {"level", adaptive.level},
            {"fault", adaptive.fault},
            {"deadline_miss_share", adaptive.miss_share},
            {"level_settled_s", adaptive.settled_s},
            {"force_error_n_p50", adaptive.error_n},
            {"force_step_n_max", adaptive.step_n},
            {"best_fixed_level", best != nullptr ? json(best->level) : json(nullptr)},
            {"best_fixed_error_n_p50", best != nullptr ? json(best->error_n) : json(nullptr)},
            {"best_fixed_step_n_max", best != nullptr ? json(best->step_n) : json(nullptr)},
            {"on_time", on_time},
            {"settled", settled},
            {"accurate", accurate},
            {"smooth", smooth},
            {"passed", on_time && settled && accurate && smooth}};
}

json bench_governor(const GovernorBenchSettings& settings) {
    const BenchFolder folder;
    const std::vector<BenchScene> scenes = bake_governor_scenes(settings.scenes, folder.path);
    if (settings.bake_only) {
        json files = json::array();
        for (const BenchScene& scene : scenes) files.push_back(scene.path.string());
        return {{"governor_scenes", files}};
    }
    json rows = json::array();
    bool passed = true, quiet = true;
    for (const BenchScene& scene : scenes) {
        for (const double rate_hz : settings.rates_hz) {
            std::fprintf(stderr, "%s%s at %s\n", scene.name.c_str(),
                         scene.atoms > 0 ? (", " + std::to_string(scene.atoms) + " atoms,").c_str() : "",
                         rate_hz > 0.0 ? (std::to_string(std::lround(rate_hz)) + " Hz").c_str()
                                       : "a free-running rate");
            // Before, between and after the fixed levels: the machine's speed changes meanwhile.
            CoreSpeed speed;
            const auto run_at = [&](const double* level) {
                speed.sample(kSpeedSample);
                return run(folder.path, scene, rate_hz, settings.seconds, level);
            };
            std::vector<GovernorRun> adaptive{run_at(nullptr)}, fixed;
            int valid = 0;
            for (auto level = scene.levels.rbegin();
                 level != scene.levels.rend() && valid < GovernorBenchSettings::kValidLevels; ++level) {
                fixed.push_back(run_at(&*level));
                if (!valid_level(fixed.back())) continue;
                ++valid;
                adaptive.push_back(run_at(nullptr));
            }
            json row = {{"scene", scene.name},
                        {"atoms", scene.atoms > 0 ? json(scene.atoms) : json(nullptr)},
                        {"rate_hz", rate_hz > 0.0 ? json(rate_hz) : json("free")}};
            row.update(governor_row(median_of(adaptive), fixed));
            row["adaptive_runs"] = adaptive.size();
            row["core_speed_spread"] = speed.spread();
            row["core_quiet"] = speed.spread() <= CoreSpeed::kQuietSpread;
            quiet = quiet && row["core_quiet"].get<bool>();
            passed = passed && row["passed"].get<bool>();
            std::fprintf(stderr, "  %s\n", row.dump().c_str());
            rows.push_back(std::move(row));
        }
    }
    return {{"governor", rows}, {"governor_passed", passed}, {"governor_core_quiet", quiet}};
}

}  // namespace tact
