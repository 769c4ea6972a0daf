#include "prep/docking/examine_map.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ipc/base/printable.hpp"
#include "ipc/base/printed.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/map/read_map.hpp"
#include "prep/structure/import_structure.hpp"

namespace tact {
namespace {

constexpr std::size_t kMapBins = 256;
constexpr double kResolutionLeastA = 0.5, kResolutionMostA = 200.0;
constexpr const char* kResolutionHelp =
    "As published with the map. The structure is simulated at it, so a guess would rank wrong places first.";
constexpr const char* kContourHelp =
    "Level of the drawn surface, chosen from the histogram; as published with the map, or change it later.";

ImportReport::Histogram map_histogram(const DensityGrid& grid, const MapStatistics& statistics) {
    ImportReport::Histogram out{statistics.low, statistics.high, std::vector<double>(kMapBins, 0.0)};
    const double bin = (statistics.high - statistics.low) / static_cast<double>(kMapBins);
    for (const float value : grid.values) {
        const double at = bin > 0.0 ? (static_cast<double>(value) - statistics.low) / bin : 0.0;
        ++out.count[std::min(static_cast<std::size_t>(std::max(at, 0.0)), kMapBins - 1)];
    }
    return out;
}

}  // namespace

ImportReport examine_map(const std::string& map, const std::vector<std::string>& models,
                         const Progress& progress) {
    ImportReport out;
    const auto line = [&out](const std::string& label, const std::string& value) {
        out.lines.push_back({label, printable(value)});
    };
    report(progress, 0.0, "reading the map");
    const ImportedMap imported = import_map(map);
    const MapStatistics statistics = map_statistics(imported.grid);
    line("Map", imported.format);
    line("Voxels", grid_text(imported.grid));
    line("Values", printed("%.4g to %.4g, mean %.4g, spread %.4g", statistics.low, statistics.high,
                           statistics.mean, statistics.sigma));
    for (const std::string& note : imported.notes) line("Note", note);
    for (const std::string& model : models) {
        report(progress, 0.5, "reading structures");
        line(std::filesystem::path(model).filename().string(), import_structure(model).summary);
    }
    out.histogram = map_histogram(imported.grid, statistics);
    out.numbers.push_back({"--resolution-a", "Resolution of the map", "Å", kResolutionHelp, kResolutionLeastA,
                           kResolutionMostA, std::nullopt, false, true});
    out.numbers.push_back({"--contour", "Contour", "", kContourHelp, statistics.low, statistics.high,
                           choose_contour(imported.grid, statistics).level, true, true});
    return out;
}

}  // namespace tact
