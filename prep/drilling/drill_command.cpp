#include "prep/drilling/drill_command.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"
#include "ipc/base/whole_numbers.hpp"
#include "ipc/version/version.hpp"
#include "prep/console/console.hpp"
#include "prep/console/scene_report.hpp"
#include "prep/console/target.hpp"
#include "prep/drilling/bake_bone.hpp"
#include "prep/drilling/bone_commands.hpp"
#include "prep/drilling/examine_scan.hpp"
#include "prep/drilling/import_bone.hpp"
#include "prep/drilling/structure_names.hpp"
#include "prep/synthetic/temporal_bone.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;

struct DrillSettings {
    std::string scan, labels, label_names, structures, scene, crop, unit = "mm", face = "front";
    std::vector<double> spacing_mm;
    std::vector<unsigned> bone_colour;
    std::optional<double> threshold, solid;
    BoneImport import;
    bool synthetic = false;
    TemporalBone made;
    double made_voxel_mm = 0.0;
    bool json = false;
};

constexpr std::pair<const char*, double> kDrillUnits[] = {
    {"m", 1e3}, {"cm", 10.0}, {"mm", 1.0}, {"um", 1e-3}};
constexpr std::pair<const char*, BoneFace> kDrillFaces[] = {
    {"front", BoneFace::front}, {"back", BoneFace::back}, {"left", BoneFace::left},
    {"right", BoneFace::right}, {"top", BoneFace::top},   {"bottom", BoneFace::bottom}};

template <class T, std::size_t n>
std::set<std::string> drill_names(const std::pair<const char*, T> (&table)[n]) {
    std::set<std::string> names;
    for (const auto& row : table) names.insert(row.first);
    return names;
}
template <class T, std::size_t n>
T drill_value(const std::pair<const char*, T> (&table)[n], const std::string& name) {
    return std::find_if(std::begin(table), std::end(table),
                        [&](const auto& row) { return name == row.first; })
        ->second;
}

// Parses "0:256,0:256,10:90".
ScanCrop parse_crop(const std::string& text) {
    ScanCrop crop;
    const auto ends = numbers_between(text, ":,:,:");
    if (!ends)
        throw StartupError("--crop " + text, "the text is not three ranges first:end",
                           "give columns, rows and slices, as in --crop 0:256,0:256,10:90");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        crop.low[axis] = (*ends)[2 * axis];
        crop.high[axis] = (*ends)[2 * axis + 1];
    }
    return crop;
}

void say_memory(double voxels, double bytes) {
    std::fprintf(stderr, "%.0f million voxels; about %.0f MB of memory needed\n", 1e-6 * voxels,
                 1e-6 * bytes);
}

BoneInput drill_made(const DrillSettings& o, Console& console) {
    BoneInput input;
    TemporalBone made = o.made;
    made.voxel_m = o.made_voxel_mm > 0.0 ? 1e-3 * o.made_voxel_mm : 0.05 / made.voxels;
    BoneBricks bricks;
    bricks.size = {made.voxels, made.voxels, made.voxels};
    bricks.voxel_m = made.voxel_m;
    say_memory(static_cast<double>(bricks.bytes()), bake_bytes(bricks, true, 8));
    const Progress progress = console.progress();
    input.bone = make_temporal_bone(
        made, [&](double fraction, const char* what) { return progress(0.5 * fraction, what); });
    input.title = "synthetic temporal bone, right";
    input.note = {"bone: made by tact-prep, a right temporal bone with random seed " +
                  std::to_string(made.seed)};
    return input;
}

ScanRequest scan_request(const DrillSettings& o) {
    ScanRequest request = o.import.request;
    request.unit_mm = drill_value(kDrillUnits, o.unit);
    if (o.spacing_mm.size() == 1 || o.spacing_mm.size() == 3)
        for (std::size_t a = 0; a < 3; ++a)
            request.spacing_mm[static_cast<int>(a)] = o.spacing_mm[o.spacing_mm.size() == 1 ? 0 : a];
    else if (!o.spacing_mm.empty())
        throw StartupError("--spacing-mm", "two numbers are given",
                           "give one number, or three for columns, rows and slices");
    return request;
}

BoneInput drill_scan(const DrillSettings& o, Console& console) {
    BoneImport settings = o.import;
    settings.scan = o.scan;
    settings.labels = o.labels;
    settings.label_names = o.label_names;
    settings.threshold = o.threshold;
    settings.solid = o.solid;
    if (!o.crop.empty()) settings.crop = parse_crop(o.crop);
    settings.face = drill_value(kDrillFaces, o.face);
    settings.request = scan_request(o);
    for (std::size_t c = 0; c < 3 && o.bone_colour.size() == 3; ++c)
        settings.bone_colour[c] = static_cast<std::uint8_t>(o.bone_colour[c]);
    settings.announce = say_memory;
    settings.warn = [&console](const std::string& line) {
        console.clear();
        std::fprintf(stderr, "warning: %s\n", line.c_str());
    };
    return import_bone(settings, console.progress());
}

void add_scan_request(CLI::App& command, DrillSettings& o) {
    command.add_option("--series", o.import.request.series,
                       "Number of the DICOM series, from 1, if the folder holds several");
    command.add_option("--unit", o.unit, "Unit of length of files that name none")
        ->check(CLI::IsMember(drill_names(kDrillUnits)))
        ->capture_default_str();
    command
        .add_option("--spacing-mm", o.spacing_mm,
                    "Spacing of columns, rows and slices of a PNG stack (mm), or one number for all")
        ->delimiter(',')
        ->check(CLI::Range(0.001, 100.0));
}

void drill(const DrillSettings& o, bool made) {
    if (!made && o.scan.empty())
        throw StartupError("tact-prep drill", "no scan is given", "give a file or a folder, or --synthetic");
    check_target("write scene", o.scene, {o.scan, o.labels, o.label_names});
    const auto started = std::chrono::steady_clock::now();
    Console console;
    BoneInput input = made ? drill_made(o, console) : drill_scan(o, console);
    input.note.insert(input.note.begin(), "made by: " + program_version("tact-prep"));
    const BoneBricks bricks = input.bone.bricks;
    const std::size_t structures = input.bone.structure.size();
    if (!o.structures.empty())
        write_whole_file(o.structures, structure_table_text(input.table, input.table_voxels));
    SceneWriter out;
    const BakedBone baked = bake_bone(std::move(input), out, console.progress());
    report(console.progress(), 0.99, "writing the scene");
    out.write(o.scene);
    console.clear();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    print_written_scene(o.scene, baked.note, seconds, o.json,
                        {{"size", bricks.size},
                         {"voxel_m", bricks.voxel_m},
                         {"bone_voxels", baked.bone_voxels},
                         {"bone_m3", baked.bone_m3},
                         {"structures", structures},
                         {"distance_fields", baked.distance_fields}});
}

}  // namespace

void add_examine_drill(CLI::App& examine) {
    const auto o = std::make_shared<DrillSettings>();
    CLI::App* const scan = examine.add_subcommand(
        "drill", "A CT scan: its size, its values, its series, and the values of bone that are proposed");
    scan->add_option("scan", o->scan, "CT scan, as for tact-prep drill")->required();
    add_scan_request(*scan, *o);
    scan->callback([o] {
        Console console;
        const ImportReport report = examine_scan(o->scan, scan_request(*o), console.progress());
        console.clear();
        print_import_report(report);
    });
}

void add_drill(CLI::App& app, CLI::App& demo) {
    const auto o = std::make_shared<DrillSettings>();
    const auto both = [&](CLI::App* sub) {
        sub->add_option("-o,--output", o->scene, "Scene file to write")->required()->type_name("SCENE");
        sub->add_option("--voxels", o->made.voxels, "Number of voxels of the synthetic bone along each axis")
            ->check(CLI::Range(16U, 1024U))
            ->capture_default_str();
        sub->add_option("--seed", o->made.seed,
                        "Random seed for the air cells and the roughness of the synthetic bone")
            ->capture_default_str();
        sub->add_option("--voxel-mm", o->made_voxel_mm,
                        "Edge of a voxel (mm); default: finest spacing of the scan, and 50 mm / voxels for "
                        "the synthetic bone")
            ->check(CLI::Range(0.001, 100.0));
        sub->add_flag("--json", o->json, "Print the properties of the baked scene as JSON");
    };
    CLI::App* const from_scan = app.add_subcommand("drill", "Bake bone to drill from a CT scan");
    from_scan->add_option(
        "scan", o->scan,
        "CT scan: a folder of DICOM files or of PNG images, or NRRD, NIfTI or MetaImage, also .gz");
    from_scan->add_flag("--synthetic", o->synthetic,
                        "Bake the synthetic temporal bone of demo drill instead of a scan");
    from_scan->add_option("--labels", o->labels,
                          "Label map with the structure of each voxel: NRRD, NIfTI or MetaImage");
    from_scan->add_option(
        "--label-names", o->label_names,
        "Names of the labelled structures: a table (.toml), or a label description file of ITK-SNAP; "
        "default: structures.toml in the folder, NAME.structures.toml beside the file");
    from_scan
        ->add_option("--write-structures", o->structures,
                     "Write the structures that were found as a table to edit (TOML), for --label-names or "
                     "beside the scan")
        ->type_name("FILE.toml");
    from_scan->add_option(
        "--critical", o->import.critical,
        "Words in the names of critical structures, in addition to nerve, sinus, dura, artery, ...");
    from_scan->add_option(
        "--threshold-hu", o->threshold,
        "Value at and below which a voxel holds no bone (HU, or the unit of the file); default 300 HU");
    from_scan->add_option(
        "--solid-hu", o->solid,
        "Value at and above which bone is solid (HU, or the unit of the file); default 1800 HU");
    from_scan->add_option("--crop", o->crop,
                          "Ranges first:end of columns, rows and slices, counted from 0, such as "
                          "0:256,0:256,10:90; slices in order of position; default: all");
    add_scan_request(*from_scan, *o);
    from_scan
        ->add_option("--bone-colour", o->bone_colour,
                     "Colour of bone in coloured PNG images: red,green,blue; default 255,249,219")
        ->delimiter(',')
        ->expected(3)
        ->check(CLI::Range(0U, 255U));
    from_scan->add_option("--face", o->face, "Side of the patient that faces the user")
        ->check(CLI::IsMember(drill_names(kDrillFaces)))
        ->capture_default_str();
    both(from_scan);
    from_scan->callback([o] {
        o->import.voxel_mm = o->made_voxel_mm;
        drill(*o, o->synthetic);
    });
    add_bone_commands(app);
    CLI::App* const made = demo.add_subcommand("drill", "Bake a synthetic temporal bone, right side");
    both(made);
    made->callback([o] { drill(*o, true); });
}

}  // namespace tact
