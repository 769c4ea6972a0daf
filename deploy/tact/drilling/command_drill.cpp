// tact drill SCAN: bakes the bone once, then runs it with a burr in one hand and a suction tube in the other.
// tact demo drill: an emulated surgeon opens the mastoid of a synthetic temporal bone; a second hand holds suction.
#include <algorithm>
#include <memory>

#include "deploy/tact/baked_run.hpp"
#include "deploy/tact/drilling/drilling.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/run.hpp"
#include "ipc/scene/bone/structure_table.hpp"

namespace tact::launch {
namespace {

constexpr PassedOption kDrillPrep[] = {
    {"--threshold-hu", "HU", "Value at and below which a voxel holds no bone (HU); default 300"},
    {"--solid-hu", "HU", "Value at and above which bone is solid (HU); default 1800"},
    {"--voxel-mm", "MM", "Edge of a voxel of the bone (mm); default: finest spacing of the scan"},
    {"--crop", "RANGES",
     "Ranges first:end of columns, rows and slices, such as 0:256,0:256,10:90; default: all"},
    {"--series", "N", "Number of the DICOM series, if the folder holds several"},
    {"--critical", "WORD",
     "Word in the names of critical structures, in addition to nerve, sinus, dura, ..."},
    {"--unit", "m|cm|mm|um", "Unit of length of files that name none; default mm"},
    {"--spacing-mm", "MM",
     "Spacing of columns, rows and slices of an image stack (mm), or one number for all"},
    {"--bone-colour", "R,G,B",
     "Colour of bone in coloured images, each channel from 0 to 255; default 255,249,219"},
    {"--face", "front|back|left|right|top|bottom", "Side of the patient that faces the user; default front"},
};

constexpr PassedOption kDrillController[] = {
    {"--hand-at-mm", "X,Y", "Position at which an emulated surgeon works (mm)"},
    {"--pedal", "button|line|always",
     "Switch of the burr: stylus button, foot pedal on an input line, or always on"},
    {"--burr-mm", "MM", "Burr diameter (mm)"},
    {"--burr-shape", "sphere|cylinder|cone", "Burr shape"},
    {"--burr-grit", "cutting|diamond", "Burr with flutes or with grains of diamond"},
    {"--burr-rpm", "RPM", "Burr speed (rpm)"},
    {"--resume", "FILE.bone",
     "Start with the bone as an earlier run kept it; last: the newest file of this scene"},
};

struct DrillOptions {
    std::filesystem::path scan, labels, label_names;
    BakedRun baked;
};

int drill(DrillOptions& o) {
    BakeRequest request{.inputs = scan_files(o.scan),
                        .words = {"drill", std::filesystem::absolute(o.scan)},
                        .options = o.baked.prep};
    for (const auto& scan : {o.scan, o.labels})
        if (const auto table = structure_table_beside(scan); !table.empty()) request.inputs.push_back(table);
    for (const auto& [name, file] : {std::pair("--labels", &o.labels), {"--label-names", &o.label_names}}) {
        if (file->empty()) continue;
        for (const auto& part : scan_files(*file)) request.inputs.push_back(part);
        request.options.insert(request.options.end(), {name, std::filesystem::absolute(*file)});
    }
    let_the_hands_drill(o.baked.run);
    return bake_and_run(request, o.baked);
}

}  // namespace

void add_drill(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand("drill", "Drill the bone of a CT scan");
    const auto o = std::make_shared<DrillOptions>();
    command
        ->add_option(
            "SCAN", o->scan,
            "CT scan: a folder of DICOM files or of PNG images, or NRRD, NIfTI or MetaImage, also .gz")
        ->required()
        ->check(CLI::ExistingPath);
    command
        ->add_option("--labels", o->labels,
                     "Label map with the structure of each voxel: NRRD, NIfTI or MetaImage")
        ->check(CLI::ExistingFile);
    command
        ->add_option("--label-names", o->label_names,
                     "Names of the labelled structures: a table (.toml), or a label description file of "
                     "ITK-SNAP; default: "
                     "structures.toml in the folder, NAME.structures.toml beside the file")
        ->check(CLI::ExistingFile);
    add_baked_run_options(*command, kDrillPrep, o->baked);
    command->callback([o, &exit_code] { exit_code = drill(*o); });
}

namespace {

void add_ear_demo(CLI::App& demo, const char* name, const char* what, bool training, int& exit_code) {
    auto* const command = demo.add_subcommand(name, what);
    const auto baked = std::make_shared<BakedRun>();
    const auto voxels = std::make_shared<std::string>("256");
    command->add_option("--voxels", *voxels, "Number of voxels of the bone along each axis, from 16 to 1024")
        ->capture_default_str();
    add_demo_run_options(*command, *baked);
    command->callback([baked, voxels, training, &exit_code] {
        RunOptions& options = baked->run;
        const auto& window = options.visual;
        if (training && std::find(window.begin(), window.end(), "--training") == window.end()) {
            const auto task = cache_folder() / "demo-task.toml";
            write_whole(task, kDemoTask);
            options.visual.insert(options.visual.end(), {"--training", task.string()});
        }
        let_the_hands_drill(options);
        if (options.has_controller_option("surgeon") && !options.has_controller_option("--hand-at-mm"))
            options.add_for_scene({"--hand-at-mm", kMastoidMm});
        exit_code = bake_and_run(
            {.inputs = {}, .words = {"demo", "drill", "--voxels", *voxels}, .options = {}}, *baked);
    });
}

}  // namespace

void add_drill_demo(CLI::App& demo, int& exit_code) {
    add_ear_demo(demo, "drill", "Two hands open a temporal bone with a burr and a suction tube", false,
                 exit_code);
    add_ear_demo(demo, "train", "The same as a training task, with a checklist, points and a report", true,
                 exit_code);
}

std::span<const PassedOption> drilling_controller_options() { return kDrillController; }

void let_the_hands_drill(RunOptions& options) {
    if (!hand_is_free(options)) return;
    options.add_for_scene({"--hand", "surgeon"});
    if (!options.has_controller_option("--hand2")) options.add_for_scene({"--hand2", "suction-tube"});
}

}  // namespace tact::launch
