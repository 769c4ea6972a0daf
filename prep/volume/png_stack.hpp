// A folder of PNG images, one per slice, a common form of segmented volumes: grey, or one colour per structure.
//
// Names     a word, a number and .png: plane0.png, plane0010.png. The number gives the order of the slices; numbers
//           must be consecutive. All images have the same size.
// Colours   each becomes a number, in the order found; `palette` grows while slices are read.
#pragma once

#include <filesystem>
#include <memory>

#include "prep/volume/scan.hpp"

namespace tact {

struct StackPalette {
    std::vector<std::array<std::uint8_t, 4>> rgba;  // by number; at most 256
};
struct PngStack {
    Scan scan;                              // values are grey or label
    std::shared_ptr<StackPalette> palette;  // null: grey
};

// File names of a folder in the order of their numbers; throws StartupError if they do not form a stack. Exported for
// tests and fuzzing without files.
std::vector<std::string> stack_order(std::vector<std::string> names, const std::string& attempt);

// The folder must contain a .png file.
PngStack read_png_stack(const std::filesystem::path& folder, const Vec3& spacing_mm);

}  // namespace tact
