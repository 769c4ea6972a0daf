// A folder of PNG pictures, one a slice, as segmented volumes are often passed on: grey, or a colour a structure.
//
// Names     a word, a number and .png: plane0.png, plane0010.png. They lie one above the other by their numbers, which
//           may not have gaps. All have the same size.
// Colours   each becomes a number, in the order in which they are met; `palette` grows while slices are read.
#pragma once

#include <filesystem>
#include <memory>

#include "prep/volume/scan.hpp"

namespace tact {

struct StackPalette {
    std::vector<std::array<std::uint8_t, 4>> rgba;  // by number; at most 256
};
struct PngStack {
    Scan scan;                              // values grey or label
    std::shared_ptr<StackPalette> palette;  // null: grey
};

// Names of a folder in the order of their numbers; throws StartupError where they are no stack. For tests and fuzzing
// without files.
std::vector<std::string> stack_order(std::vector<std::string> names, const std::string& attempt);

// Never called for a folder without a .png.
PngStack read_png_stack(const std::filesystem::path& folder, const Vec3& spacing_mm);

}  // namespace tact
