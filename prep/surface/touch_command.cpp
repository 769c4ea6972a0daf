#include "prep/surface/touch_command.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "ipc/base/printable.hpp"
#include "ipc/version/version.hpp"
#include "prep/console/console.hpp"
#include "prep/console/scene_report.hpp"
#include "prep/console/target.hpp"
#include "prep/mesh_file/import_mesh.hpp"
#include "prep/surface/bake_surface.hpp"
#include "prep/surface/clean_mesh.hpp"
#include "prep/synthetic/made_tool.hpp"
#include "prep/synthetic/rough_sphere.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

struct Unit {
    const char* name;
    double metres;
};
constexpr Unit kUnits[] = {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}, {"a", 1e-10}};

struct TouchSettings {
    std::string mesh, scene, unit = "mm", up = "y", shape = "terrain";
    double size_mm = 150.0;
    std::string tool, tool_unit = "mm", tool_up = "y", tool_grip = "middle";
    double tool_size_mm = 0.0;
    std::uint32_t tool_points = 1000;
    std::uint32_t parts = 0, vertices_max = 500'000;
    bool no_picture = false, no_forest = false, compare_locality = false, json = false;
};

// Converts from the file's unit to metres, y up.
void to_metres(TriangleMesh& mesh, const std::string& name, const std::string& up) {
    const auto unit =
        std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& u) { return name == u.name; });
    const auto scale = static_cast<float>(unit->metres);
    for (std::size_t v = 0; v < mesh.position_m.size(); v += 3) {
        float* const p = mesh.position_m.data() + v;
        for (int axis = 0; axis < 3; ++axis) p[axis] *= scale;
        if (up == "z") {  // rotate about x
            const float y = p[1];
            p[1] = p[2];
            p[2] = -y;
        }
    }
}

// Adds a synthetic tool, or a tool from a file.
void add_tool(const TouchSettings& o, SurfaceInput& input, const Progress& progress) {
    if (o.tool.empty()) return;
    input.tool = made_tool(o.tool);
    if (input.tool.triangles() > 0) {
        input.tool_sampling.grip_in_middle = false;
        input.note.push_back("tool mesh: " + o.tool + ", synthetic");
    } else {
        ImportedMesh in = import_mesh(o.tool, part(progress, 0.0, 0.5));
        const CleanReport cleaned = clean_mesh(in.mesh, 0.0, part(progress, 0.5, 1.0));
        to_metres(in.mesh, o.tool_unit, o.tool_up);
        input.tool = std::move(in.mesh);
        input.tool_sampling.grip_in_middle = o.tool_grip == "middle";
        input.note.push_back("tool mesh: " + printable(fs::absolute(o.tool).string()));
        input.note.push_back("tool unit: " + o.tool_unit + ", " + o.tool_up +
                             " up, grip point: " + o.tool_grip);
        input.note.push_back("tool repairs: " + (cleaned.changed() ? cleaned.words() : std::string("none")));
    }
    input.tool_sampling.points = o.tool_points;
    input.tool_size_m = 1e-3 * o.tool_size_mm;
}

SurfaceInput touch_file(const TouchSettings& o, const Progress& progress) {
    SurfaceInput input;
    ImportedMesh in = import_mesh(o.mesh, part(progress, 0.0, 0.5), [&o](const MeshNeeds& needs) {
        // At the peak, mesh, order, surface and the bytes of the file are in memory together. Contraction needs more
        // (245 bytes per triangle: 8.8 GB at 30 million).
        const double bytes_a_triangle = o.no_forest && o.no_picture ? 65.0 : 245.0;
        std::fprintf(stderr, "%zu triangles; about %.1f GB of memory needed\n", needs.triangles,
                     (3.0 * static_cast<double>(needs.bytes) +
                      bytes_a_triangle * static_cast<double>(needs.triangles)) *
                         1e-9);
    });
    const CleanReport cleaned = clean_mesh(in.mesh, 0.0, part(progress, 0.5, 1.0));
    to_metres(in.mesh, o.unit, o.up);
    input.note = {"mesh: " + printable(fs::absolute(o.mesh).string()), "mesh format: " + in.format,
                  "mesh unit: " + o.unit + ", " + o.up + " up",
                  "mesh repairs: " + (cleaned.changed() ? cleaned.words() : std::string("none"))};
    input.title = printable(fs::path(o.mesh).filename().string());
    input.mesh = std::move(in.mesh);
    return input;
}

SurfaceInput touch_made(const TouchSettings& o) {
    SurfaceInput input;
    const bool terrain = o.shape == "terrain", smooth = o.shape == "smooth-sphere";
    const std::uint32_t parts = o.parts > 0 ? o.parts : terrain ? 300 : 158;
    input.mesh = terrain ? rough_terrain(parts) : smooth ? smooth_sphere(parts) : rough_sphere(parts);
    input.title = terrain ? "rough terrain" : smooth ? "smooth sphere" : "rough sphere";
    input.note = {"mesh: made by tact-prep demo touch, " + input.title + " of " + std::to_string(parts) +
                  " parts"};
    return input;
}

void touch(const TouchSettings& o, bool made) {
    std::vector<std::string> inputs;
    if (!made) inputs.push_back(o.mesh);
    if (!o.tool.empty() && made_tool(o.tool).triangles() == 0) inputs.push_back(o.tool);
    check_target("write scene", o.scene, inputs);
    const auto started = std::chrono::steady_clock::now();
    Console console;
    const Progress progress = console.progress();
    SurfaceInput input = made ? touch_made(o) : touch_file(o, part(progress, 0.0, 0.1));
    add_tool(o, input, part(progress, 0.1, 0.12));
    input.note.insert(input.note.begin(), "made by: " + program_version("tact-prep"));
    input.size_m = 1e-3 * o.size_mm;
    input.picture = !o.no_picture;
    input.forest = !o.no_forest;
    input.compare_locality = o.compare_locality;
    input.vertices_max = o.vertices_max;
    SceneWriter out;
    const BakedSurface baked = bake_surface(std::move(input), out, part(progress, 0.12, 0.98));
    report(progress, 0.99, "writing the scene");
    out.write(o.scene);
    console.clear();
    if (baked.tool_too_large)
        std::fprintf(stderr,
                     "warning: the tool is larger than the mesh\n  fix: give its size with --tool-size-mm, "
                     "or check --unit "
                     "and --tool-unit\n");
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    print_written_scene(o.scene, baked.note, seconds, o.json,
                        {{"vertices", baked.vertices},
                         {"triangles", baked.triangles},
                         {"closed", baked.closed},
                         {"tool_points", baked.tool_points},
                         {"display_vertices", baked.display_vertices},
                         {"world_per_model", baked.meta.world_per_model},
                         {"bytes_per_triangle", baked.bytes_per_triangle},
                         {"build_s", baked.build_s},
                         {"forest_s", baked.forest_s}});
}

}  // namespace

void add_touch(CLI::App& app, CLI::App& demo) {
    const auto o = std::make_shared<TouchSettings>();
    const auto both = [&](CLI::App* sub) {
        sub->add_option("-o,--output", o->scene, "Scene file to write")->required()->type_name("SCENE");
        sub->add_option("--size-mm", o->size_mm, "Length of the mesh's diagonal in the workspace (mm)")
            ->check(CLI::Range(1.0, 10000.0))
            ->capture_default_str();
        sub->add_option("--vertices-max", o->vertices_max,
                        "Maximum number of vertices of the drawn surface; 0: no limit")
            ->capture_default_str();
        auto* const no_forest =
            sub->add_flag("--no-forest", o->no_forest,
                          "Omit the data of mode chr, which halves the baking time and the file");
        sub->add_flag("--compare-locality", o->compare_locality,
                      "Also report the forest's shape without localization")
            ->excludes(no_forest);
        sub->add_option(
            "--tool", o->tool,
            "Tool that touches the surface: a mesh file, or the synthetic scaler or block; default: a ball");
        sub->add_option("--tool-unit", o->tool_unit, "Unit of length in the tool's file (a: angstrom)")
            ->check(CLI::IsMember({"m", "cm", "mm", "um", "nm", "a"}))
            ->capture_default_str();
        sub->add_option("--tool-up", o->tool_up, "Axis of the tool's file that points up")
            ->check(CLI::IsMember({"y", "z"}))
            ->capture_default_str();
        sub->add_option("--tool-size-mm", o->tool_size_mm,
                        "Length of the tool's diagonal in the workspace (mm); 0: the scale of the mesh")
            ->check(CLI::Range(0.0, 1000.0))
            ->capture_default_str();
        sub->add_option("--tool-points", o->tool_points, "Number of contact points of the tool")
            ->check(CLI::Range(1U, TouchTool::kPointsMax))
            ->capture_default_str();
        sub->add_option("--tool-grip", o->tool_grip,
                        "Grip point of the tool: middle of the surface, or origin of the file")
            ->check(CLI::IsMember({"middle", "origin"}))
            ->capture_default_str();
        sub->add_flag("--no-picture", o->no_picture, "Omit the drawn surface (for measurements)");
        sub->add_flag("--json", o->json, "Print the properties of the baked scene as JSON");
    };
    CLI::App* const from_file = app.add_subcommand("touch", "Bake a surface to touch from a triangle mesh");
    from_file->add_option("mesh", o->mesh, "Triangle mesh: PLY, OBJ, STL or OFF, also .gz")->required();
    from_file->add_option("--unit", o->unit, "Unit of length in the mesh file (a: angstrom)")
        ->check(CLI::IsMember({"m", "cm", "mm", "um", "nm", "a"}))
        ->capture_default_str();
    from_file->add_option("--up", o->up, "Axis of the mesh file that points up")
        ->check(CLI::IsMember({"y", "z"}))
        ->capture_default_str();
    both(from_file);
    from_file->callback([o] { touch(*o, false); });
    CLI::App* const made = demo.add_subcommand("touch", "Bake a rough terrain, or a rough or smooth sphere");
    made->add_option("--shape", o->shape, "Synthetic surface: terrain, sphere (rough) or smooth-sphere")
        ->check(CLI::IsMember({"terrain", "sphere", "smooth-sphere"}))
        ->capture_default_str();
    made->add_option(
            "--parts", o->parts,
            "Number n of parts along the side of the terrain (2 n^2 triangles; default 300) or along an edge "
            "of the sphere's icosahedron (20 n^2 triangles; default 158)")
        ->check(CLI::Range(1U, 2000U));
    both(made);
    made->callback([o] { touch(*o, true); });
}

}  // namespace tact
