#include "prep/cli/export_command.hpp"

#include <cstdio>
#include <memory>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "prep/export/export_bodies.hpp"
#include "prep/input/read_file.hpp"
#include "prep/map/import_map.hpp"

namespace tact {
namespace {

constexpr std::uint64_t kPosesBytesMax = std::uint64_t{64} << 20;  // a run report holds more than poses

struct ExportRequest {
    std::string scene, poses, local_resolution;
    ExportOptions options;
};

void run_export(const ExportRequest& request) {
    if (request.options.residues != 0 && request.options.residues % 2 == 0)
        throw StartupError("fit of residues", "the window is an even number of residues",
                           "give an odd one, e.g. 9");
    const SceneFile scene = SceneFile::open(request.scene);
    const std::vector<char> json = read_whole_file(request.poses, kPosesBytesMax);
    const std::vector<PlacedBody> bodies =
        read_poses({json.data(), json.size()}, request.poses, read_meta(scene).body_count);
    ExportOptions options = request.options;
    if (!request.local_resolution.empty())
        options.local_resolution = import_map(request.local_resolution).grid;
    for (const auto& path : export_bodies(scene, bodies, options)) std::printf("wrote %s\n", path.c_str());
}

}  // namespace

void add_export(CLI::App& app) {
    CLI::App* const command = app.add_subcommand("export",
                                                 "Write placed structures as PDB or mmCIF files, with "
                                                 "matrices and a table; input files stay unchanged");
    const auto request = std::make_shared<ExportRequest>();
    command->add_option("scene", request->scene, "Baked docking scene")->required();
    command->add_option("--poses", request->poses, "Poses of the bodies (JSON), in the format of run.json")
        ->type_name("FILE.json")
        ->required();
    command->add_option("-o,--output", request->options.folder, "Folder to write to, created if absent")
        ->type_name("DIR")
        ->required();
    command->add_option("--contour", request->options.contour,
                        "Contour level that the fractions inside refer to, in the map's unit; default: the "
                        "scene's");
    CLI::Option* const residues =
        command->add_option("--residues", request->options.residues,
                            "Also write the fit of each residue (CSV): mean density, and the correlation in "
                            "windows of so many residues along the "
                            "chain, an odd number, e.g. 9");
    residues->type_name("WINDOW")->check(CLI::Range(1, 999));
    command
        ->add_flag("--b-column", request->options.b_column,
                   "Write that correlation into the B column of the structures, to colour them by it")
        ->needs(residues);
    command
        ->add_option("--local-resolution", request->local_resolution,
                     "Map of local resolutions in angstrom, by a program that computes it from half-maps: "
                     "adds its mean to "
                     "the table of residues")
        ->type_name("MAP")
        ->needs(residues);
    command->add_flag("--combined", request->options.combined,
                      "Also write all bodies to one file, with a unique id per chain");
    command->add_flag("--force", request->options.force,
                      "Overwrite existing files, except the structures from which the scene was baked");
    command->callback([request] { run_export(*request); });
}

}  // namespace tact
