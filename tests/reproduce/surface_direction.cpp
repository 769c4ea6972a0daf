#include "tests/reproduce/surface_direction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/reproduce/text.hpp"

namespace tact::launch {

DirectionRow direction_of(const std::vector<TouchStep>& steps, const std::vector<Vec3>& path_model_m) {
    std::vector<double> deg;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Vec3 &force = steps[i].force_n, &out = path_model_m[i];
        if (force.squaredNorm() > 0.0)
            deg.push_back(std::atan2(force.cross(out).norm(), force.dot(out)) * 180.0 / std::numbers::pi);
    }
    std::sort(deg.begin(), deg.end());
    DirectionRow row;
    row.steps = deg.size();
    if (deg.empty()) return row;
    const auto at = [&](double share) {
        return deg[static_cast<std::size_t>(share * static_cast<double>(deg.size() - 1))];
    };
    row.p50_deg = at(0.5);
    row.p99_deg = at(0.99);
    row.max_deg = at(1.0);
    return row;
}

std::string csv_of(const std::vector<DirectionRow>& rows) {
    std::string csv =
        "triangles,tool,mode,speed_mm_s,steps,direction_deg_p50,direction_deg_p99,direction_deg_max\n";
    for (const DirectionRow& r : rows)
        csv += text("%zu,%s,%s,%.0f,%zu,%.4f,%.4f,%.4f\n", r.triangles, r.tool.c_str(), r.mode.c_str(),
                    r.speed_mm_s, r.steps, r.p50_deg, r.p99_deg, r.max_deg);
    return csv;
}

nlohmann::json json_of(const std::vector<DirectionRow>& rows) {
    nlohmann::json all = nlohmann::json::array();
    for (const DirectionRow& r : rows)
        all.push_back({{"triangles", r.triangles},
                       {"tool", r.tool},
                       {"mode", r.mode},
                       {"speed_mm_s", r.speed_mm_s},
                       {"steps", r.steps},
                       {"direction_deg_p50", r.p50_deg},
                       {"direction_deg_p99", r.p99_deg},
                       {"direction_deg_max", r.max_deg}});
    return all;
}

}  // namespace tact::launch
