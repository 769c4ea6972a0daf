// What a map and its structures are, and what their import asks: the resolution, and the contour beside the histogram.
//
// Fails by  StartupError, as the import would
#pragma once

#include <string>
#include <vector>

#include "ipc/base/progress.hpp"
#include "prep/console/import_report.hpp"

namespace tact {

[[nodiscard]] ImportReport examine_map(const std::string& map, const std::vector<std::string>& models,
                                       const Progress& progress = {});

}  // namespace tact
