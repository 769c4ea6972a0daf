// A scan in any of the formats, with or without labels, to bone that can be baked.
//
// Density   by two values of the scan: no bone at and below the first, solid at and above the second. For Hounsfield
//           units these are 300 and 1800; for 8-bit grey 0 and 255. Where what the numbers mean is not known and none
//           reaches that of air, both have to be given: a guess would be felt as wrong bone.
// Labels    a second file, or the colours of a stack of pictures. Names come from the file (segmentations of 3D Slicer)
//           or from a list as ITK-SNAP writes it. Critical are those whose name holds a word of kCriticalWords or one
//           that is given; their voxels are at least kLabelDensity, so that a burr meets them.
// Private   nothing of a file but geometry, values and the names of its labels goes on, not even its own name.
// Memory    `announce` is told the voxels and the most bytes before they are taken.
// Fails by  StartupError; Cancelled when `progress` returns false.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "prep/drilling/bake_bone.hpp"
#include "prep/drilling/resample.hpp"

namespace tact {

inline constexpr std::uint8_t kLabelDensity = 40;

struct BoneImport {
    std::filesystem::path scan, labels, label_names;
    std::optional<double> threshold, solid;  // in the scan's values
    double voxel_mm = 0.0;                   // 0: the scan's finest
    std::optional<ScanCrop> crop;
    unsigned series = 0;
    double unit_mm = 1.0;                                    // of a file that does not say
    Vec3 spacing_mm = Vec3::Zero();                          // of a stack of pictures: columns, rows, slices
    std::array<std::uint8_t, 3> bone_colour{255, 249, 219};  // of a stack of labels
    BoneFace face = BoneFace::front;
    std::vector<std::string> critical;  // more words
    std::function<void(double voxels, double bytes)> announce;
    std::function<void(const std::string&)> warn;
};

BoneInput import_bone(const BoneImport& settings, const Progress& progress = {});

// Lines "value red green blue opacity visible mesh "name"" as ITK-SNAP writes them; # begins a remark.
std::vector<ScanLabel> parse_label_names(std::string_view text, const std::string& attempt);
bool critical_name(const std::string& name, const std::vector<std::string>& more);

}  // namespace tact
