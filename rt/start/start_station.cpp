#include "rt/start/start_station.hpp"

#include <spdlog/spdlog.h>

#include <ctime>

#include "ipc/station/station_report.hpp"

namespace tact {

void log_station_report() {
    const std::string path = station_report_path();
    std::string refusal;
    const auto report = read_station_report(path, refusal);
    if (!report) {
        if (refusal.empty())
            spdlog::info("station report: none ({}); tact station verify makes one", path);
        else
            spdlog::warn("station report: {}: {}\n  fix: sudo tact station verify", path, refusal);
        return;
    }
    const StationStatement s = describe_station_report(*report, static_cast<std::int64_t>(std::time(nullptr)),
                                                       machine_identity(), kernel_identity());
    s.good ? spdlog::info("{}", s.text) : spdlog::warn("{}", s.text);
}

}  // namespace tact
