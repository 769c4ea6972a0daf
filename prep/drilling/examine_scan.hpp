// What a scan is, and what its import asks: the values of bone, which series of a folder, the spacing of images.
//
// Fails by  StartupError, as the import would; Cancelled when `progress` returns false
#pragma once

#include <filesystem>

#include "prep/console/import_report.hpp"
#include "prep/drilling/open_scan.hpp"

namespace tact {

// request.series 0 with several volumes: the largest one is examined, and the others can be chosen.
[[nodiscard]] ImportReport examine_scan(const std::filesystem::path& path, ScanRequest request,
                                        const Progress& progress = {});

}  // namespace tact
