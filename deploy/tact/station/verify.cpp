#include "deploy/tact/station/verify.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "deploy/tact/child.hpp"
#include "deploy/tact/doctor.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/observer.hpp"
#include "deploy/tact/scene_cache.hpp"
#include "deploy/tact/servo_core.hpp"
#include "deploy/tact/signals.hpp"
#include "deploy/tact/station/cyclictest.hpp"
#include "deploy/tact/station/smi.hpp"
#include "ipc/base/error.hpp"
#include "ipc/station/station_report.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::launch {
namespace {

constexpr auto kStartLimit = std::chrono::seconds(120);
constexpr double kSettleS = 1.0;  // the first second belongs to the start of the controller
constexpr auto kReportEvery = std::chrono::seconds(10);

// verify arms without a person, so only emulated devices are permitted.
void need_emulated_device(const std::filesystem::path& config) {
    if (config.empty()) return;
    const std::string attempt = "verify with " + config.string();
    toml::table table;
    try {
        table = toml::parse_file(config.string());
    } catch (const toml::parse_error& e) {
        throw StartupError(attempt, std::string(e.description()),
                           "see deploy/tact.toml (/etc/tact/tact.toml) for every key");
    }
    for (const char* const hand : {"device", "device2"}) {
        const std::string unset = std::string(hand) == "device" ? "sim" : "none";
        const auto node = table[hand]["driver"];
        const std::string driver = node ? node.value_or(std::string("?")) : unset;
        if (driver != "sim" && driver != "sim-process" && driver != "none")
            throw StartupError(
                attempt,
                std::string(hand) + ".driver is \"" + driver + "\", but verify arms without a person",
                "give a configuration with the drivers \"sim\", or omit --config");
    }
}

std::string trimmed(const std::string& text) { return text.substr(0, text.find('\n')); }

// The cycles between two samples of a cumulative histogram.
void lateness_between(const LatenessTopic& before, const LatenessTopic& after, VerifyMetrics& f) {
    std::array<std::uint64_t, DurationHistogram::kBuckets> counts{};
    std::uint64_t total = 0;
    for (std::size_t b = 0; b < counts.size(); ++b) {
        counts[b] = after.counts[b] - std::min(before.counts[b], after.counts[b]);
        total += counts[b];
    }
    const std::uint64_t most_ns = DurationHistogram::longest_ns(counts.data(), after.max_ns);
    const auto us = [&](double p) {
        return static_cast<double>(DurationHistogram::percentile_ns(counts.data(), total, most_ns, p)) * 1e-3;
    };
    f.cycles = total;
    f.p50_us = us(0.5);
    f.p99_us = us(0.99);
    f.p999_us = us(0.999);
    f.max_us = static_cast<double>(most_ns) * 1e-3;
}

class Verification {
public:
    Verification(const VerifyOptions& options, const std::function<void(const std::string&)>& report)
        : o_(options),
          report_(report),
          session_("station-" + std::to_string(getpid())),
          observer_(session_),
          json_(scratch_.path() / "cyclictest.json") {}

    // False if a signal requested the end.
    bool run(const std::filesystem::path& scene, VerifyMetrics& f) {
        read_machine_state(f);
        start(scene);
        if (!wait_until_it_runs() || !pass(kSettleS, "start")) return false;
        f.core = servo_core(rt_->pid()).value_or(-1);
        const int core = std::max(f.core, 0);
        const CyclictestPlace place = place_for(f.core);
        f.governor = trimmed(
            read_small("/sys/devices/system/cpu/cpu" + std::to_string(core) + "/cpufreq/scaling_governor"));
        const auto late_before = newest(observer_.region().lateness);
        const auto health_before = newest(observer_.region().health);
        const SmiReading smi_before = read_smi_count(core);
        if (place.beside) start_cyclictest(place, f);
        if (!pass(o_.seconds, "controller")) return false;
        const auto health = newest(observer_.region().health);
        rt_->stop();
        rt_->wait(std::chrono::seconds(20));  // publishes the complete lateness at its end
        const auto late = newest(observer_.region().lateness);
        if (!health || !health_before || !late || !late_before)
            throw StartupError("verify this station", "the controller published no state",
                               "run tact-rt alone to find the cause");
        lateness_between(*late_before, *late, f);
        f.rate_hz = health->force_rate_mean_hz;
        f.overruns = health->overruns - health_before->overruns;
        f.skipped = health->skipped - health_before->skipped;
        f.allocations = health->allocations;
        f.locks = health->locks;
        f.page_faults = health->page_faults;
        f.schedule_flags = health->schedule_flags;
        if (!place.beside) {
            start_cyclictest(place, f);
            if (cyclictest_ && !pass(std::ceil(std::max(o_.seconds, 1.0)), "cyclictest")) return false;
        }
        finish_cyclictest(f);
        const SmiReading smi = read_smi_count(core);
        f.smi_text = smi.why_not.empty() ? smi_before.why_not : smi.why_not;
        if (smi.count && smi_before.count) {
            f.smi_count = smi_between(*smi_before.count, *smi.count);
            f.smi_text = "on core " + std::to_string(core);
        }
        return true;
    }

private:
    void read_machine_state(VerifyMetrics& f) const {
        f.seconds = o_.seconds;
        f.verified_at_s = static_cast<std::int64_t>(std::time(nullptr));
        f.kernel = kernel_identity();
        f.machine = machine_identity();
        f.realtime_kernel = trimmed(read_small("/sys/kernel/realtime")) == "1" ||
                            f.kernel.find("PREEMPT_RT") != std::string::npos;
        f.arguments = trimmed(read_small("/proc/cmdline"));
    }

    void start(const std::filesystem::path& scene) {
        ChildSettings s;
        s.arguments = {scene.string(), "--session", session_, "--arm", "--hand", "wander"};
        if (!o_.config.empty()) s.arguments.insert(s.arguments.end(), {"--config", o_.config.string()});
        if (o_.core >= 0) s.arguments.insert(s.arguments.end(), {"--core", std::to_string(o_.core)});
        s.environment = {{"NOTIFY_SOCKET", ""}};
        log_ = scratch_.path() / "tact-rt.log";
        s.output_fd = open(log_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
        rt_.emplace("tact-rt", find_program("tact-rt", o_.programs), s);
        if (s.output_fd >= 0) close(s.output_fd);
    }

    void need_controller() {
        if (!rt_->poll()) return;
        throw StartupError("verify this station", "tact-rt " + rt_->poll()->text() + ":\n" + read_small(log_),
                           "fix the reported problem, then repeat the command");
    }

    bool wait_until_it_runs() {
        const Instant end = Monotonic::now() + kStartLimit;
        for (;;) {
            if (signals_.wait(50) != 0) return false;
            need_controller();
            observer_.poll();
            const auto h = observer_.seen() ? newest(observer_.region().health) : std::nullopt;
            if (h && h->cycle > 0 && newest(observer_.region().lateness)) return true;
            if (Monotonic::now() > end)
                throw StartupError("verify this station", "the controller did not start within 120 s",
                                   "run tact-rt alone to find the cause");
        }
    }

    // False if a signal requested the end.
    bool pass(double seconds, const char* what) {
        const Instant begin = Monotonic::now();
        Instant reported = begin;
        for (;;) {
            const double done = to_s(Monotonic::now() - begin);
            if (done >= seconds) return true;
            if (signals_.wait(50) != 0) return false;
            if (rt_ && !cyclictest_after_) need_controller();
            observer_.poll();
            if (cyclictest_after_ && cyclictest_->poll()) return true;
            if (Monotonic::now() - reported < kReportEvery) continue;
            reported = Monotonic::now();
            char text[80];
            static_cast<void>(std::snprintf(text, sizeof text, "%s: %.0f of %.0f s", what, done, seconds));
            report_(text);
        }
    }

    CyclictestPlace place_for(int servo) const {
        const auto isolated = parse_core_list(read_small("/sys/devices/system/cpu/isolated"));
        const auto siblings = parse_core_list(read_small(
            "/sys/devices/system/cpu/cpu" + std::to_string(servo) + "/topology/thread_siblings_list"));
        return place_cyclictest(servo, isolated, siblings);
    }

    void start_cyclictest(const CyclictestPlace& place, VerifyMetrics& f) {
        const auto program = find_in_path("cyclictest");
        f.cyclictest_text = place.text;
        if (program.empty()) {
            f.cyclictest_text = "cyclictest is not installed (apt-get install rt-tests)";
            return;
        }
        cyclictest_after_ = !place.beside;
        ChildSettings s;
        s.arguments = cyclictest_arguments(place.core, o_.seconds, json_.string());
        s.output_fd =
            open((scratch_.path() / "cyclictest.log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
        cyclictest_.emplace("cyclictest", program, s);
        if (s.output_fd >= 0) close(s.output_fd);
    }

    void finish_cyclictest(VerifyMetrics& f) {
        if (!cyclictest_) return;
        const auto& ending = cyclictest_->wait(std::chrono::seconds(30));
        if (ending && ending->clean()) f.cyclictest_max_us = parse_cyclictest(read_small(json_));
        if (!f.cyclictest_max_us)
            f.cyclictest_text = "cyclictest " + (ending ? ending->text() : std::string("did not end")) +
                                ": " + trimmed(read_small(scratch_.path() / "cyclictest.log"));
    }

    const VerifyOptions& o_;
    const std::function<void(const std::string&)>& report_;
    Signals signals_;
    ScratchFolder scratch_;
    std::string session_;
    Observer observer_;
    std::filesystem::path json_, log_;
    std::optional<Child> rt_, cyclictest_;
    bool cyclictest_after_ = false;
};

}  // namespace

std::optional<VerifyMetrics> measure_station(const VerifyOptions& options,
                                             const std::function<void(const std::string&)>& report) {
    need_emulated_device(options.config);
    const std::filesystem::path scene =
        options.scene.empty() ? baked_scene({.inputs = {}, .words = {"demo", "dock"}, .options = {}})
                              : options.scene;
    if (scene.empty()) return std::nullopt;
    VerifyMetrics f;
    Verification verification(options, report);
    if (!verification.run(scene, f)) return std::nullopt;
    return f;
}

}  // namespace tact::launch
