#include "deploy/tact/docking/add_structures.hpp"

#include <cstdio>

#include "deploy/tact/files.hpp"
#include "deploy/tact/run.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/session/extend_session.hpp"

namespace tact::launch {
namespace {

namespace fs = std::filesystem;

}  // namespace

bool is_scene_or_session(const fs::path& file) { return file.extension() == ".tact" || is_session(file); }

BakeRequest request_with(const SceneFile& scene, const std::vector<fs::path>& models) {
    const std::string attempt = "adding a structure to " + scene.name();
    const SceneMeta meta = read_meta(scene);
    if (meta.kind != SceneKind::docking)
        throw StartupError(attempt,
                           std::string("it is a ") + scene_kind_text(meta.kind) + " scene, which has no map",
                           "add structures to a docking scene");
    const auto record = read_bake_record(read_note(scene));
    const std::vector<std::string> maps = record ? record->paths("map") : std::vector<std::string>();
    if (maps.size() != 1 || record->paths("structure").size() != meta.body_count)
        throw StartupError(
            attempt,
            "it does not record the files that it was baked from: it is synthetic, or an older tact-prep "
            "baked it",
            "bake it again from its files, with the new structure: tact dock MAP MODEL... --resolution-a A");
    if (meta.body_count + models.size() > kSceneBodiesMax)
        throw StartupError(attempt,
                           "it would have " + std::to_string(meta.body_count + models.size()) +
                               " structures, more than " + std::to_string(kSceneBodiesMax),
                           "join structures into one file, or copy a body of it in the tab Bodies");
    check_unchanged(*record, attempt);
    BakeRequest request{.inputs = {maps[0]}, .words = {"dock", maps[0]}, .options = {}};
    const auto structure = [&](const fs::path& model) {
        request.inputs.push_back(model);
        request.words.push_back(fs::absolute(model).lexically_normal().string());
    };
    for (const std::string& model : record->paths("structure")) structure(model);
    for (const fs::path& model : models) structure(model);
    for (const auto& [role, option] : {std::pair("half-map", "--half-map"), {"mask", "--mask"}})
        for (const std::string& file : record->paths(role)) {
            request.inputs.emplace_back(file);
            request.options.insert(request.options.end(), {option, file});
        }
    request.options.insert(request.options.end(), record->options.begin(), record->options.end());
    request.options.emplace_back("--allow-outside");
    return request;
}

int dock_into_scene(const fs::path& scene_or_session, const std::vector<fs::path>& models,
                    const BakedRun& baked) {
    if (!baked.prep.empty())
        throw StartupError("adding a structure to " + scene_or_session.string(),
                           baked.prep.front() + " is an option of its map, which stays as it is",
                           "leave it out, or bake from the files: tact dock MAP MODEL...");
    Session session;
    if (is_session(scene_or_session)) {
        session = read_session(scene_or_session);
        session.scene = find_session_scene(session);
    } else {
        session.scene = fs::absolute(scene_or_session);
        session.scene_checksum = SceneFile::open(session.scene).checksum();
    }
    const SceneFile shown = SceneFile::open(session.scene);
    const fs::path scene = baked_scene(request_with(shown, models));
    if (scene.empty()) return 130;
    if (baked.bake_only) {
        std::puts(scene.c_str());
        return 0;
    }
    // What is typed about start poses goes before what follows from the files.
    for (const char* const option : {"--poses", "--copies", "--start-offset-a", "--start-rotation-deg"})
        if (session.bodies.empty() && baked.run.has_controller_option(option))
            return run_scene(scene, baked.run);
    const ScratchFolder scratch;
    const fs::path continued = scratch.path() / ("added" + std::string(kSessionEnding));
    write_whole(continued, session_text(extended_session(session, shown, SceneFile::open(scene)), continued));
    return run_scene(continued, baked.run);
}

}  // namespace tact::launch
