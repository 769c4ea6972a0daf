// The report of tact station verify, for the controller and the metrics.
//
// File     /var/lib/tact/station-report.json, or the path in TACT_STATION_REPORT; written by
//          deploy/tact/station
// Input    untrusted: any text that is not such a report, and impossible numbers, are refused
// Thread   start-up, or one that may wait for the disk
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tact {

inline constexpr const char* kStationReportPath = "/var/lib/tact/station-report.json";
inline constexpr const char* kStationReportFormat = "tact station report";
inline constexpr int kStationReportVersion = 1;

struct StationReport {
    std::string status;                                              // "pass", "warn" or "fail"
    std::int64_t verified_at_s = 0;                                  // since 1970
    std::string machine, kernel;                                     // identities, below
    double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;  // lateness of the servo
    std::optional<double> cyclictest_max_us;
    std::optional<std::uint64_t> smi_count;
};

[[nodiscard]] std::string station_report_path();
// Nothing: not a valid report; `refusal` holds the reason.
[[nodiscard]] std::optional<StationReport> parse_station_report(const std::string& text,
                                                                std::string& refusal);
// Nothing with an empty refusal: the file does not exist.
[[nodiscard]] std::optional<StationReport> read_station_report(const std::string& path, std::string& refusal);

// A hash of /etc/machine-id, which itself must stay private; "" without one.
[[nodiscard]] std::string machine_identity();
[[nodiscard]] std::string kernel_identity();  // release and build

struct StationStatement {
    bool good = false;  // passed, on this machine with this kernel
    std::string text;
};
// Describes in one sentence whether the report applies here and now.
[[nodiscard]] StationStatement describe_station_report(const StationReport& report, std::int64_t now_s,
                                                       const std::string& machine, const std::string& kernel);

}  // namespace tact
