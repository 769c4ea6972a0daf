#include "prep/docking/dock_command.hpp"

#include <signal.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "ipc/base/parent_death.hpp"
#include "ipc/base/printable.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/density/normal_modes.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "ipc/version/version.hpp"
#include "prep/console/console.hpp"
#include "prep/console/scene_report.hpp"
#include "prep/console/target.hpp"
#include "prep/docking/bake_contour.hpp"
#include "prep/docking/bake_docking.hpp"
#include "prep/docking/examine_map.hpp"
#include "prep/docking/report_docking.hpp"
#include "prep/map/read_map.hpp"
#include "prep/structure/import_structure.hpp"
#include "prep/synthetic/ring.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

struct DockSettings {
    MapRequest map;
    std::string scene, source;
    std::vector<std::string> models;
    std::optional<double> contour, force_map_resolution_a;
    double level = 0.0;
    std::uint32_t vertices_max = 1'000'000, modes = 0;
    pid_t ends_with = 0;
    bool json = false, outside = false;
};

std::string now_utc() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

// The shortest text that is this number again.
template <class Number>
std::string exact(Number number) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

// So that the scene can be baked again with more structures. Without --allow-outside, which only admits the positions of structures.
BakeRecord record_of(const DockSettings& o) {
    BakeRecord record;
    record.inputs.push_back(bake_input("map", o.map.path));
    for (const std::string& half : o.map.half_maps) record.inputs.push_back(bake_input("half-map", half));
    if (!o.map.mask.empty()) record.inputs.push_back(bake_input("mask", o.map.mask));
    for (const std::string& model : o.models) record.inputs.push_back(bake_input("structure", model));
    const auto add = [&](const char* option, const std::string& value) {
        record.options.insert(record.options.end(), {option, value});
    };
    if (o.map.resolution_a) add("--resolution-a", exact(*o.map.resolution_a));
    if (o.contour) add("--contour", exact(*o.contour));
    if (o.force_map_resolution_a) add("--force-map-resolution-a", exact(*o.force_map_resolution_a));
    if (o.vertices_max != DockSettings{}.vertices_max) add("--vertices-max", exact(o.vertices_max));
    if (o.modes > 0) add("--modes", exact(o.modes));
    return record;
}

DockingInput from_files(const DockSettings& o, const Progress& progress) {
    DockingInput input;
    report(progress, 0.0, "reading the map");
    ReadMap map = read_map(o.map);
    input.note = std::move(map.note);
    input.grid = std::move(map.grid);
    input.resolution_m = map.resolution_m;
    input.resolution_source = map.resolution_source;
    input.title = printable(fs::path(o.map.path).filename().string());
    const char* join = " and ";
    for (const std::string& path : o.models) {
        report(progress, 0.0, "reading structures");
        ImportedStructure model = import_structure(path);
        input.note.push_back("structure: " + printable(fs::absolute(path).string()));
        input.note.push_back("structure check: " + file_mark(path));
        input.note.push_back("structure content: " + printable(model.summary));
        input.title += join + model.structure.name;
        join = ", ";
        input.structures.push_back(std::move(model.structure));
    }
    for (std::string& line : note_lines(record_of(o))) input.note.push_back(std::move(line));
    input.outside = o.outside;
    return input;
}

DockingInput from_ring(const Progress& progress) {
    report(progress, 0.0, "computing the synthetic ring");
    SyntheticRing ring = make_ring();
    DockingInput input;
    input.title = "synthetic ring of six, one subunit free";
    input.note = {"map: made by tact-prep demo dock: six subunits, 12 Å, noise of 1 % of the highest density",
                  "map format: synthetic, " + grid_text(ring.grid),
                  "map origin: chosen, the axis of the ring is z through (0, 0, 0)",
                  "structure: subunit A of the same ring, at its position in the map"};
    input.grid = std::move(ring.grid);
    input.structures.push_back(std::move(ring.subunits.front()));
    input.resolution_m = ring.resolution_m;
    input.resolution_source = "of the Gaussians that the map is made of";
    return input;
}

void dock(const DockSettings& o, bool demo) {
    std::vector<std::string> inputs = o.models;
    for (const std::string& file : o.map.paths()) inputs.push_back(file);
    check_target("write scene", o.scene, inputs);
    const auto started = std::chrono::steady_clock::now();
    Console console;
    const Progress progress = console.progress();
    DockingInput input = demo ? from_ring(progress) : from_files(o, progress);
    input.note.insert(input.note.begin(),
                      {"made by: " + program_version("tact-prep"), "made at: " + now_utc()});
    if (o.contour) input.contour = o.contour;
    if (o.force_map_resolution_a) input.force_map_resolution_m = *o.force_map_resolution_a * kAngstromM;
    input.vertices_max = o.vertices_max;
    input.modes = o.modes;
    SceneWriter out;
    const BakedDocking baked = bake_docking(input, out, progress);
    report(progress, 0.99, "writing the scene");
    out.write(o.scene);
    console.clear();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (o.json) {
        nlohmann::ordered_json json = scene_json(SceneFile::open(o.scene), report_docking);
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

void contour_scene(const DockSettings& o) {
    check_target("write contour", o.scene, {o.source});
    Console console;
    if (o.ends_with != 0 && !end_with_parent(o.ends_with, SIGTERM)) throw Cancelled{};
    SceneWriter out;
    const BakedContour baked =
        bake_contour(SceneFile::open(o.source), o.level, o.vertices_max, out, console.progress());
    out.write(o.scene);
    console.clear();
    std::printf("%s: level %g, %zu vertices found, %u kept, coarsest level %u; %u triangles\n",
                o.scene.c_str(), o.level, baked.vertices_found, baked.vertices, baked.vertices_min,
                baked.triangles);
}

}  // namespace

void add_dock(CLI::App& app, CLI::App& demo) {
    const auto o = std::make_shared<DockSettings>();
    const auto both = [&](CLI::App* sub) {
        sub->add_option("-o,--output", o->scene, "Scene file to write")->required()->type_name("SCENE");
        sub->add_option(
            "--contour", o->contour,
            "Contour level of the drawn surface, in the map's unit; default: chosen from the histogram");
        sub->add_option(
            "--force-map-resolution-a", o->force_map_resolution_a,
            "Resolution (angstrom) to which the force map is smoothed, so that it attracts a structure from "
            "farther away; default: not smoothed");
        sub->add_option("--vertices-max", o->vertices_max,
                        "Maximum number of vertices of the drawn surface; 0: no limit")
            ->capture_default_str();
        sub->add_option("--modes", o->modes,
                        "Normal modes of each structure, along which it can bend; 12 are a good start")
            ->check(CLI::Range(0U, kModesMax))
            ->capture_default_str();
        sub->add_flag("--json", o->json, "Print the properties of the baked scene as JSON");
    };
    CLI::App* const from_files =
        app.add_subcommand("dock", "Bake a docking scene from a density map and one or more structures");
    from_files->add_option("map", o->map.path, "Density map: MRC, CCP4 or Situs, also .gz")->required();
    from_files->add_option("models", o->models, "Structures: PDB or mmCIF, also .gz; one body per file")
        ->required();
    o->map.add_options(*from_files);
    from_files->add_flag("--allow-outside", o->outside,
                         "Accept structures whose positions in their files are far from the map; such a body "
                         "starts beside the map");
    both(from_files);
    from_files->callback([o] { dock(*o, false); });
    CLI::App* const made = demo.add_subcommand(
        "dock", "Bake a synthetic ring of six subunits in its 12 A map, with one subunit free");
    both(made);
    made->callback([o] { dock(*o, true); });
}

void add_examine_dock(CLI::App& examine) {
    const auto o = std::make_shared<DockSettings>();
    CLI::App* const files = examine.add_subcommand(
        "dock", "A map and its structures: sizes, values, and the contour that is proposed");
    files->add_option("map", o->map.path, "Density map, as for tact-prep dock")->required();
    files->add_option("models", o->models, "Structures")->required();
    files->callback([o] {
        Console console;
        const ImportReport report = examine_map(o->map.path, o->models, console.progress());
        console.clear();
        print_import_report(report);
    });
}

void add_contour(CLI::App& app) {
    const auto o = std::make_shared<DockSettings>();
    CLI::App* const level =
        app.add_subcommand("contour", "Extract the surface of a docking scene's map at another level");
    level->add_option("scene", o->source, "Baked docking scene")->required();
    level->add_option("--level", o->level, "Contour level of the surface, in the map's unit")->required();
    level->add_option("-o,--output", o->scene, "Scene file to write")->required()->type_name("SCENE");
    level
        ->add_option("--vertices-max", o->vertices_max,
                     "Maximum number of vertices of the surface; 0: no limit")
        ->capture_default_str();
    level
        ->add_option("--ends-with", o->ends_with,
                     "Cancel when the process with this id ends (for programs that start tact-prep)")
        ->type_name("PID");
    level->callback([o] { contour_scene(*o); });
}

}  // namespace tact
