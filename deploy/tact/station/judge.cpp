#include "deploy/tact/station/judge.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <utility>

#include "ipc/station/station_report.hpp"
#include "ipc/topics/health.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

std::string us_text(double us) {
    char text[40];
    static_cast<void>(std::snprintf(text, sizeof text, "%.1f us", us));
    return text;
}

Check timed(const char* name, double us, double pass_us, double warn_us) {
    // Written so that NaN fails.
    const Grade grade = us <= pass_us ? Grade::pass : us <= warn_us ? Grade::warn : Grade::fail;
    return {name, grade,
            us_text(us) + " (pass up to " + us_text(pass_us) + ", warn up to " + us_text(warn_us) + ")"};
}

Check required(const char* name, bool good, Grade otherwise, const std::string& yes, const std::string& no) {
    return {name, good ? Grade::pass : otherwise, good ? yes : no};
}

std::string missing_arguments(const std::string& wanted, const std::string& in) {
    std::istringstream present(in), list(wanted);
    std::vector<std::string> have;
    for (std::string name; present >> name;) have.push_back(name);
    std::string missing;
    for (std::string name; list >> name;)
        if (std::find(have.begin(), have.end(), name) == have.end())
            missing += (missing.empty() ? "" : " ") + name;
    return missing;
}

}  // namespace

const char* grade_text(Grade grade) {
    return grade == Grade::pass ? "pass" : grade == Grade::warn ? "warn" : "fail";
}

std::vector<Check> judge_station(const VerifyMetrics& f, const VerifyLimits& l) {
    std::vector<Check> checks;
    checks.push_back(timed("lateness_p999", f.p999_us, l.p999_pass_us, l.p999_warn_us));
    checks.push_back(timed("lateness_max", f.max_us, l.max_pass_us, l.max_warn_us));
    if (f.cyclictest_max_us)
        checks.push_back(
            timed("cyclictest_max", *f.cyclictest_max_us, l.cyclictest_pass_us, l.cyclictest_warn_us));
    else
        checks.push_back({"cyclictest_max", Grade::warn, "not measured: " + f.cyclictest_text});
    checks.push_back(required("cycles", f.cycles > 0, Grade::fail, std::to_string(f.cycles) + " cycles",
                              "the servo made no cycle"));
    const std::uint64_t missed = f.overruns + f.skipped;
    checks.push_back(required(
        "overruns", missed == 0, Grade::warn, "none",
        std::to_string(f.overruns) + " overruns, " + std::to_string(f.skipped) + " periods skipped"));
    const std::uint64_t calls = f.allocations + f.locks + f.page_faults;
    checks.push_back(required("servo_calls", calls == 0, Grade::fail, "no heap call, lock or page fault",
                              std::to_string(f.allocations) + " heap calls, " + std::to_string(f.locks) +
                                  " locks, " + std::to_string(f.page_faults) + " page faults"));
    constexpr std::uint32_t kWanted =
        kScheduleFifo | kSchedulePinned | kScheduleIsolated | kScheduleLocked | kScheduleDmaLatency;
    std::string lacks;
    for (const auto& [flag, name] : {std::pair{kScheduleFifo, "FIFO priority"},
                                     {kSchedulePinned, "a core of its own"},
                                     {kScheduleIsolated, "isolation of that core"},
                                     {kScheduleLocked, "locked memory"},
                                     {kScheduleDmaLatency, "/dev/cpu_dma_latency"}})
        if ((f.schedule_flags & flag) == 0) lacks += (lacks.empty() ? "" : ", ") + std::string(name);
    checks.push_back(required("scheduling", (f.schedule_flags & kWanted) == kWanted, Grade::warn,
                              "FIFO priority, isolated core, locked memory",
                              "missing for the servo: " + lacks));
    checks.push_back(required("kernel", f.realtime_kernel, Grade::warn, "real-time: " + f.kernel,
                              "not a real-time kernel: " + f.kernel));
    const std::string missing = missing_arguments(f.arguments_wanted, f.arguments);
    if (f.arguments_wanted.empty())
        checks.push_back({"kernel_arguments", Grade::warn, "tact station setup has not been run here"});
    else
        checks.push_back(required("kernel_arguments", missing.empty(), Grade::warn, "in force as set up",
                                  "not in force: " + missing + " (restart the machine)"));
    checks.push_back(required("governor", f.governor.empty() || f.governor == "performance", Grade::warn,
                              f.governor.empty() ? "this machine has no frequency scaling" : f.governor,
                              f.governor + ", expected performance"));
    if (f.smi_count)
        checks.push_back(required("smi", *f.smi_count == 0, Grade::warn, "none",
                                  std::to_string(*f.smi_count) +
                                      " system management interrupts: disable USB legacy support and power "
                                      "management in the firmware set-up"));
    else
        checks.push_back({"smi", Grade::pass, "not counted: " + f.smi_text});
    return checks;
}

Grade worst_of(const std::vector<Check>& checks) {
    Grade worst = Grade::pass;
    for (const Check& check : checks) worst = std::max(worst, check.grade);
    return worst;
}

json station_report_json(const VerifyMetrics& f, const VerifyLimits& l) {
    const std::vector<Check> checks = judge_station(f, l);
    json list = json::array();
    for (const Check& c : checks)
        list.push_back({{"name", c.name}, {"status", grade_text(c.grade)}, {"text", c.text}});
    json cyclictest = {{"text", f.cyclictest_text}}, smi = {{"text", f.smi_text}};
    if (f.cyclictest_max_us) cyclictest["max_us"] = *f.cyclictest_max_us;
    if (f.smi_count) smi["count"] = *f.smi_count;
    return {{"format", kStationReportFormat},
            {"version", kStationReportVersion},
            {"status", grade_text(worst_of(checks))},
            {"verified_at_s", f.verified_at_s},
            {"machine", f.machine},
            {"kernel", f.kernel},
            {"kernel_arguments", {{"in_force", f.arguments}, {"wanted", f.arguments_wanted}}},
            {"governor", f.governor},
            {"seconds", f.seconds},
            {"rate_hz", f.rate_hz},
            {"cycles", f.cycles},
            {"overruns", f.overruns},
            {"skipped_periods", f.skipped},
            {"core", f.core},
            {"lateness_us", {{"p50", f.p50_us}, {"p99", f.p99_us}, {"p999", f.p999_us}, {"max", f.max_us}}},
            {"cyclictest", cyclictest},
            {"smi", smi},
            {"thresholds_us",
             {{"lateness_p999", {{"pass", l.p999_pass_us}, {"warn", l.p999_warn_us}}},
              {"lateness_max", {{"pass", l.max_pass_us}, {"warn", l.max_warn_us}}},
              {"cyclictest_max", {{"pass", l.cyclictest_pass_us}, {"warn", l.cyclictest_warn_us}}}}},
            {"checks", list}};
}

}  // namespace tact::launch
