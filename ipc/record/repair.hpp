// A recording whose recorder was killed, or ran out of disk: opens it again, whole up to its last flush.
//
// Does     takes away the mark of the writer, cuts all columns of a table to one length and the hands to the cycles, and
//          writes down that it did (attributes end = 2, repaired_rows_cut).
// Refuses  a file that a living recorder writes.
// Fails by StartupError naming file, reason and fix.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tact {

inline constexpr const char* kRecordingFormat = "tact recording";
inline constexpr std::uint64_t kRecordingVersion = 1;

struct RepairReport {
    bool needed = false;
    std::uint64_t cycles = 0;    // that the file has
    std::uint64_t rows_cut = 0;  // of columns that were longer than others
    std::int64_t last_ns = 0;    // of the last cycle; monotonic clock of then
};

// Nothing is written where nothing is needed.
RepairReport repair_recording(const std::filesystem::path& path);
// In a sentence.
[[nodiscard]] std::string repair_text(const std::filesystem::path& path, const RepairReport& report);

}  // namespace tact
