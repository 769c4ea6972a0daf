#include "tests/reproduce/mesh_figures.hpp"

#include <cmath>

#include "deploy/tact/files.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/mesh/mesh_cut.hpp"
#include "prep/mesh_file/import_mesh.hpp"
#include "prep/mesh_file/write_ply.hpp"
#include "tests/reproduce/mesh_error.hpp"
#include "tests/reproduce/mesh_picture.hpp"
#include "tests/reproduce/run_prep.hpp"
#include "tests/reproduce/sample_meshes.hpp"
#include "tests/reproduce/text.hpp"

namespace tact::launch {
namespace {

constexpr double kPublishedWeight = 1000.0;  // border weight f of the paper

TriangleMesh scaled(TriangleMesh mesh, double factor) {
    for (float& x : mesh.position_m) x = static_cast<float>(static_cast<double>(x) * factor);
    return mesh;
}

struct Simplifier {
    std::filesystem::path scratch;
    double per_m;  // units of the file per metre

    TriangleMesh operator()(const TriangleMesh& mesh, std::uint32_t vertices, double weight) const {
        const auto in = scratch / "in.ply", made = scratch / "out.ply";
        write_ply(in, scaled(mesh, per_m));
        run_prep({"simplify", in.string(), "--vertices", std::to_string(vertices), "-o", made.string(),
                  "--boundary-weight", text("%g", weight)},
                 scratch / "simplify.log", "simplifying a mesh");
        return scaled(import_mesh(made).mesh, 1.0 / per_m);
    }
};

struct Row {
    std::string figure, name;
    std::size_t vertices_wanted;
    double weight;  // border weight; negative: the original mesh
    TriangleMesh mesh;
    MeshError error;
};

std::string percent_of(double length_m, const MeshError& e) {
    return text("%.2g %%", e.diagonal_m > 0.0 ? 100.0 * length_m / e.diagonal_m : 0.0);
}

void append(std::string& csv, const Row& r) {
    const double of = r.error.diagonal_m > 0.0 ? 100.0 / r.error.diagonal_m : 0.0;
    csv += text("%s,\"%s\",%zu,%zu,%zu,%s,%.5f,%.5f,%.5f,%.5f\n", r.figure.c_str(), r.name.c_str(),
                r.vertices_wanted, r.mesh.vertices(), r.mesh.triangles(),
                r.weight < 0.0 ? "" : text("%g", r.weight).c_str(), of * r.error.rms_m, of * r.error.max_m,
                of * r.error.back_max_m, of * r.error.border_max_m);
}

std::vector<SummaryRow> figure_3(const Simplifier& simplified, std::string& csv,
                                 const std::filesystem::path& out) {
    std::vector<Row> rows;
    rows.push_back({"3", "(a) original", 1250, -1.0, open_sheet(), {}});
    const TriangleMesh whole = rows.front().mesh;
    const char* const names[2][2] = {{"(b)", "(c)"}, {"(d)", "(e)"}};
    for (const bool kept : {false, true})
        for (const std::uint32_t n : {100U, 8U})
            rows.push_back({"3",
                            std::string(names[kept ? 1 : 0][n == 100 ? 0 : 1]) +
                                (kept ? " protected" : " no protection"),
                            n,
                            kept ? kPublishedWeight : 0.0,
                            simplified(whole, n, kept ? kPublishedWeight : 0.0),
                            {}});
    MeshPicture picture{.title = "Figure 3: an open mesh, its border with and without protection",
                        .remark =
                            "sizes and weight of the border planes (f = 1000) as in the paper; distances: "
                            "maximum, in percent of the diagonal of the bounding box",
                        .eye = Vec3(0.5, -1.2, 1.1),
                        .panel_px = 380,
                        .panel_height_px = 270};
    for (Row& r : rows) {
        if (r.weight >= 0.0) r.error = mesh_error(whole, r.mesh);
        append(csv, r);
        picture.panels.push_back({&r.mesh, r.name + ": " + std::to_string(r.mesh.vertices()) + " vertices",
                                  r.weight < 0.0
                                      ? std::to_string(r.mesh.triangles()) + " triangles"
                                      : "border error " + percent_of(r.error.border_max_m, r.error) +
                                            ", surface error " + percent_of(r.error.max_m, r.error),
                                  r.weight >= 0.0});
    }
    save(picture, out, "fig3_border");
    const auto border = [&](std::size_t i) { return percent_of(rows[i].error.border_max_m, rows[i].error); };
    const std::string counts =
        text("%zu to %zu and %zu", rows[0].mesh.vertices(), rows[3].mesh.vertices(), rows[4].mesh.vertices());
    return {{"3", "open mesh, vertices", "1250 to 100 and 8", counts,
             "a different bent sheet, because the mesh of the paper is not published"},
            {"3", "border, no protection", "zig-zag at 100, lost at 8",
             "error " + border(1) + " and " + border(2),
             "maximum distance, in percent of the diagonal of the bounding box"},
            {"3", "border, protected (f = 1000)", "kept at 100 and 8",
             "error " + border(3) + " and " + border(4), ""}};
}

std::vector<SummaryRow> figure_4(const Simplifier& simplified, std::string& csv,
                                 const std::filesystem::path& out) {
    constexpr std::uint32_t kSizes[] = {12835, 2000, 200};
    const TriangleMesh made = chaperonin(kSizes[0]);
    std::vector<Row> rows;
    for (const std::uint32_t n : kSizes)
        rows.push_back({"4",
                        std::to_string(n),
                        n,
                        n == kSizes[0] ? -1.0 : kPublishedWeight,
                        simplified(n == kSizes[0] ? made : rows.front().mesh, n, kPublishedWeight),
                        {}});
    MeshPicture picture{.title = "Figure 4: a chaperonin-like isosurface at three sizes",
                        .remark =
                            "two rings of eight subunits, synthetic; sizes as in the paper; flat shaded; "
                            "distances in percent of the diagonal of the bounding box",
                        .eye = Vec3(0.5, -1.6, 0.9),
                        .panel_px = 560};
    const char* letter = "abc";
    for (Row& r : rows) {
        if (r.weight >= 0.0) r.error = mesh_error(rows.front().mesh, r.mesh);
        append(csv, r);
        picture.panels.push_back(
            {&r.mesh,
             text("(%c) %zu vertices, %zu triangles", *letter++, r.mesh.vertices(), r.mesh.triangles()),
             r.weight < 0.0 ? "from marching cubes"
                            : "error " + percent_of(r.error.rms_m, r.error) + " (root mean square), " +
                                  percent_of(r.error.max_m, r.error) + " (maximum)",
             r.weight >= 0.0});
    }
    save(picture, out, "fig4_chaperonin");
    const auto off = [&](std::size_t i) {
        return text("%zu vertices, error ", rows[i].mesh.vertices()) +
               percent_of(rows[i].error.rms_m, rows[i].error) + " rms, " +
               percent_of(rows[i].error.max_m, rows[i].error) + " maximum";
    };
    return {{"4", "chaperonin, vertices", "12835", std::to_string(rows[0].mesh.vertices()),
             text("a different closed isosurface: %zu vertices from marching cubes, %zu of them contracted",
                  made.vertices(), made.vertices() - rows[0].mesh.vertices())},
            {"4", "about 86 % fewer", "2000, most detail kept", off(1), "in percent of the diagonal"},
            {"4", "98 % fewer", "200, peaks and seam still visible", off(2), "in percent of the diagonal"}};
}

TriangleMesh mesh_of(const MeshCut& cut) {
    TriangleMesh m;
    for (const PackedVertex& v : cut.vertex().first(cut.vertices()))
        m.position_m.insert(m.position_m.end(), v.position_m.begin(), v.position_m.end());
    for (const MeshRange draw : cut.draws()) {
        const auto index = cut.index().subspan(draw.first, draw.count);
        for (std::size_t c = 0; c < index.size(); c += 3)
            if (index[c] != index[c + 1])  // skips degenerate triangles
                m.triangle.insert(m.triangle.end(), &index[c], &index[c] + 3);
    }
    return m;
}

}  // namespace

std::vector<SummaryRow> mesh_figures(const std::filesystem::path& out, const std::filesystem::path& scratch) {
    std::string csv =
        "figure,mesh,vertices_wanted,vertices,triangles,boundary_weight,rms_percent_of_diagonal,"
        "max_percent_of_diagonal,back_max_percent_of_diagonal,border_max_percent_of_diagonal\n";
    std::vector<SummaryRow> rows = figure_3({scratch, 1.0}, csv, out);
    const auto more = figure_4({scratch, 1.0 / kAngstromM}, csv, out);
    rows.insert(rows.end(), more.begin(), more.end());
    write_whole(out / "meshes.csv", csv);
    return rows;
}

std::vector<SummaryRow> adapted_figure(const ProgressiveMesh& mesh, std::uint32_t vertices,
                                       const std::filesystem::path& out) {
    MeshCut cut(mesh);
    cut.set_vertices(mesh.vertices());
    const TriangleMesh all = mesh_of(cut);
    cut.set_vertices(vertices);
    const TriangleMesh some = mesh_of(cut);
    const double fewer =
        100.0 * (1.0 - static_cast<double>(some.triangles()) / static_cast<double>(all.triangles()));
    save({.title = "Figure 6: the surface without and with adaptation",
          .remark = "the map of the rate experiment, at the mean level of detail of curve B in figure 5",
          .panels = {{&all, text("(a) %zu triangles", all.triangles()), "paper: 10140", false},
                     {&some, text("(b) %zu triangles, %.0f %% fewer", some.triangles(), fewer),
                      text("paper: 2776, 72 %% fewer; error %.2f A",
                           static_cast<double>(cut.error_m()) / kAngstromM),
                      false}},
          .eye = Vec3(0.6, -1.2, 1.4),
          .panel_px = 640,
          .panel_height_px = 520},
         out, "fig6_triangles");
    return {{"6", "triangles before and after", "10140 to 2776",
             text("%zu to %zu", all.triangles(), some.triangles()),
             "a finer surface, so that its rendering loads a current core"}};
}

}  // namespace tact::launch
