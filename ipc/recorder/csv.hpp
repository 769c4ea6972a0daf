// A recording as a table of text, a row a cycle: for programs that read nothing else.
//
// Columns  time_s (since the first row), cycle, state, level, lateness_us, cost_us, model_us; of each hand pose (x y z in m, quaternion
//          x y z w), force and torque sent, force and torque of the model, buttons. Numbers as short as they can be read back the same.
// Memory   does not depend on the recording's length.
// Thread   one. Fails by StartupError.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace tact::record {

struct CsvSettings {
    std::filesystem::path recording, file;  // file: must not be there
    std::uint64_t every = 1;                // writes one cycle of so many
};

// Rows written. Of the cycles before the loop's start none is. A stop leaves no file.
std::uint64_t write_csv(
    const CsvSettings& settings, const std::function<bool()>& stop = [] { return false; });

}  // namespace tact::record
