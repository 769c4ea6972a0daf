#include "tests/reproduce/surface_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/reproduce/text.hpp"

namespace tact::launch {

TouchRow row_of(const std::vector<TouchStep>& steps) {
    TouchRow row;
    row.steps = steps.size();
    if (steps.empty()) return row;
    double sum_us = 0.0, over = 0.0, touching = 0.0, adaptive = 0.0;
    for (const TouchStep& s : steps) {
        sum_us += s.best_us;
        over += s.best_us > 1000.0 ? 1.0 : 0.0;
        touching += s.force_n.squaredNorm() > 0.0 ? 1.0 : 0.0;
        adaptive += s.adaptive ? 1.0 : 0.0;
    }
    const auto count = static_cast<double>(steps.size());
    row.rate_hz = 1e6 * count / std::max(sum_us, 1e-9);
    const Percentiles best_us = best_times_us(steps);
    row.p50_us = best_us.p50;
    row.p99_us = best_us.p99;
    row.p999_us = best_us.p999;
    row.max_us = best_us.max;
    row.over_1ms = over / count;
    row.touching = touching / count;
    row.adaptive = adaptive / count;
    row.unsettled = static_cast<double>(unsettled_cycles(steps)) / count;
    row.jammed = jammed_cycles(steps);
    return row;
}

void compare(TouchRow& row, const std::vector<TouchStep>& steps, const std::vector<TouchStep>& reference) {
    double force = 0.0, sum = 0.0, largest = 0.0;
    std::vector<double> angle_deg;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Vec3 &a = steps[i].force_n, &b = reference[i].force_n;
        if (a.squaredNorm() == 0.0 && b.squaredNorm() == 0.0) continue;
        const double off = (a - b).norm();
        force += b.norm();
        sum += off;
        largest = std::max(largest, off);
        angle_deg.push_back(std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi);
    }
    if (angle_deg.empty() || !(force > 0.0)) return;
    const double mean_n = force / static_cast<double>(angle_deg.size());
    row.error_mean = sum / force;
    row.error_max = largest / mean_n;
    std::sort(angle_deg.begin(), angle_deg.end());
    row.angle_p99_deg = angle_deg[static_cast<std::size_t>(0.99 * static_cast<double>(angle_deg.size() - 1))];
}

std::string quality(const TouchRow& row) {
    if (row.rate_hz < 1000.0) return "breaks";
    return row.over_1ms > 1e-3 || row.jammed > 0 ? "bad" : "good";
}

std::string csv_of(const std::vector<TouchRow>& rows) {
    std::string csv =
        "mesh,triangles,tool,mode,hand,steps,rate_hz,p50_us,p99_us,p999_us,max_us,over_1ms_share,"
        "touching_share,unsettled_share,jammed_cycles,adaptive_share,error_mean,error_max,"
        "angle_p99_deg,quality\n";
    for (const TouchRow& r : rows)
        csv += text(
            "\"%s\",%zu,%s,%s,%s,%zu,%.0f,%.3f,%.3f,%.3f,%.3f,%.5f,%.4f,%.5f,%llu,%.4f,%.5f,%.5f,%.3f,%s\n",
            r.mesh.c_str(), r.triangles, r.tool.c_str(), r.mode.c_str(), r.hand.c_str(), r.steps, r.rate_hz,
            r.p50_us, r.p99_us, r.p999_us, r.max_us, r.over_1ms, r.touching, r.unsettled,
            static_cast<unsigned long long>(r.jammed), r.adaptive, r.error_mean, r.error_max, r.angle_p99_deg,
            quality(r).c_str());
    return csv;
}

nlohmann::json json_of(const std::vector<TouchRow>& rows) {
    nlohmann::json all = nlohmann::json::array();
    for (const TouchRow& r : rows)
        all.push_back({{"mesh", r.mesh},
                       {"triangles", r.triangles},
                       {"tool", r.tool},
                       {"mode", r.mode},
                       {"hand", r.hand},
                       {"steps", r.steps},
                       {"rate_hz", r.rate_hz},
                       {"us_p50", r.p50_us},
                       {"us_p99", r.p99_us},
                       {"us_p999", r.p999_us},
                       {"us_max", r.max_us},
                       {"over_1ms_share", r.over_1ms},
                       {"touching_share", r.touching},
                       {"unsettled_share", r.unsettled},
                       {"jammed_cycles", r.jammed},
                       {"adaptive_share", r.adaptive},
                       {"error_mean", r.error_mean},
                       {"error_max", r.error_max},
                       {"angle_p99_deg", r.angle_p99_deg},
                       {"quality", quality(r)}});
    return all;
}

}  // namespace tact::launch
