// A scalar potential on a regular grid, from a file: CSV (.csv .txt .dat) or NRRD (.nrrd .nhdr), each also as .gz.
//
// CSV      one point a line, x y z value, or x y value for a potential that is the same at every z; separated by commas,
//          semicolons, tabs or blanks; lines in any order. A first line of names and lines that begin with # are passed over.
//          The points must form a whole regular grid: every place once, equal steps along each axis.
// NRRD     three axes, any number type, raw or gzip; axes parallel to x, y and z.
// Frame    model: x, y, z as in the file, metres (lengths in the file are in `unit_m`).
// Checks   every value finite; 4 to 512 points along an axis, a planar field is continued along z to a box.
// Fails by StartupError naming the file, the line or field, the reason and the fix.
// Thread   any; takes seconds for large files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/scene/density/density_map.hpp"

namespace tact {

inline constexpr std::uint32_t kFieldPointsMin = 4, kFieldPointsMax = 512;  // along an axis

struct ImportedField {
    DensityGrid grid;                // values in the file's unit
    std::string format;              // "CSV, 41 x 41 x 41 points"
    std::vector<std::string> notes;  // conversions that were made
};

[[nodiscard]] ImportedField import_field(const std::filesystem::path& path, double unit_m);
// A CSV in memory, not packed: for tests and fuzzing.
[[nodiscard]] ImportedField import_field_csv(std::string_view text, const std::string& name, double unit_m);

}  // namespace tact
