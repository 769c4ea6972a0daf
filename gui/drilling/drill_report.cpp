#include "gui/drilling/drill_report.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"

namespace tact {

using nlohmann::json;

namespace {
constexpr std::array kShapes{"sphere", "cylinder", "cone"};  // as DrillShape
}  // namespace

json drill_report(const DrillMetricsRow& f, const BoneLabelsView& labels,
                  const std::optional<BurrVisibility>& visibility,
                  const std::optional<PatientFrame>& patient) {
    const auto mm3 = [&f](std::uint64_t levels) { return 1e9 * f.level_m3 * static_cast<double>(levels); };
    const auto share = [](double part, double of) { return of > 0.0 ? json(part / of) : json(nullptr); };
    json burrs = json::array();
    for (const BurrUse& b : f.burr)
        burrs.push_back({{"diameter_mm", 1e3 * b.diameter_m},
                         {"shape", kShapes[static_cast<std::size_t>(b.shape)]},
                         {"grit", b.grit == DrillGrit::diamond ? "diamond" : "cutting"},
                         {"drilling_s", b.drilling_s},
                         {"cutting_s", b.cutting_s},
                         {"removed_mm3", mm3(b.removed_levels)}});
    bool critical = false;
    json structures = json::array();
    for (std::size_t label = 1; label < f.structure.size(); ++label) {
        const StructureMetrics& s = f.structure[label];
        const BoneStructure& what = labels.structure[label - 1];
        critical = critical || what.critical;
        json row = {{"name", what.name}, {"critical", what.critical}, {"removed_mm3", mm3(s.removed_levels)}};
        if (what.critical) {
            row["injuries"] = s.injuries;
            row["nearest_mm"] = s.nearest_m < 1e8 ? json(1e3 * s.nearest_m) : json(nullptr);
            if (patient && s.nearest_m < 1e8) {
                const Vec3 at = patient->patient_mm(s.nearest_at_model_m);
                row["nearest_at_patient_mm"] = {at.x(), at.y(), at.z()};
            }
            row["drilling_within_1_mm_s"] = s.near_s[0];
            row["drilling_within_2_mm_s"] = s.near_s[1];
        }
        structures.push_back(row);
    }
    json j = {
        {"seen_s", f.seen_s},
        {"unseen_cycles", f.unseen_cycles},
        {"drilling_s", f.drilling_s},
        {"cutting_s", f.cutting_s},
        {"removed_mm3", mm3(f.removed_levels)},
        {"removed_bone_mm3", f.structure.empty() ? json(nullptr) : json(mm3(f.structure[0].removed_levels))},
        {"force",
         {{"mean_cutting_n", f.cutting_s > 0.0 ? json(f.force_cutting_n()) : json(nullptr)},
          {"max_n", f.force_n_most},
          {"excess_above_n", kForceExcessN},
          {"excess_s", f.excess_s},
          {"excess_share", share(f.excess_s, f.drilling_s)}}},
        {"strokes",
         {{"count", f.strokes.count},
          {"mean_length_mm", f.strokes.count > 0 ? json(1e3 * f.strokes.mean_length_m()) : json(nullptr)},
          {"mean_speed_mm_s",
           f.strokes.time_s > 0.0 ? json(1e3 * f.strokes.mean_speed_m_s()) : json(nullptr)}}},
        {"path_mm", 1e3 * f.path_m},
        {"burrs", burrs}};
    j["burr_visible_share"] = visibility ? share(visibility->seen_s, visibility->drilling_s) : json(nullptr);
    // Without labels, no structure is known to be critical.
    j["near_critical"] = !critical ? json(nullptr)
                                   : json{{"drilling_within_1_mm_s", f.near_s[0]},
                                          {"drilling_within_2_mm_s", f.near_s[1]},
                                          {"removed_within_1_mm_mm3", mm3(f.near_levels[0])},
                                          {"removed_within_2_mm_mm3", mm3(f.near_levels[1])}};
    j["injuries"] = critical ? json(f.injuries) : json(nullptr);
    j["structures"] = structures;
    return j;
}

void write_drill_report(const std::string& path, const json& report) {
    const std::string aside = path + ".new";
    std::ofstream out(aside, std::ios::binary);
    out << report.dump(2, ' ', false, json::error_handler_t::replace) << '\n';
    out.close();
    if (out && std::rename(aside.c_str(), path.c_str()) == 0) return;
    const int why = errno;
    std::remove(aside.c_str());
    throw StartupError("writing " + path, std::strerror(why), "give another path to --report");
}

}  // namespace tact
