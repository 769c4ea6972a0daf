// Reads density maps: MRC/CCP4 (.mrc .map .ccp4 .rec) and Situs (.sit .situs), each also as .gz.
//
// Frame    model: axes and origin of the structures that belong to the map; metres (files are in ångström).
// Checks   sizes, byte order and geometry before memory is allocated; every value finite. See mrc.cpp.
// Fails by StartupError with file, place in the file, reason and fix.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

inline constexpr std::uint64_t kMapVoxelsMax = std::uint64_t{1} << 28;  // 1 GiB as floats, 645^3

struct ImportedMap {
    DensityGrid grid;
    std::string format;              // "MRC/CCP4 mode 2, little endian"
    std::string origin_rule;         // which header fields placed voxel (0,0,0)
    std::vector<std::string> notes;  // what was fixed or converted
};

ImportedMap import_map(const std::filesystem::path& path);

// The same from uncompressed bytes in memory, for tests and fuzzing. `ending` selects the format.
ImportedMap import_map_bytes(std::vector<char> bytes, const std::string& name, const std::string& ending);

}  // namespace tact
