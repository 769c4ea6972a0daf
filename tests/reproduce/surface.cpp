#include "tests/reproduce/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "deploy/tact/files.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/refine_filter.hpp"
#include "ipc/scene/mesh/vertex_forest.hpp"
#include "tests/bench/touch_paths.hpp"
#include "tests/reproduce/draw.hpp"
#include "tests/reproduce/summary.hpp"
#include "tests/reproduce/surface_direction.hpp"
#include "tests/reproduce/surface_rows.hpp"
#include "tests/reproduce/surface_touch.hpp"
#include "tests/reproduce/text.hpp"

namespace tact::launch {
namespace {

// The synthetic meshes, with the values for each size in the table of the paper (without and with adaptation).
struct Size {
    const char *name, *shape;
    int parts;
    std::size_t triangles;
    const char *published_off, *published_on;
};
constexpr Size kSizes[] = {
    {"2 K", "sphere", 10, 2'000, "1500 Hz, good", "1500 Hz, good"},
    {"8 K", "sphere", 20, 8'000, "600 Hz, bad", "1200 Hz, good"},
    {"20 K", "sphere", 32, 20'480, "breaks", "1000 Hz, good"},
    {"92 K", "terrain", 215, 92'450, "breaks", "1000 Hz, good"},
    {"0.5 M", "sphere", 158, 499'280, "", ""},
    {"2 M", "sphere", 316, 1'997'120, "", ""},
    {"10 M", "sphere", 707, 9'996'980, "", ""},
};
// Smooth spheres: the smallest published size and a dense mesh.
constexpr int kSmoothParts[] = {10, 158};

std::vector<DirectionRow> directions(const std::filesystem::path& scene, bool quick) {
    const SceneFile file = SceneFile::open(scene);
    const SurfaceMesh surface = read_surface(file);
    const VertexForest forest = read_forest(file, surface.all_positions_m(), surface.all_corners());
    std::vector<DirectionRow> rows;
    for (const double pace : {1.0, 4.0}) {
        const std::vector<Vec3> path = touch_path_m(surface, TouchPath::slide, pace, quick ? 2000 : 10000);
        for (const TouchBall& tool : kTouchBalls) {
            for (const SurfaceMode mode : {SurfaceMode::off_tree, SurfaceMode::chr}) {
                SurfaceSettings settings = settings_to_measure(tool.radius_m);
                settings.mode = mode;
                settings.friction = 0.0;
                DirectionRow row = direction_of(touch_along(surface, path, settings, 1, 1.0, &forest), path);
                row.triangles = surface.triangles();
                row.tool = tool.name;
                row.mode = kSurfaceModeNames[static_cast<std::size_t>(mode)];
                row.speed_mm_s = 55.0 * pace;
                rows.push_back(row);
                std::printf("  smooth sphere %9zu  %-6s %3.0f mm/s %-9s direction error %.3f deg (99 %%)\n",
                            row.triangles, tool.name, row.speed_mm_s, row.mode.c_str(), row.p99_deg);
                std::fflush(stdout);
            }
        }
    }
    return rows;
}

// Figure 3: the filters of the paper, a bell and its replacement by frustums.
std::string filters_csv() {
    constexpr float kRadius = 3e-3F, kWidth = 4e-3F, kFar = 1e-4F;
    const RefineFilter bell = RefineFilter::bell(kRadius, kWidth, kFar);
    const std::array<RefineFilter::Point, 4> corner{{{kRadius, 0.1F * kFar},
                                                     {kRadius + 0.5F * kWidth, 0.4F * kFar},
                                                     {kRadius + kWidth, 0.7F * kFar},
                                                     {kRadius + 2.0F * kWidth, kFar}}};
    const RefineFilter frustums = RefineFilter::frustums(kRadius, corner);
    std::string csv = "distance_mm,exact_um,bell_um,frustums_um\n";
    for (int i = 0; i <= 400; ++i) {
        const float d = 15e-3F * static_cast<float>(i) / 400.0F, x = std::max(d - kRadius, 0.0F) / kWidth;
        csv += text("%.4f,%.4f,%.4f,%.4f\n", 1e3 * static_cast<double>(d),
                    1e6 * static_cast<double>(kFar * (1.0F - std::exp(-x * x))),
                    1e6 * static_cast<double>(bell.allowed_m(d)),
                    1e6 * static_cast<double>(frustums.allowed_m(d)));
    }
    return csv;
}

std::string rate_text(const TouchRow& r) { return text("%.0f Hz, %s", r.rate_hz, quality(r).c_str()); }

// Compares measured and published rates of the same mesh size, for the slow hand as in the paper.
std::vector<SummaryRow> summary_of(const std::vector<TouchRow>& rows) {
    std::vector<SummaryRow> table;
    for (const TouchRow& r : rows) {
        if (r.hand != kSlowHand || r.tool != kTouchBalls[0].name) continue;
        if (table.empty() || table.back().quantity != r.mesh) {
            SummaryRow row{.figure = "T1", .quantity = r.mesh};
            for (const Size& size : kSizes) {
                if (r.mesh != size.name || *size.published_off == '\0') continue;
                row.published = std::string(size.published_off) + " -> " + size.published_on;
                row.differs =
                    "a different mesh of the same size; published: without -> with adaptation; measured: "
                    "without";
            }
            table.push_back(row);
        }
        std::string& measured = table.back().measured;
        measured += (measured.empty() ? "" : "; ") + r.mode + ": " + rate_text(r);
    }
    return table;
}

// Largest direction error per mesh size, over all tools and speeds.
std::vector<SummaryRow> summary_of(const std::vector<DirectionRow>& rows) {
    std::vector<SummaryRow> table;
    double worst_deg = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        worst_deg = std::max(worst_deg, rows[i].p99_deg);
        if (i + 1 < rows.size() && rows[i + 1].triangles == rows[i].triangles) continue;
        table.push_back({.figure = "-",
                         .quantity = text("direction, sphere of %zu", rows[i].triangles),
                         .measured = text("error at most %.2f degrees in 99 %% of the steps", worst_deg),
                         .differs = "not published"});
        worst_deg = 0.0;
    }
    return table;
}

}  // namespace

int reproduce_surface(const SurfaceExperiment& e) {
    // Checks now that the folder is writable, not after some minutes.
    write_whole(e.out / ".writable", "");
    std::filesystem::remove(e.out / ".writable");
    const ScratchFolder scratch;
    const auto scene = scratch.path() / "surface.tact";
    std::vector<TouchRow> rows;
    const auto add = [&](const std::string& name, const std::vector<std::string>& arguments) {
        static_cast<void>(bake_to_measure(arguments, scene));
        const std::vector<TouchRow> more = touch_in_all_modes(name, scene, e.quick);
        rows.insert(rows.end(), more.begin(), more.end());
    };
    for (const auto& mesh : e.meshes)
        add(mesh.filename().string(), {"touch", std::filesystem::absolute(mesh).string(), "--unit", e.unit});
    for (const Size& size : kSizes) {
        if (!e.meshes.empty() || size.triangles > (e.quick ? 100'000 : e.triangles_max)) continue;
        add(size.name, {"demo", "touch", "--shape", size.shape, "--parts", std::to_string(size.parts)});
    }
    std::vector<DirectionRow> smooth;
    for (const int parts : kSmoothParts) {
        if (!e.meshes.empty()) break;
        static_cast<void>(bake_to_measure(
            {"demo", "touch", "--shape", "smooth-sphere", "--parts", std::to_string(parts)}, scene));
        const std::vector<DirectionRow> more = directions(scene, e.quick);
        smooth.insert(smooth.end(), more.begin(), more.end());
        if (e.quick) break;
    }
    write_whole(e.out / "table1.csv", csv_of(rows));
    if (!smooth.empty()) write_whole(e.out / "direction.csv", csv_of(smooth));
    write_whole(e.out / "filters.csv", filters_csv());
    std::vector<SummaryRow> table = summary_of(rows);
    for (const SummaryRow& row : summary_of(smooth)) table.push_back(row);
    const nlohmann::json report{
        {"rows", json_of(rows)}, {"direction", json_of(smooth)}, {"summary", json_of(table)}};
    write_whole(e.out / "surface.json", report.dump(2) + "\n");
    draw_figures(e.out);
    std::printf("\n%s\nwrote %s and CSV and PNG files in the same folder\n", table_of(table).c_str(),
                (e.out / "surface.json").c_str());
    return 0;
}

}  // namespace tact::launch
