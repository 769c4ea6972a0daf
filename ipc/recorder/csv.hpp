// Converts a recording into a text table with one row per cycle, for programs that read no HDF5.
//
// Columns  time_s (since the first row), cycle, state, level, lateness_us, cost_us, model_us; for each hand
//          pose (x y z in m, quaternion x y z w), force and torque sent, force and torque of the model,
//          buttons. Numbers have the fewest digits that reproduce them exactly.
// Memory   does not depend on the recording's length
// Thread   one
// Errors   StartupError
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace tact::record {

struct CsvSettings {
    std::filesystem::path recording, file;  // file: must not exist
    std::uint64_t every = 1;                // cycles per written row
};

// Returns the number of rows. Omits cycles before the loop's start. A stop leaves no file.
std::uint64_t write_csv(
    const CsvSettings& settings, const std::function<bool()>& stop = [] { return false; });

}  // namespace tact::record
