#include "prep/map/read_map.hpp"

#include "ipc/base/error.hpp"
#include "ipc/base/printable.hpp"
#include "ipc/base/printed.hpp"
#include "ipc/base/units.hpp"
#include "prep/map/map_mask.hpp"
#include "prep/map/map_resolution.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/map/shell_correlation.hpp"

namespace tact {
namespace {

double from_half_maps(const MapRequest& request, const DensityGrid& map, const DensityGrid* mask,
                      std::vector<std::string>& note) {
    if (request.half_maps.size() != 2)
        throw StartupError("read the half-maps of " + request.path,
                           std::to_string(request.half_maps.size()) + " given",
                           "give both: --half-map FILE --half-map FILE");
    const DensityGrid half_1 = import_map(request.half_maps[0]).grid,
                      half_2 = import_map(request.half_maps[1]).grid;
    if (!same_grid(map, half_1))
        throw StartupError("read half-map " + request.half_maps[0],
                           "its box or its voxels are not those of the map",
                           "give the half-maps of this map");
    const ShellCorrelation found = shell_correlation(half_1, half_2, mask);
    for (const std::string& half : request.half_maps) note.push_back("half-map: " + printable(half));
    const double measured_m = found.resolution_m.value_or(found.finest_m);
    note.push_back(
        printed("half-maps: Fourier shell correlation of %.3g at %.4g Å%s%s", kFscThreshold,
                measured_m / kAngstromM, mask != nullptr ? ", corrected for the mask" : "",
                found.resolution_m ? "" : ", the finest that the voxels show: it stays above that"));
    return measured_m;
}

}  // namespace

void MapRequest::add_options(CLI::App& command) {
    command.add_option("--resolution-a", resolution_a,
                       "Resolution of the map (angstrom), as published with it");
    command
        .add_option("--half-map", half_maps,
                    "One of the two half-maps, given twice: the resolution is where their Fourier shell "
                    "correlation falls to "
                    "0.143, unless --resolution-a gives it")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("FILE");
    command
        .add_option("--mask", mask, "Map that is 1 inside and 0 outside: density outside becomes background")
        ->type_name("FILE");
}

std::vector<std::string> MapRequest::paths() const {
    std::vector<std::string> all = half_maps;
    all.push_back(path);
    if (!mask.empty()) all.push_back(mask);
    return all;
}

std::string grid_text(const DensityGrid& grid) {
    return printed("%u x %u x %u voxels of %.4g x %.4g x %.4g Å", grid.size[0], grid.size[1], grid.size[2],
                   grid.spacing_m.x() / kAngstromM, grid.spacing_m.y() / kAngstromM,
                   grid.spacing_m.z() / kAngstromM);
}

ReadMap read_map(const MapRequest& request) {
    ImportedMap map = import_map(request.path);
    ReadMap out{std::move(map.grid), 0.0, {}, {}};
    out.note.push_back("map: " + printable(request.path));
    out.note.push_back("map format: " + map.format + ", " + grid_text(out.grid));
    out.note.push_back("map origin: " + map.origin_rule);
    for (const std::string& line : map.notes) out.note.push_back("map note: " + line);

    std::optional<DensityGrid> mask;
    if (!request.mask.empty()) {
        mask = mask_on(out.grid, import_map(request.mask).grid, request.mask);
        apply_mask(out.grid, *mask, map_statistics(out.grid).background);
        out.note.push_back("mask: " + printable(request.mask) +
                           printed(", %.3g %% of the voxels inside", 100.0 * share_inside(*mask)));
    }
    std::optional<double> measured_m;
    if (!request.half_maps.empty())
        measured_m = from_half_maps(request, out.grid, mask ? &*mask : nullptr, out.note);
    if (request.resolution_a) {
        out.resolution_m = *request.resolution_a * kAngstromM;
        check_resolution(out.resolution_m, "--resolution-a");
        out.resolution_source = "as given";
    } else if (measured_m) {
        out.resolution_m = *measured_m;
        out.resolution_source = "of the half-maps";
    } else {
        refuse_unknown_resolution(request.path, out.grid.spacing_m);
    }
    return out;
}

}  // namespace tact
