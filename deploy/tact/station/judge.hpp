// Grades the measurements of tact station verify; a pure function.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deploy/tact/station/machine.hpp"

namespace tact::launch {

struct VerifyMetrics {
    double seconds = 0.0, rate_hz = 0.0;
    std::uint64_t cycles = 0, overruns = 0, skipped = 0, allocations = 0, locks = 0, page_faults = 0;
    std::uint32_t schedule_flags = 0;  // ScheduleFlag of ipc/topics/health.hpp
    double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
    int core = -1;                            // core of the servo; -1: not pinned
    std::optional<double> cyclictest_max_us;  // empty: not run, see cyclictest_text
    std::string cyclictest_text;              // where and when it ran, or the reason why not
    std::optional<std::uint64_t> smi_count;
    std::string smi_text;
    std::string kernel, machine;
    bool realtime_kernel = false;
    std::string arguments, arguments_wanted;  // wanted: from the journal; "": tact station setup was not run
    std::string governor;                     // frequency governor of the servo's core; "": no scaling
    std::int64_t verified_at_s = 0;
};

// Limits in microseconds. Pass: a station with an isolated core on a real-time kernel stays well below. Warn: a fifth
// of the period of a 1 kHz force loop (p99.9), and the whole period (maximum).
struct VerifyLimits {
    double p999_pass_us = 50.0, p999_warn_us = 200.0;
    double max_pass_us = 200.0, max_warn_us = 1000.0;
    double cyclictest_pass_us = 150.0, cyclictest_warn_us = 1000.0;
};

enum class Grade : std::uint8_t { pass, warn, fail };
struct Check {
    std::string name;
    Grade grade = Grade::pass;
    std::string text;
};

[[nodiscard]] const char* grade_text(Grade grade);
[[nodiscard]] std::vector<Check> judge_station(const VerifyMetrics& f, const VerifyLimits& limits);
[[nodiscard]] Grade worst_of(const std::vector<Check>& checks);
[[nodiscard]] nlohmann::json station_report_json(const VerifyMetrics& f, const VerifyLimits& limits);

}  // namespace tact::launch
