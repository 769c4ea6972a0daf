#include "prep/docking/report_docking.hpp"

#include <nlohmann/json.hpp>

#include "ipc/scene/density/density_map.hpp"

namespace tact {
namespace {

nlohmann::ordered_json triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void report_docking(const SceneFile& file, nlohmann::ordered_json& json) {
    const DensityGrid grid = read_grid(file);
    json["grid"] = {
        {"size", grid.size}, {"origin_m", triple(grid.origin_m)}, {"spacing_m", triple(grid.spacing_m)}};
}

}  // namespace tact
