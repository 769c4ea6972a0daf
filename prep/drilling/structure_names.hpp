// Names of the structures of a scan: from a table that a person edits, or from the colours of a known palette.
//
// Table     TOML, [[structure]] with `label` (of a label map) or `colour` ("#RRGGBB" or [r, g, b]; with a label: as it is
//           drawn), `name`, and `critical`, without which the name decides
// Palette   recognized by the colour of bone and at least kPaletteLeast of its other colours; exact colours only
// Errors    StartupError with the line, what is wrong and the fix; an unknown key is an error
// Thread    any
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "prep/volume/png_stack.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

inline constexpr std::size_t kPaletteLeast = 4;

// A label of 0: the entry is of a colour. A colour with alpha 0: none is given.
[[nodiscard]] std::vector<ScanLabel> parse_structure_table(std::string_view text, const std::string& attempt);
// Structures as a table to be edited; voxels: of each.
[[nodiscard]] std::string structure_table_text(const std::vector<ScanLabel>& structures,
                                               const std::vector<std::uint64_t>& voxels);

// Of a file: a table (.toml) or a label description of ITK-SNAP.
[[nodiscard]] std::vector<ScanLabel> read_structure_names(const std::filesystem::path& file);
// By the table beside a stack of coloured images, or else by a known palette.
[[nodiscard]] std::vector<ScanLabel> known_names(const std::filesystem::path& scan,
                                                 const StackPalette& palette);

// The names of a known palette that these colours belong to; `name` is the palette's. None if it is unknown.
[[nodiscard]] std::vector<ScanLabel> names_of_palette(const StackPalette& palette, std::string& name);

}  // namespace tact
