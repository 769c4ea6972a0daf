// Repairs a recording whose recorder was killed or ran out of disk space: complete up to its last flush.
//
// Does     clears the writer's mark, cuts all columns of a table to one length and the hands to the cycles,
//          and marks the file (attributes end = 2, repaired_rows_cut)
// Refuses  a file with a running recorder
// Errors   StartupError with file, reason and fix
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tact {

inline constexpr const char* kRecordingFormat = "tact recording";
inline constexpr std::uint64_t kRecordingVersion = 1;

struct RepairReport {
    bool needed = false;
    std::uint64_t cycles = 0;    // in the file
    std::uint64_t rows_cut = 0;  // of columns that were longer than others
    std::int64_t last_ns = 0;    // of the last cycle; monotonic clock of the recording
};

// Writes nothing if no repair is needed.
RepairReport repair_recording(const std::filesystem::path& path);
// The report as one sentence.
[[nodiscard]] std::string repair_text(const std::filesystem::path& path, const RepairReport& report);

}  // namespace tact
