// Records one controller: waits for it, writes the contents of its rings a few times per second, until
// stopped.
//
// Killed    loses at most kFlushEvery and one round of the loop (ipc/record)
// Ends      when the controller ends, when stop() returns true, after `seconds`, or when the disk is nearly
//           full: the file is then closed properly, and the outcome holds the reason
// Thread    one; sleeps between rounds
// Errors    StartupError
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact::record {

struct RecorderSettings {
    std::filesystem::path file;
    std::string session = "default";
    std::string program;                                        // with its version, as stored in the file
    double seconds = 0.0;                                       // 0: no limit
    double wait_s = 0.0;                                        // for a controller; 0: no limit
    std::uint64_t free_bytes_least = std::uint64_t{64} << 20U;  // free space to leave on the disk
    std::function<bool()> stop = [] { return false; };
};

enum class RecorderEnd : std::uint8_t { controller_ended, stopped, time_over, disk_full };

struct RecorderProgress {
    double recorded_s = 0.0;
    std::uint64_t cycles = 0, dropped = 0, bytes = 0;
    std::uint64_t first_step = 0;  // 1: from the controller's start
};

struct RecorderOutcome {
    RecorderEnd end = RecorderEnd::stopped;
    RecorderProgress progress;
    bool began = false;  // a controller was available
};

inline constexpr Duration kFlushEvery = std::chrono::milliseconds(250);

// say: each thing it waits for, once; progress: after each flush.
RecorderOutcome record(const RecorderSettings& settings, const std::function<void(const std::string&)>& say,
                       const std::function<void(const RecorderProgress&)>& progress);

[[nodiscard]] const char* recorder_end_text(RecorderEnd end);

}  // namespace tact::record
