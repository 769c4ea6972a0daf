#include "deploy/tact/replay_continue.hpp"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/observer.hpp"
#include "deploy/tact/systems.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact::launch {
namespace {

namespace fs = std::filesystem;
constexpr auto kKeeperLimit = std::chrono::seconds(60);

// A name without a file of either kind.
fs::path free_stem(const fs::path& folder, const ReplayTopic& replay) {
    char at[32];
    std::snprintf(at, sizeof at, "-%.3fs", replay.at_s);
    const std::string name =
        fs::path(field_text(replay.name, sizeof replay.name)).stem().filename().string() + at;
    for (int i = 1;; ++i) {
        fs::path stem = folder / (i == 1 ? name : name + "-" + std::to_string(i));
        if (!fs::exists(stem.string() + kSessionEnding) && !fs::exists(stem.string() + ".bone")) return stem;
    }
}

// The keeper of the system, if it has one, copies what changed since the run began, and ends. Empty: nothing changed.
fs::path keep_changes(SystemRun& run, const fs::path& file, const std::string& session) {
    RunOptions options;
    options.session = session;
    options.keep = file;
    ChildSettings s;
    s.arguments = run.keeper_arguments(options);
    if (s.arguments.empty()) return {};
    s.arguments.insert(s.arguments.end(), {"--seconds", "0.3", "--wait", "10", "--quiet"});
    Child keeper("tact-record", find_program("tact-record"), s);
    const auto& ending = keeper.wait(kKeeperLimit);
    if (!ending || !ending->clean())
        throw StartupError("keeping the bone of the replay in " + file.string(), "tact-record failed",
                           "see its message above");
    return fs::exists(file) ? file : fs::path();
}

}  // namespace

fs::path keep_moment(const RtRegion& region, const ReplayTopic& replay, const std::string& session) {
    const fs::path folder = state_folder();
    if (folder.empty())
        throw StartupError("continuing from a replay", "neither XDG_STATE_HOME nor HOME is set",
                           "set one of them to a writable folder");
    std::error_code error;
    fs::create_directories(folder / "from-replay", error);
    if (error)
        throw StartupError("creating the folder " + (folder / "from-replay").string(), error.message(),
                           "make its parent folder writable");
    const fs::path stem = free_stem(folder / "from-replay", replay);
    Session moment;
    moment.scene = field_text(region.scene_path, sizeof region.scene_path);
    const SceneFile scene = SceneFile::open(moment.scene);
    moment.scene_checksum = scene.checksum();
    nlohmann::json report = nlohmann::json::object();
    const std::unique_ptr<SystemRun> run = system_of(scene).open_run(scene);
    run->report(region, report);
    if (report.contains("bodies") && !report["bodies"].empty()) moment.bodies = report["bodies"].dump();
    moment.bone = keep_changes(*run, stem.string() + ".bone", session);
    fs::path file = stem.string() + kSessionEnding;
    write_whole(file, session_text(moment, file));
    return file;
}

}  // namespace tact::launch
