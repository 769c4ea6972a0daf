// tact drill SCAN: bakes the bone once, then runs it, with a burr in one hand and a suction tube in the other.
#include <memory>

#include "deploy/tact/baked_run.hpp"
#include "deploy/tact/commands.hpp"

namespace tact::launch {
namespace {

constexpr PrepOption kDrillPrep[] = {
    {"--threshold-hu", "HU", "no bone here and below; 300 if absent"},
    {"--solid-hu", "HU", "solid bone here and above; 1800 if absent"},
    {"--voxel-mm", "MM", "edge of a voxel; if absent the scan's finest"},
    {"--crop", "RANGES", "first:end of columns, rows and slices: 0:256,0:256,10:90"},
    {"--series", "N", "which DICOM series, where there are several"},
    {"--critical", "WORD", "word in the names of structures to keep away from, besides nerve, ..."},
    {"--unit", "m|cm|mm|um", "unit of lengths in files that name none; default mm"},
    {"--spacing-mm", "MM",
     "distances in a stack of pictures: between columns, rows and slices, or one for all"},
    {"--bone-colour", "R,G,B", "colour of bone in coloured pictures"},
    {"--face", "front|back|left|right|top|bottom", "side of the patient that faces the user; default front"},
};

struct DrillOptions {
    std::filesystem::path scan, labels, label_names;
    BakedRun baked;
};

int drill(DrillOptions& o) {
    BakeRequest request{.inputs = scan_files(o.scan),
                        .words = {"drill", std::filesystem::absolute(o.scan)},
                        .options = o.baked.prep};
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
    auto* const command = app.add_subcommand("drill", "drill the bone of a CT scan");
    const auto o = std::make_shared<DrillOptions>();
    command
        ->add_option("SCAN", o->scan,
                     "a folder of DICOM files or of PNG pictures, or NRRD, NIfTI or MetaImage, also .gz")
        ->required()
        ->check(CLI::ExistingPath);
    command->add_option("--labels", o->labels, "which structure each voxel is of: NRRD, NIfTI or MetaImage")
        ->check(CLI::ExistingFile);
    command
        ->add_option("--label-names", o->label_names,
                     "names of the labelled structures: a list as ITK-SNAP writes it")
        ->check(CLI::ExistingFile);
    add_baked_run_options(*command, kDrillPrep, o->baked);
    command->callback([o, &exit_code] { exit_code = drill(*o); });
}

}  // namespace tact::launch
