// Converts a scan in any supported format, with or without labels, to bone that can be baked.
//
// Density   from two values of the scan: no bone at and below the first, solid at and above the second. For Hounsfield
//           units these are 300 and 1800; for 8-bit grey those that the histogram suggests (bone_threshold.hpp), with a warning.
//           If the unit is unknown and no voxel is as low as air, both must be given: a guess would produce bone that feels
//           wrong. The error names those that the histogram suggests.
// Labels    a second file, or the colours of a stack of images. Names come from the file (segmentations of 3D Slicer)
//           or from an ITK-SNAP label description, from a table (structure_names.hpp; also one beside the scan), or from a known
//           palette of colours. A structure is critical if the table says so, or if its name contains one of kCriticalWords
//           or a given word; its voxels have at least kLabelDensity, so that a burr has contact with them.
// Private   only geometry, values and label names are taken over from a file, not even its own name.
// Memory    `announce` gets the number of voxels and the peak of bytes before memory is allocated.
// Fails by  StartupError; Cancelled when `progress` returns false.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "prep/drilling/bake_bone.hpp"
#include "prep/drilling/open_scan.hpp"
#include "prep/drilling/resample.hpp"

namespace tact {

inline constexpr std::uint8_t kLabelDensity = 40;
inline constexpr std::array<std::uint8_t, 3> kBoneColour{255, 249, 219};  // of a stack of labels

struct BoneImport {
    std::filesystem::path scan, labels;
    std::filesystem::path
        label_names;  // .toml: a table; empty: the one beside labels or scan, if there is one
    std::optional<double> threshold, solid;  // in the scan's values
    double voxel_mm = 0.0;                   // 0: the finest spacing of the scan
    std::optional<ScanCrop> crop;
    ScanRequest request;                                    // for the scan and the labels
    std::array<std::uint8_t, 3> bone_colour = kBoneColour;  // of a stack of labels
    BoneFace face = BoneFace::front;
    std::vector<std::string> critical;  // additional words
    std::function<void(double voxels, double bytes)> announce;
    std::function<void(const std::string&)> warn;
};

BoneInput import_bone(const BoneImport& settings, const Progress& progress = {});

// Parses lines `value red green blue opacity visible mesh "name"` of ITK-SNAP; # begins a comment.
std::vector<ScanLabel> parse_label_names(std::string_view text, const std::string& attempt);
bool critical_name(const std::string& name, const std::vector<std::string>& more);

}  // namespace tact
