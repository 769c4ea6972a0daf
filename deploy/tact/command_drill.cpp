// tact drill SCAN: bakes the bone once, then runs it, with a burr in one hand and a sucker in the other.
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/run.hpp"
#include "deploy/tact/scene_cache.hpp"

namespace tact::launch {
namespace {

struct DrillOptions {
    RunOptions run;
    std::filesystem::path scan, labels, label_names;
    std::vector<std::string> prep;
    bool bake_only = false;
};

void drill(DrillOptions& o, int& exit_code) {
    BakeRequest request{.inputs = scan_files(o.scan),
                        .words = {"drill", std::filesystem::absolute(o.scan)},
                        .options = o.prep};
    for (const auto& [name, file] : {std::pair("--labels", &o.labels), {"--label-names", &o.label_names}}) {
        if (file->empty()) continue;
        for (const auto& part : scan_files(*file)) request.inputs.push_back(part);
        request.options.insert(request.options.end(), {name, std::filesystem::absolute(*file)});
    }
    const auto scene = baked_scene(request);
    if (scene.empty()) {
        exit_code = 130;
    } else if (o.bake_only) {
        std::puts(scene.c_str());
        exit_code = 0;
    } else {
        let_the_hands_drill(o.run);
        exit_code = run_scene(scene, o.run);
    }
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
    command->add_flag("--bake-only", o->bake_only, "bake the scene, print its path and stop");
    command->add_option("--labels", o->labels, "which structure each voxel is of: NRRD, NIfTI or MetaImage")
        ->check(CLI::ExistingFile);
    command->add_option("--label-names", o->label_names, "what they are called: a list as ITK-SNAP writes it")
        ->check(CLI::ExistingFile);
    for (const auto& [name, type, help] :
         {std::tuple("--threshold-hu", "HU", "no bone here and below; 300 if absent"),
          std::tuple("--solid-hu", "HU", "solid bone here and above; 1800 if absent"),
          std::tuple("--voxel-mm", "MM", "edge of a voxel; if absent the scan's finest"),
          std::tuple("--crop", "RANGES", "first:end of columns, rows and slices: 0:256,0:256,10:90"),
          std::tuple("--series", "N", "which DICOM series, where there are several"),
          std::tuple("--critical", "WORD",
                     "in the names of structures to keep away from, besides nerve, ..."),
          std::tuple("--unit", "UNIT", "of lengths in files that do not say: m, cm, mm (default) or um"),
          std::tuple("--spacing-mm", "MM", "of pictures: between columns, rows and slices, or one for all"),
          std::tuple("--bone-colour", "R,G,B", "of bone in coloured pictures"),
          std::tuple(
              "--face", "SIDE",
              "of the patient that looks at the user: front (default), back, left, right, top, bottom")}) {
        command
            ->add_option_function<std::string>(
                name,
                [o, n = std::string(name)](const std::string& v) {
                    o->prep.insert(o->prep.end(), {n, v});
                },
                help)
            ->type_name(type);
    }
    add_run_options(*command, o->run);
    command->callback([o, &exit_code] { drill(*o, exit_code); });
}

}  // namespace tact::launch
