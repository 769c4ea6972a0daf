#include "rt/replay/recorded_scene.hpp"

#include <cstdlib>
#include <system_error>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"

namespace tact {

namespace fs = std::filesystem;

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
    std::vector<fs::path> places{recording.parent_path() / name, name};
    if (recorded.is_absolute()) places.insert(places.begin(), recorded);
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    const char* const home = std::getenv("HOME");
    if (cache != nullptr && *cache == '/')
        places.push_back(fs::path(cache) / "tact" / name);
    else if (home != nullptr && *home == '/')
        places.push_back(fs::path(home) / ".cache" / "tact" / name);
    bool another = false;
    for (const fs::path& place : places) {
        std::error_code unknown;
        if (name.empty() || !fs::is_regular_file(place, unknown)) continue;
        try {
            SceneFile scene = SceneFile::open(place);
            if (scene.checksum() == about.scene_checksum) return scene;
        } catch (const StartupError&) {  // not a scene: treated as a different one
        }
        another = true;
    }
    throw StartupError(
        "finding the recorded scene '" + name.string() + "'",
        another ? "the file of this name is a different scene"
                : "it is neither beside the recording, nor in this folder, nor among the baked scenes",
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
