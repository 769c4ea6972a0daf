#include "deploy/tact/metrics_station.hpp"

#include <cstdio>
#include <utility>

namespace tact::launch {
namespace {

std::string number(double value) {
    char text[40];
    static_cast<void>(std::snprintf(text, sizeof text, "%.10g", value));
    return text;
}

std::string about(const char* name, const char* help) {
    return std::string("# HELP ") + name + " " + help + "\n# TYPE " + name + " gauge\n";
}

}  // namespace

std::string station_metrics(const std::string& labels, const std::optional<StationReport>& report,
                            const std::string& machine, const std::string& kernel) {
    const auto value = [&](const char* name, const std::string& more, double v) {
        return std::string(name) + "{" + labels + more + "} " + number(v) + "\n";
    };
    std::string text = about("tact_station_report", "1 if a report of tact station verify exists") +
                       value("tact_station_report", "", report ? 1.0 : 0.0);
    if (!report) return text;
    text += about("tact_station_status", "1 for the status in the report");
    for (const char* const status : {"pass", "warn", "fail"})
        text += value("tact_station_status", std::string(",status=\"") + status + "\"",
                      report->status == status ? 1.0 : 0.0);
    text +=
        about("tact_station_applies", "1 if machine and kernel match the report") +
        value("tact_station_applies", "", report->machine == machine && report->kernel == kernel ? 1.0 : 0.0);
    text += about("tact_station_verified_timestamp_seconds", "time of the report (Unix time)") +
            value("tact_station_verified_timestamp_seconds", "", static_cast<double>(report->verified_at_s));
    text += about("tact_station_lateness_seconds",
                  "lateness of the servo in the report; quantile 1: the largest");
    for (const auto& [q, us] : {std::pair{"0.5", report->p50_us},
                                {"0.99", report->p99_us},
                                {"0.999", report->p999_us},
                                {"1", report->max_us}})
        text += value("tact_station_lateness_seconds", std::string(",quantile=\"") + q + "\"", us * 1e-6);
    if (report->cyclictest_max_us)
        text += about("tact_station_cyclictest_max_seconds", "largest latency of cyclictest in the report") +
                value("tact_station_cyclictest_max_seconds", "", *report->cyclictest_max_us * 1e-6);
    if (report->smi_count)
        text +=
            about("tact_station_smi", "system management interrupts during the measurement of the report") +
            value("tact_station_smi", "", static_cast<double>(*report->smi_count));
    return text;
}

std::string station_metrics(const std::string& labels) {
    std::string refusal;
    return station_metrics(labels, read_station_report(station_report_path(), refusal), machine_identity(),
                           kernel_identity());
}

}  // namespace tact::launch
