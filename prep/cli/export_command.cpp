#include "prep/cli/export_command.hpp"

#include <cstdio>
#include <memory>

#include "ipc/scene/file/scene_meta.hpp"
#include "prep/export/export_bodies.hpp"
#include "prep/input/read_file.hpp"

namespace tact {
namespace {

constexpr std::uint64_t kPosesBytesMax = std::uint64_t{64} << 20;  // a run's report holds more than places

struct ExportRequest {
    std::string scene, poses;
    ExportOptions options;
};

void run_export(const ExportRequest& request) {
    const SceneFile scene = SceneFile::open(request.scene);
    const std::vector<char> json = read_whole_file(request.poses, kPosesBytesMax);
    const std::vector<PlacedBody> bodies =
        read_poses({json.data(), json.size()}, request.poses, read_meta(scene).body_count);
    for (const auto& path : export_bodies(scene, bodies, request.options))
        std::printf("wrote %s\n", path.c_str());
}

}  // namespace

void add_export(CLI::App& app) {
    CLI::App* const command = app.add_subcommand(
        "export", "placed structures as PDB or mmCIF files, matrices and a table; inputs stay as they are");
    const auto request = std::make_shared<ExportRequest>();
    command->add_option("scene", request->scene, "a baked scene")->required();
    command->add_option("--poses", request->poses, "JSON with the places of bodies, as run.json has them")
        ->type_name("FILE.json")
        ->required();
    command
        ->add_option("-o,--output", request->options.folder, "folder to write to; made where it is not there")
        ->type_name("DIR")
        ->required();
    command->add_flag("--combined", request->options.combined,
                      "also all bodies in one file, each chain with an id of its own");
    command->add_flag("--force", request->options.force,
                      "write over files that are there (never over the structures the scene was baked from)");
    command->callback([request] { run_export(*request); });
}

}  // namespace tact
