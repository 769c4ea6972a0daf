#include "prep/export/fit_remarks.hpp"

#include "ipc/base/printed.hpp"

namespace tact {
namespace {

Eigen::AngleAxisd axis_of(const AtomMove& move) { return Eigen::AngleAxisd(Quat(move.turn).normalized()); }

std::string matrix_row(const AtomMove& move, int row) {
    return printed("%.12f %.12f %.12f %.6f", move.turn(row, 0), move.turn(row, 1), move.turn(row, 2),
                   move.shift_a[row]);
}

void remark_fit(const FitMetrics& m, const std::string& prefix, Remarks& remarks) {
    remarks.emplace_back(prefix + "correlation_about_zero", printed("%.4f", m.cc_zero));
    remarks.emplace_back(prefix + "correlation_about_mean", printed("%.4f", m.cc_mean));
    remarks.emplace_back(prefix + "overlap", printed("%.6g", m.overlap));
    remarks.emplace_back(prefix + "mean_density", printed("%.6g", m.mean_density));
    remarks.emplace_back(prefix + "mean_density_sigma", printed("%.4f", m.mean_density_sigma));
    remarks.emplace_back(prefix + "fraction_inside_contour", printed("%.4f", m.fraction_inside));
    remarks.emplace_back(prefix + "clashes", std::to_string(m.clashes));
}

std::string csv_text(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

}  // namespace

SavedFit fit_of(const SceneFile& scene, const std::vector<Structure>& structures,
                const std::vector<PlacedBody>& bodies, double contour) {
    const SceneMeta meta = read_meta(scene);
    SavedFit fit;
    fit.resolution_a = meta.resolution_m / kAngstromM;
    fit.contour = contour;
    std::vector<PlacedStructure> placed;
    placed.reserve(bodies.size());
    for (const PlacedBody& b : bodies) placed.push_back({&structures[b.structure], b.T_model_body});
    fit.numbers = fit_of_bodies(read_grid(scene), placed,
                                {.resolution_m = meta.resolution_m,
                                 .contour = contour,
                                 .background = meta.map_background,
                                 .sigma = meta.map_sigma});
    return fit;
}

Remarks remarks_of(const SceneMeta& meta, const SavedFit& fit, std::size_t index, std::size_t count,
                   const PlacedBody* body, const AtomMove* move) {
    Remarks remarks;
    remarks.emplace_back("scene", meta.title);
    if (body != nullptr) {
        remarks.emplace_back("body", std::to_string(body->id));
        for (int row = 0; row < 3; ++row)
            remarks.emplace_back("matrix_row_" + std::to_string(row + 1),  // fits a line of PDB
                                 printed("%.8f %.8f %.8f %.4f", move->turn(row, 0), move->turn(row, 1),
                                         move->turn(row, 2), move->shift_a[row]));
        const Eigen::AngleAxisd turn = axis_of(*move);
        remarks.emplace_back("axis",
                             printed("%.9f %.9f %.9f", turn.axis().x(), turn.axis().y(), turn.axis().z()));
        remarks.emplace_back("angle_deg", printed("%.6f", turn.angle() / kDegreeRad));
    }
    remarks.emplace_back("resolution_a", printed("%.4g", fit.resolution_a));
    remarks.emplace_back("region", kFitRegion);
    remarks.emplace_back("contour", printed("%.6g", fit.contour));
    if (body != nullptr) remark_fit(fit.numbers.body[index], "", remarks);
    if (body == nullptr || count > 1) remark_fit(fit.numbers.all, "all_bodies_", remarks);
    return remarks;
}

std::string matrix_text(const PlacedBody& body, const std::string& name, const AtomMove& move) {
    const Eigen::AngleAxisd turn = axis_of(move);
    std::string text = "# body " + std::to_string(body.id) + ", " + name +
                       "\n# place = matrix * (x, y, z, 1) of the original file; angstrom\n" +
                       printed("# axis %.9f %.9f %.9f\n# angle_deg %.6f\n", turn.axis().x(), turn.axis().y(),
                               turn.axis().z(), turn.angle() / kDegreeRad);
    for (int row = 0; row < 3; ++row) text += matrix_row(move, row) + '\n';
    return text;
}

std::string csv_row(const PlacedBody& body, const std::string& name, const std::string& file,
                    const AtomMove& move, const SavedFit& fit, std::size_t index) {
    std::string row = printed("%u,%u,", body.id, body.structure) + csv_text(name) + ',' + csv_text(file);
    for (int r = 0; r < 3; ++r)
        row += printed(",%.12f,%.12f,%.12f,%.6f", move.turn(r, 0), move.turn(r, 1), move.turn(r, 2),
                       move.shift_a[r]);
    const Eigen::AngleAxisd turn = axis_of(move);
    const Vec3 com_a = body.T_model_body.p_m / kAngstromM;
    row += printed(",%.9f,%.9f,%.9f,%.6f,%.4f,%.4f,%.4f", turn.axis().x(), turn.axis().y(), turn.axis().z(),
                   turn.angle() / kDegreeRad, com_a.x(), com_a.y(), com_a.z());
    const FitMetrics& m = fit.numbers.body[index];
    return row + printed(",%.4g,%.6f,%.6f,%.8g,%.8g,%.6f,%.6f,%llu,%llu,%llu\n", fit.resolution_a, m.cc_zero,
                         m.cc_mean, m.overlap, m.mean_density, m.mean_density_sigma, m.fraction_inside,
                         static_cast<unsigned long long>(m.region_voxels),
                         static_cast<unsigned long long>(m.atoms),
                         static_cast<unsigned long long>(m.clashes));
}

}  // namespace tact
