#include "ipc/station/station_report.hpp"

#include <sys/stat.h>
#include <sys/utsname.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

using nlohmann::json;

constexpr std::size_t kBytesMost = 1U << 20U;

double time_us(const json& j) {
    const auto us = j.get<double>();
    if (!std::isfinite(us) || us < 0.0 || us > 1e12) throw std::invalid_argument("an impossible time");
    return us;
}

std::string age_text(std::int64_t seconds) {
    const auto in = [&](std::int64_t unit, const char* name) {
        const std::int64_t n = seconds / unit;
        return std::to_string(n) + " " + name + (n == 1 ? "" : "s") + " old";
    };
    if (seconds < 0) return "dated in the future";
    constexpr std::int64_t kHour = 3600, kDay = 24 * kHour;
    if (seconds < kHour) return in(60, "minute");
    if (seconds < 2 * kDay) return in(kHour, "hour");
    return in(kDay, "day");
}

}  // namespace

std::string station_report_path() {
    const char* const path = std::getenv("TACT_STATION_REPORT");
    return path != nullptr && *path != '\0' ? path : kStationReportPath;
}

std::optional<StationReport> parse_station_report(const std::string& text, std::string& refusal) {
    try {
        const json j = json::parse(text);
        if (j.at("format") != kStationReportFormat || j.at("version") != kStationReportVersion)
            throw std::invalid_argument("another format or version");
        StationReport r;
        r.status = j.at("status");
        if (r.status != "pass" && r.status != "warn" && r.status != "fail")
            throw std::invalid_argument("an unknown status");
        r.verified_at_s = j.at("verified_at_s");
        r.machine = j.at("machine");
        r.kernel = j.at("kernel");
        const json& late = j.at("lateness_us");
        r.p50_us = time_us(late.at("p50"));
        r.p99_us = time_us(late.at("p99"));
        r.p999_us = time_us(late.at("p999"));
        r.max_us = time_us(late.at("max"));
        if (const json& c = j.at("cyclictest"); c.is_object() && c.contains("max_us"))
            r.cyclictest_max_us = time_us(c.at("max_us"));
        if (const json& s = j.at("smi"); s.is_object() && s.contains("count"))
            r.smi_count = s.at("count").get<std::uint64_t>();
        refusal.clear();
        return r;
    } catch (const std::exception& e) {
        refusal = e.what();
        return std::nullopt;
    }
}

std::optional<StationReport> read_station_report(const std::string& path, std::string& refusal) {
    refusal.clear();
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) {
        if (errno != ENOENT) refusal = last_error();
        return std::nullopt;
    }
    if (!S_ISREG(status.st_mode) || static_cast<std::size_t>(status.st_size) > kBytesMost) {
        refusal = "the file is not a regular file of plausible size";
        return std::nullopt;
    }
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return parse_station_report(text, refusal);
}

std::string machine_identity() {
    std::ifstream in("/etc/machine-id");
    std::string id;
    if (!std::getline(in, id) || id.empty()) return "";
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : "tact station " + id)
        hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    char text[17];
    static_cast<void>(std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash)));
    return text;
}

std::string kernel_identity() {
    utsname name{};
    return uname(&name) == 0 ? std::string(name.release) + " " + name.version : "";
}

StationStatement describe_station_report(const StationReport& report, std::int64_t now_s,
                                         const std::string& machine, const std::string& kernel) {
    StationStatement s;
    char metrics[96];
    static_cast<void>(std::snprintf(metrics, sizeof metrics, "lateness p99.9 %.1f us, max %.1f us",
                                    report.p999_us, report.max_us));
    s.text =
        "station report: " + report.status + ", " + age_text(now_s - report.verified_at_s) + ", " + metrics;
    if (report.machine != machine) {
        s.text += "; the report is from another machine";
    } else if (report.kernel != kernel) {
        s.text += "; the report is from another kernel: " + report.kernel;
    } else {
        s.good = report.status == "pass";
        s.text += "; same machine and kernel";
        if (s.good) return s;
    }
    s.text += "\n  fix: sudo tact station verify";
    return s;
}

}  // namespace tact
