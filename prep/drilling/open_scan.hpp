// Opens a scan in any supported format: a folder of DICOM files or of PNG images, NRRD, NIfTI, MetaImage.
//
// Fails by  StartupError; Cancelled when `progress` returns false
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "prep/volume/png_stack.hpp"
#include "prep/volume/scan.hpp"

namespace tact {

struct ScanRequest {
    unsigned series = 0;             // of a folder of DICOM files; 0: the only one that is a volume
    double unit_mm = 1.0;            // unit of length of a file that states none
    Vec3 spacing_mm = Vec3::Zero();  // of a stack of images: columns, rows, slices
};

struct OpenedScan {
    Scan scan;
    std::shared_ptr<StackPalette> palette;  // of coloured images; null: none
};

[[nodiscard]] OpenedScan open_scan(const std::filesystem::path& path, const ScanRequest& request,
                                   const Progress& progress);

[[nodiscard]] bool is_image_stack(const std::filesystem::path& path);

}  // namespace tact
