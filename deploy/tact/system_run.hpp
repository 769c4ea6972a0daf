// The part of a run that belongs to one system: its columns of the table, keys of the report, and files.
//
// The system's row of deploy/tact/systems creates one for each scene that is run or watched. The defaults do nothing; a
// system overrides what it needs. Hostile: topics may hold any values.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "deploy/tact/run_options.hpp"
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

    // Additional options of tact-gui; scratch() creates the run's temporary folder.
    virtual std::vector<std::string> window_options(
        const std::function<std::filesystem::path()>& /*scratch*/) {
        return {};
    }
    // Arguments of a tact-record that keeps what the run changes in its scene; empty: none. May complete the options of
    // the controller. Called once, before the controller starts.
    virtual std::vector<std::string> keeper_arguments(RunOptions& /*options*/) { return {}; }
    // Called at every poll while a controller is visible.
    virtual void watch(const RtRegion& /*region*/) {}
    // Sets `own`, `heading` and `line_end` of the sample.
    virtual void sample(const RtRegion& /*region*/, Sample& /*sample*/) const {}
    // Adds keys to the report of an ended run.
    virtual void report(const RtRegion& /*region*/, nlohmann::json& /*report*/) const {}

    // --save DIR: check_save() before the run, save() after it. Both throw StartupError.
    virtual void check_save(const std::filesystem::path& folder) const;
    virtual void save(const RtRegion* /*region*/, const SaveRequest& /*request*/,
                      Signals& /*signals*/) const {}
};

}  // namespace tact::launch
