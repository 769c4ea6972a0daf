// tact-prep: files in, one baked scene out; or one mesh.
#include <signal.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "ipc/base/parent_death.hpp"
#include "ipc/base/units.hpp"
#include "ipc/manual/manual.hpp"
#include "ipc/version/version.hpp"
#include "prep/bake/bake_contour.hpp"
#include "prep/bake/bake_docking.hpp"
#include "prep/cli/bench_command.hpp"
#include "prep/cli/console.hpp"
#include "prep/cli/drill_command.hpp"
#include "prep/cli/export_command.hpp"
#include "prep/cli/scene_report.hpp"
#include "prep/cli/simplify_command.hpp"
#include "prep/cli/target.hpp"
#include "prep/cli/touch_command.hpp"
#include "prep/input/read_file.hpp"
#include "prep/map/import_map.hpp"
#include "prep/structure/import_structure.hpp"
#include "prep/synthetic/ring.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

struct BakeOptions {
    std::string map, scene, source;
    std::vector<std::string> models;
    std::optional<double> contour, resolution_a, force_map_resolution_a;
    double level = 0.0;
    std::uint32_t vertices_max = 1'000'000;
    pid_t ends_with = 0;
    bool json = false;
};

// Lines of the note hold no control characters, whatever a file is called.
std::string plain(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return text;
}

std::string now_utc() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

std::string listed(const DensityGrid& grid) {
    char text[160];
    std::snprintf(text, sizeof text, "%u x %u x %u voxels of %.4g x %.4g x %.4g Å", grid.size[0],
                  grid.size[1], grid.size[2], grid.spacing_m.x() / kAngstromM,
                  grid.spacing_m.y() / kAngstromM, grid.spacing_m.z() / kAngstromM);
    return text;
}

DockingInput from_files(const BakeOptions& o, const Progress& progress) {
    DockingInput input;
    report(progress, 0.0, "reading the map");
    ImportedMap map = import_map(o.map);
    input.note.push_back("map: " + plain(o.map));
    input.note.push_back("map format: " + map.format + ", " + listed(map.grid));
    input.note.push_back("map origin: " + map.origin_rule);
    for (const std::string& line : map.notes) input.note.push_back("map note: " + line);
    input.grid = std::move(map.grid);
    input.title = plain(fs::path(o.map).filename().string());
    const char* join = " and ";
    for (const std::string& path : o.models) {
        report(progress, 0.0, "reading structures");
        ImportedStructure model = import_structure(path);
        input.note.push_back("structure: " + plain(fs::absolute(path).string()));
        input.note.push_back("structure check: " + file_mark(path));
        input.note.push_back("structure content: " + plain(model.summary));
        input.title += join + model.structure.name;
        join = ", ";
        input.structures.push_back(std::move(model.structure));
    }
    return input;
}

DockingInput from_ring(const Progress& progress) {
    report(progress, 0.0, "making the ring");
    SyntheticRing ring = make_ring();
    DockingInput input;
    input.title = "synthetic ring of six, one subunit free";
    input.note = {"map: made by tact-prep demo dock: six subunits, 12 Å, noise of 1 % of the highest density",
                  "map format: synthetic, " + listed(ring.grid),
                  "map origin: chosen, the axis of the ring is z through (0, 0, 0)",
                  "structure: subunit A of the same ring, where the map has it"};
    input.grid = std::move(ring.grid);
    input.structures.push_back(std::move(ring.subunits.front()));
    input.resolution_m = ring.resolution_m;
    return input;
}

void bake(const BakeOptions& o, bool demo) {
    std::vector<std::string> inputs = o.models;
    inputs.push_back(o.map);
    check_target("write scene", o.scene, inputs);
    const auto started = std::chrono::steady_clock::now();
    Console console;
    const Progress progress = console.progress();
    DockingInput input = demo ? from_ring(progress) : from_files(o, progress);
    input.note.insert(input.note.begin(),
                      {"made by: " + program_version("tact-prep"), "made at: " + now_utc()});
    if (o.contour) input.contour = o.contour;
    if (o.resolution_a) input.resolution_m = *o.resolution_a * kAngstromM;
    if (o.force_map_resolution_a) input.force_map_resolution_m = *o.force_map_resolution_a * kAngstromM;
    input.vertices_max = o.vertices_max;
    SceneWriter out;
    const BakedDocking baked = bake_docking(input, out, progress);
    report(progress, 0.99, "writing the scene");
    out.write(o.scene);
    console.clear();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (o.json) {
        nlohmann::ordered_json json = scene_json(SceneFile::open(o.scene));
        for (std::size_t i = 0; i < baked.bodies.size(); ++i) {
            json["bodies"][i]["density_home_sigma"] = baked.bodies[i].density_home_sigma;
            json["bodies"][i]["inside_home"] = baked.bodies[i].inside_home;
        }
        json["seconds"] = seconds;
        std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        std::printf("%s%s: %.1f MB in %.1f s\n", baked.note.c_str(), o.scene.c_str(),
                    static_cast<double>(fs::file_size(o.scene)) * 1e-6, seconds);
    }
}

void contour(const BakeOptions& o) {
    check_target("write contour", o.scene, {o.source});
    Console console;
    if (o.ends_with != 0 && !end_with_parent(o.ends_with, SIGTERM)) throw Cancelled{};
    SceneWriter out;
    const BakedContour baked =
        bake_contour(SceneFile::open(o.source), o.level, o.vertices_max, out, console.progress());
    out.write(o.scene);
    console.clear();
    std::printf("%s: level %g, %zu vertices found, %u kept, down to %u; %u triangles\n", o.scene.c_str(),
                o.level, baked.vertices_found, baked.vertices, baked.vertices_min, baked.triangles);
}

void info(const BakeOptions& o) {
    const SceneFile file = SceneFile::open(o.scene);
    const std::string text =
        o.json ? scene_json(file).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"
               : scene_text(file);
    std::fputs(text.c_str(), stdout);
}

int run(int argc, char** argv) {
    BakeOptions o;
    CLI::App app(
        "Bakes maps and structures into a scene that tact-rt and tact-gui map at once, and simplifies "
        "meshes.",
        "tact-prep");
    app.set_version_flag("--version", program_version("tact-prep"));
    app.footer("Exit codes: 0 done; 1 error; 2 wrong usage; 130 cancelled by Ctrl-C, nothing written.");
    app.require_subcommand(1);
    const auto output = [&](CLI::App* sub) {
        sub->add_option("-o,--output", o.scene, "the scene to write")->required()->type_name("SCENE");
        sub->add_option("--contour", o.contour,
                        "level of the surface, in the map's unit; chosen from the histogram if absent");
        sub->add_option("--resolution-a", o.resolution_a,
                        "resolution of the map in ångström; four voxels if absent");
        sub->add_option(
            "--force-map-resolution-a", o.force_map_resolution_a,
            "let the hand feel the map smoothed to this resolution in ångström, which draws a structure "
            "from farther away; as it is if absent");
        sub->add_option("--vertices-max", o.vertices_max, "most vertices of the surface; 0: all")
            ->capture_default_str();
        sub->add_flag("--json", o.json, "print what was baked as JSON");
    };
    CLI::App* const dock =
        app.add_subcommand("dock", "a docking scene from a map and one or more structures");
    dock->add_option("map", o.map, "MRC/CCP4 or Situs, also .gz")->required();
    dock->add_option("models", o.models, "PDB or mmCIF, also .gz; one body each")->required();
    output(dock);
    CLI::App* const demo = app.add_subcommand("demo", "a scene made in code, without files");
    demo->require_subcommand(1);
    CLI::App* const demo_dock =
        demo->add_subcommand("dock", "a ring of six subunits and its 12 Å map; one subunit is free");
    output(demo_dock);
    add_touch(app, *demo);
    add_drill(app, *demo);
    CLI::App *simplify_parsed = nullptr, *bench_parsed = nullptr;
    const auto simplify_file = add_simplify(app, simplify_parsed);
    const auto bench = add_bench(app, bench_parsed);
    CLI::App* const level = app.add_subcommand("contour", "the surface of a scene's map at another level");
    level->add_option("scene", o.source, "a baked scene")->required();
    level->add_option("--level", o.level, "level of the surface, in the map's unit")->required();
    level->add_option("-o,--output", o.scene, "the scene to write")->required()->type_name("SCENE");
    level->add_option("--vertices-max", o.vertices_max, "most vertices of the surface; 0: all")
        ->capture_default_str();
    level
        ->add_option("--ends-with", o.ends_with, "for programs: cancel when process PID, the parent, is gone")
        ->type_name("PID");
    CLI::App* const show = app.add_subcommand("info", "what a scene holds; checks all of it");
    show->add_option("scene", o.scene, "a baked scene")->required();
    show->add_flag("--json", o.json, "as JSON");
    add_export(app);
    if (const auto answered = manual::answer(app, "tact-prep", argc, argv)) return *answered;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (simplify_parsed->parsed()) {
        simplify_file();
    } else if (bench_parsed->parsed()) {
        bench();
    } else if (show->parsed()) {
        info(o);
    } else if (level->parsed()) {
        contour(o);
    } else if (dock->parsed() || demo_dock->parsed()) {
        bake(o, demo_dock->parsed());
    }
    return 0;
}

}  // namespace
}  // namespace tact

int main(int argc, char** argv) {
    try {
        return tact::run(argc, argv);
    } catch (const tact::Cancelled&) {
        std::fputs("tact-prep: cancelled, nothing was written\n", stderr);
        return 130;
    } catch (const std::bad_alloc&) {
        std::fputs("tact-prep: memory ran out\n  mend: free memory, or crop or bin the map\n", stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tact-prep: %s\n", error.what());
    }
    return 1;
}
