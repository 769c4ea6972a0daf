// Reads a scalar potential on a regular grid: CSV (.csv .txt .dat) or NRRD (.nrrd .nhdr), each also as .gz.
//
// CSV      one point per line: x y z value, or x y value for a potential that is the same at every z; separators are
//          commas, semicolons, tabs or spaces; lines in any order. A header line and lines that begin with # are skipped.
//          The points must form a complete regular grid: every point once, equal steps along each axis.
// NRRD     three axes, any number type, raw or gzip; axes parallel to x, y and z.
// Frame    model: x, y, z as in the file, metres (lengths in the file are in `unit_m`).
// Checks   every value finite; 4 to 512 points along an axis. A planar field is extended along z to a box.
// Fails by StartupError with file, line or field, reason and fix.
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
    std::vector<std::string> notes;  // conversions made
};

[[nodiscard]] ImportedField import_field(const std::filesystem::path& path, double unit_m);
// Parses uncompressed CSV text; for tests and fuzzing.
[[nodiscard]] ImportedField import_field_csv(std::string_view text, const std::string& name, double unit_m);

}  // namespace tact
