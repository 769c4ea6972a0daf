// Density maps from files: MRC/CCP4 (.mrc .map .ccp4 .rec) and Situs (.sit .situs), each also as .gz.
//
// Frame    model: the axes and the origin that the file's structures have; metres (files are in ångström).
// Checks   sizes, byte order and geometry before anything is allocated; every value finite. See README.md.
// Fails by StartupError naming the file, the place in it, the reason and the fix.
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
    std::string origin_rule;         // which header fields placed voxel (0,0,0), in words
    std::vector<std::string> notes;  // what was fixed or converted on the way, in words
};

ImportedMap import_map(const std::filesystem::path& path);

// The same from bytes in memory (not packed), for tests and fuzzing. `ending` decides the format.
ImportedMap import_map_bytes(std::vector<char> bytes, const std::string& name, const std::string& ending);

}  // namespace tact
