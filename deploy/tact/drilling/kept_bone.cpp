#include "deploy/tact/drilling/kept_bone.hpp"

#include <algorithm>
#include <ctime>
#include <string>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"

namespace tact::launch {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEnding = ".bone";

fs::path bone_folder() {
    const fs::path state = state_folder();
    if (state.empty())
        throw StartupError("keeping drilled bone", "neither XDG_STATE_HOME nor HOME is set",
                           "set one of them, or name a file: --keep");
    return state / "drilled";
}

// Newest first.
std::vector<fs::path> bone_files() {
    std::vector<std::pair<fs::file_time_type, fs::path>> found;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(bone_folder(), failed))
        if (entry.path().extension() == kEnding && entry.is_regular_file(failed))
            found.emplace_back(entry.last_write_time(failed), entry.path());
    std::sort(found.rbegin(), found.rend());
    std::vector<fs::path> files;
    files.reserve(found.size());
    for (auto& [time, path] : found) files.push_back(std::move(path));
    return files;
}

}  // namespace

fs::path new_bone_file(const fs::path& scene, const fs::path& resumed) {
    const std::vector<fs::path> files = bone_files();
    std::error_code failed;
    for (std::size_t i = kBoneFilesKept - 1; i < files.size(); ++i)
        if (!fs::equivalent(files[i], resumed, failed)) fs::remove(files[i], failed);
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char time[32];
    std::strftime(time, sizeof time, "%Y-%m-%d-%H%M%S", &local);
    const std::string name = scene.stem().string() + "-" + time;
    fs::path file = bone_folder() / (name + kEnding);
    for (int i = 2; fs::exists(file); ++i) file = bone_folder() / (name + "-" + std::to_string(i) + kEnding);
    return file;
}

fs::path last_bone_file(std::uint64_t scene_checksum) {
    for (fs::path& file : bone_files())
        if (drilled_bone_scene(file) == scene_checksum) return std::move(file);
    throw StartupError("continuing with the bone that was drilled last",
                       "no file in " + bone_folder().string() + " belongs to this scene",
                       "name a file: --resume FILE.bone");
}

}  // namespace tact::launch
