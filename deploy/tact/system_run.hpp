// The part of a run that belongs to one system: its columns of the table, its keys of the report, its files.
//
// Made by the system's row of deploy/tact/systems for each scene that is run or watched. The default does nothing, so that a
// system overrides what it has. Hostile: topics may hold any values.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "deploy/tact/run_record.hpp"
#include "deploy/tact/signals.hpp"
#include "ipc/topics/regions.hpp"

namespace tact::launch {

struct SaveRequest {
    std::filesystem::path scene, folder, programs;
};

class SystemRun {
public:
    virtual ~SystemRun() = default;
    SystemRun() = default;
    SystemRun(const SystemRun&) = delete;
    SystemRun& operator=(const SystemRun&) = delete;

    // More options of tact-gui; scratch() makes the run's folder of temporary files.
    virtual std::vector<std::string> window_options(
        const std::function<std::filesystem::path()>& /*scratch*/) {
        return {};
    }
    // At every look at a controller that was seen.
    virtual void watch(const RtRegion& /*region*/) {}
    // Fills in `own` and the end of the line.
    virtual void sample(const RtRegion& /*region*/, Sample& /*sample*/) const {}
    // Adds keys to the report of a run that ended.
    virtual void report(const RtRegion& /*region*/, nlohmann::json& /*report*/) const {}

    // --save DIR: before the run, whether saving could succeed; and after it. Both throw StartupError.
    virtual void check_save(const std::filesystem::path& folder) const;
    virtual void save(const RtRegion* /*region*/, const SaveRequest& /*request*/,
                      Signals& /*signals*/) const {}
};

}  // namespace tact::launch
