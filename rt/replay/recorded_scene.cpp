#include "rt/replay/recorded_scene.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/session/recent_scenes.hpp"

namespace tact {

namespace fs = std::filesystem;

namespace {

// Where the scene may be: beside the recording, in this folder, among the baked scenes, and in the window's list of
// recent scenes, there first under its own name. unreadable: a line about a damaged list.
std::vector<fs::path> places_of(const fs::path& recorded, const fs::path& recording,
                                std::string& unreadable) {
    const fs::path name = recorded.filename();
    std::vector<fs::path> places{recording.parent_path() / name, name};
    if (recorded.is_absolute()) places.insert(places.begin(), recorded);
    if (const fs::path baked = user_folder("XDG_CACHE_HOME", ".cache"); !baked.empty())
        places.push_back(baked / name);
    std::vector<RecentScene> recents;
    try {
        if (!recents_file().empty()) recents = read_recents(recents_file());
    } catch (const StartupError& e) {
        unreadable = std::string("\n    the window's recent scenes could not be read: ") + e.what();
    }
    const auto same_name = [&](const RecentScene& s) { return fs::path(s.path).filename() == name; };
    std::stable_partition(recents.begin(), recents.end(), same_name);
    for (const RecentScene& s : recents) places.emplace_back(s.path);
    std::vector<fs::path> once;
    for (const fs::path& place : places) {
        std::error_code unknown;
        const fs::path full = fs::absolute(place, unknown).lexically_normal();
        if (std::find(once.begin(), once.end(), full) == once.end()) once.push_back(full);
    }
    return once;
}

}  // namespace

SceneFile open_recorded_scene(const RecordingReader::About& about, const fs::path& recording,
                              const fs::path& scene_path) {
    if (!scene_path.empty()) {
        SceneFile scene = SceneFile::open(scene_path);
        if (scene.checksum() != about.scene_checksum)
            throw StartupError("replaying on '" + scene.name() + "'",
                               "the scene differs from the recorded one",
                               "give the recorded scene with --scene, or bake it again as it was");
        return scene;
    }
    const fs::path recorded(about.scene_path), name = recorded.filename();
    std::string unreadable, looked;
    for (const fs::path& place : places_of(recorded, recording, unreadable)) {
        std::error_code unknown;
        if (name.empty() || !fs::is_regular_file(place, unknown)) {
            looked += "\n    " + place.string();
            continue;
        }
        try {
            SceneFile scene = SceneFile::open(place);
            if (scene.checksum() == about.scene_checksum) return scene;
        } catch (const StartupError&) {  // not a scene: treated as a different one
        }
        looked += "\n    " + place.string() + " (a different scene)";
    }
    throw StartupError("finding the recorded scene '" + name.string() + "'",
                       "it is not where it was looked for:" + looked + unreadable,
                       "give the recorded scene with --scene, or bake it again as it was");
}

fs::path find_recorded_bone(const std::string& name, const std::string& identity, const fs::path& recording,
                            const fs::path& given) {
    std::vector<fs::path> places{recording.parent_path() / name, name};
    if (!given.empty())
        places = {given};
    else if (const fs::path state = state_folder(); !state.empty())
        places.push_back(state / "drilled" / name);
    bool another = false;
    for (const fs::path& place : places) {
        std::error_code unknown;
        if (!fs::is_regular_file(place, unknown)) continue;
        if (file_identity(place) == identity) return place;
        another = true;
    }
    throw StartupError("finding the drilled bone '" + name + "' with which the recorded run started",
                       another ? "the file changed since this run was recorded" : "there is no such file",
                       "give the file as it was with --bone, or record another run");
}

}  // namespace tact
