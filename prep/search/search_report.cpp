#include "prep/search/search_report.hpp"

#include "ipc/base/printed.hpp"
#include "ipc/base/units.hpp"
#include "prep/search/fit_input.hpp"

namespace tact {
namespace {

struct Axis {
    Vec3 direction, through_a;
};
Axis axis_of(const SymmetricPlace& place) {
    return {place.T_model_frame.q * Vec3::UnitZ(), place.T_model_frame.p_m / kAngstromM};
}

std::string quoted(const std::string& field) {
    if (field.find_first_of(",\"\n") == std::string::npos) return field;
    std::string out = "\"";
    for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

}  // namespace

std::string as_table(const SearchReport& r) {
    std::string out;
    for (const SearchedModel& m : r.models) {
        out += m.model + ": " +
               printed("%zu atoms, %zu orientations, within %.1f degrees, searched at %.1f Å, %.1f s\n",
                       m.structure.size(), m.found.rotations, m.found.cover_rad / kDegreeRad,
                       m.found.search_resolution_m / kAngstromM, m.seconds);
        if (m.copies) {
            const auto [axis, through_a] = axis_of(m.copies->place);
            out += printed(
                "  %zu copies by %s, axis %.4f %.4f %.4f through %.1f %.1f %.1f Å; together: correlation "
                "%.4f; "
                "refined without symmetry their atoms are %.2f Å away\n",
                m.found.hits.size(), m.copies->symmetry.name().c_str(), axis.x(), axis.y(), axis.z(),
                through_a.x(), through_a.y(), through_a.z(), m.copies->correlation,
                m.copies->free_difference_m / kAngstromM);
        }
        if (m.found.hits.empty())
            out += "  no place found\n";
        else
            out += printed("%5s %8s %7s %14s %8s   %s\n", m.copies ? "copy" : "rank", "score", "z",
                           "cc about mean", "clashes", "centre, Å");
        for (std::size_t i = 0; i < m.found.hits.size(); ++i) {
            const SearchHit& hit = m.found.hits[i];
            const Vec3 at_a = hit.T_model_body.p_m / kAngstromM;
            out += printed("%5zu %8.4f %7.2f %14.4f %8llu   %.1f %.1f %.1f\n", i + 1, hit.score, hit.z,
                           m.cc_about_mean[i], static_cast<unsigned long long>(m.clashes[i]), at_a.x(),
                           at_a.y(), at_a.z());
        }
    }
    if (r.together_correlation)
        out += printed("all together: correlation about zero %.4f, over the whole map\n",
                       *r.together_correlation);
    return out;
}

nlohmann::ordered_json as_json(const SearchReport& r) {
    nlohmann::ordered_json json{{"map", r.map},
                                {"resolution_a", r.resolution_a},
                                {"objective", r.objective},
                                {"fixed", r.fixed},
                                {"hits", nlohmann::ordered_json::array()},
                                {"searches", nlohmann::ordered_json::array()}};
    if (r.together_correlation) json["together_correlation"] = *r.together_correlation;
    for (const SearchedModel& m : r.models) {
        nlohmann::ordered_json searched{{"model", m.model},
                                        {"atoms", m.structure.size()},
                                        {"orientations", m.found.rotations},
                                        {"orientations_within_deg", m.found.cover_rad / kDegreeRad},
                                        {"search_resolution_a", m.found.search_resolution_m / kAngstromM},
                                        {"random_score_mean", m.found.random_mean},
                                        {"random_score_deviation", m.found.random_deviation},
                                        {"seconds", m.seconds}};
        if (m.copies) {
            const auto [axis, through_a] = axis_of(m.copies->place);
            searched["symmetry"] = {{"name", m.copies->symmetry.name()},
                                    {"axis", {axis.x(), axis.y(), axis.z()}},
                                    {"through_a", {through_a.x(), through_a.y(), through_a.z()}},
                                    {"correlation", m.copies->correlation},
                                    {"free_difference_a", m.copies->free_difference_m / kAngstromM}};
        }
        json["searches"].push_back(searched);
        for (std::size_t i = 0; i < m.found.hits.size(); ++i) {
            const SearchHit& hit = m.found.hits[i];
            json["hits"].push_back({{"model", m.model},
                                    {"rank", i + 1},
                                    {"score", hit.score},
                                    {"z", hit.z},
                                    {"cc_about_mean", m.cc_about_mean[i]},
                                    {"clashes", m.clashes[i]},
                                    {"matrix", matrix_of(m.structure, hit.T_model_body)}});
        }
    }
    return json;
}

std::string as_csv(const SearchReport& r) {
    std::string out = "map,model,resolution_a,objective,score,z,cc_about_mean,clashes,seconds";
    for (int i = 0; i < 12; ++i) out += ",m" + std::to_string(i);
    out += "\n";
    for (const SearchedModel& m : r.models) {
        out += quoted(r.map) + "," + quoted(m.model) + printed(",%g,", r.resolution_a) + r.objective;
        if (m.found.hits.empty()) {
            out += printed(",,,,,%.2f,,,,,,,,,,,,\n", m.seconds);
            continue;
        }
        const SearchHit& hit = m.found.hits.front();
        out += printed(",%.6f,%.4f,%.6f,%llu,%.2f", hit.score, hit.z, m.cc_about_mean[0],
                       static_cast<unsigned long long>(m.clashes[0]), m.seconds);
        for (const double v : matrix_of(m.structure, hit.T_model_body)) out += printed(",%.8g", v);
        out += "\n";
    }
    return out;
}

}  // namespace tact
