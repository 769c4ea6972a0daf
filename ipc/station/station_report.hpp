// The report of tact station verify, as the controller and the metrics read it.
//
// File     /var/lib/tact/station-report.json, or what TACT_STATION_REPORT names; written by deploy/tact/station.
// Hostile  any text: what is not such a report is refused, numbers that cannot be are refused too.
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
// Nothing: it is no report; `refusal` has the reason.
[[nodiscard]] std::optional<StationReport> parse_station_report(const std::string& text,
                                                                std::string& refusal);
// Nothing with an empty refusal: there is no such file.
[[nodiscard]] std::optional<StationReport> read_station_report(const std::string& path, std::string& refusal);

// A hash of /etc/machine-id, which itself is not for publication; "" where there is none.
[[nodiscard]] std::string machine_identity();
[[nodiscard]] std::string kernel_identity();  // release and build

struct StationStatement {
    bool good = false;  // it passed, on this machine with this kernel
    std::string text;
};
// Which report applies here and now, in a sentence.
[[nodiscard]] StationStatement describe_station_report(const StationReport& report, std::int64_t now_s,
                                                       const std::string& machine, const std::string& kernel);

}  // namespace tact
