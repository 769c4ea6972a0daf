#include "prep/map/import_map.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/error.hpp"
#include "prep/input/read_file.hpp"
#include "prep/map/formats.hpp"

namespace tact {
namespace {

// 2^28 values as text of 14 characters each exceed this limit; 2 GiB of text is about 150 million voxels.
constexpr std::uint64_t kFileBytesMax = std::uint64_t{2} << 30;
constexpr double kFarthestM = 1e-4;  // a million ångström

bool is_mrc(const std::string& ending) {
    return ending == ".mrc" || ending == ".map" || ending == ".ccp4" || ending == ".rec";
}
bool is_situs(const std::string& ending) { return ending == ".sit" || ending == ".situs"; }

void check_ending(const std::string& ending, const std::string& name) {
    if (is_mrc(ending) || is_situs(ending)) return;
    throw StartupError("read map " + name, "the file name ending '" + ending + "' is not that of a map",
                       "give a .mrc, .map, .ccp4, .rec, .sit or .situs file, optionally followed by .gz");
}

// Checks for every format.
void check_values(const DensityGrid& grid, const std::string& name) {
    const std::string attempt = "read map " + name;
    std::size_t bad = 0, first = 0;
    float low = grid.values.front(), high = low;
    for (std::size_t i = 0; i < grid.values.size(); ++i) {
        const float v = grid.values[i];
        if (!(std::abs(v) <= 1e30F)) {
            if (bad++ == 0) first = i;
        }
        low = std::min(low, v);
        high = std::max(high, v);
    }
    if (bad > 0) {
        const std::size_t nx = grid.size[0], ny = grid.size[1];
        throw StartupError(attempt,
                           std::to_string(bad) + " of " + std::to_string(grid.values.size()) +
                               " voxels are not finite numbers, the first at voxel (" +
                               std::to_string(first % nx) + ", " + std::to_string(first / nx % ny) + ", " +
                               std::to_string(first / (nx * ny)) + ")",
                           "compute the map again, or set these voxels to the background value");
    }
    if (low == high) {
        throw StartupError(attempt, "all voxels have the same value, " + std::to_string(low),
                           "give a map that contains density");
    }
    if (!(grid.origin_m.cwiseAbs().maxCoeff() <= kFarthestM)) {
        throw StartupError(attempt, "the origin is more than a million ångström from (0, 0, 0)",
                           "correct the origin in the header");
    }
}

}  // namespace

ImportedMap import_map_bytes(std::vector<char> bytes, const std::string& name, const std::string& ending) {
    check_ending(ending, name);
    ImportedMap map =
        is_mrc(ending) ? map_format::read_mrc(std::move(bytes), name) : map_format::read_situs(bytes, name);
    check_values(map.grid, name);
    return map;
}

ImportedMap import_map(const std::filesystem::path& path) {
    const std::string ending = format_ending(path);
    check_ending(ending, path.string());
    return import_map_bytes(read_whole_file(path, kFileBytesMax), path.string(), ending);
}

}  // namespace tact
