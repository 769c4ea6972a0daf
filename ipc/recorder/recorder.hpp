// Records one controller: waits for it, writes what its rings hold, a few times a second, until somebody ends it.
//
// Killed    at most kFlushEvery and a turn of the loop are lost (ipc/record).
// Ends      when the controller ends, when stop() says so, after `seconds`, or when the disk is nearly full: the file is
//           closed whole then, and the outcome says which.
// Thread    one; sleeps between turns.
// Fails by  StartupError.
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
    std::string program;                                        // with its version, as the file says it
    double seconds = 0.0;                                       // 0: until something else ends it
    double wait_s = 0.0;                                        // for a controller; 0: as long as it takes
    std::uint64_t free_bytes_least = std::uint64_t{64} << 20U;  // of the disk, left to others
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
    bool began = false;  // there was a controller
};

inline constexpr Duration kFlushEvery = std::chrono::milliseconds(250);

// say: what it waits for, once each; progress: after each flush.
RecorderOutcome record(const RecorderSettings& settings, const std::function<void(const std::string&)>& say,
                       const std::function<void(const RecorderProgress&)>& progress);

[[nodiscard]] const char* recorder_end_text(RecorderEnd end);

}  // namespace tact::record
