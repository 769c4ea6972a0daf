#include "deploy/tact/scene_cache.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>

#include "deploy/tact/child.hpp"
#include "deploy/tact/files.hpp"
#include "deploy/tact/signals.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

constexpr std::size_t kScenesKept = 16;  // a scene with a large map has a few hundred megabytes

std::filesystem::path path_for(const BakeRequest& request, const std::filesystem::path& prep) {
    ContentHash hash;
    hash.add_file(prep);  // another version of tact-prep may bake differently
    for (const auto& file : request.inputs) {
        hash.add_file(file);
        // The path gives the structure's name and is read again for saving.
        hash.add(std::filesystem::absolute(file).string());
    }
    if (request.inputs.empty())
        for (const auto& w : request.words) hash.add(w);
    for (const auto& o : request.options) hash.add(o);
    std::string stem = request.inputs.empty() ? "demo" : request.inputs.front().stem().string();
    std::error_code ignored;
    if (!request.inputs.empty() && request.words.size() > 1 &&
        std::filesystem::is_directory(request.words[1], ignored))
        stem = std::filesystem::path(request.words[1]).filename().string();  // of a folder of slices
    stem = stem.substr(0, 60);
    return cache_folder() / (stem + "-" + hash.hex() + ".tact");
}

// Keeps the newest scenes; ignores files that cannot be removed.
void prune(const std::filesystem::path& folder, const std::filesystem::path& keep) {
    std::error_code ignored;
    std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".tact" && entry.path() != keep)
            scenes.emplace_back(entry.last_write_time(ignored), entry.path());
    std::sort(scenes.rbegin(), scenes.rend());
    for (std::size_t i = kScenesKept - 1; i < scenes.size(); ++i)
        std::filesystem::remove(scenes[i].second, ignored);
}

}  // namespace

std::vector<std::filesystem::path> scan_files(const std::filesystem::path& scan) {
    const std::string ending = scan.extension();
    const bool folder = std::filesystem::is_directory(scan);
    if (!folder && ending != ".mhd" && ending != ".nhdr") return {scan};
    std::vector<std::filesystem::path> files;
    const auto home = folder ? scan : std::filesystem::absolute(scan).parent_path();
    for (const auto& entry : std::filesystem::directory_iterator(home)) {
        if (!entry.is_regular_file()) continue;
        const auto& file = entry.path();
        if (folder || (file.filename() != scan.filename() &&
                       file.filename().string().starts_with(scan.stem().string() + ".")))
            files.push_back(file);
    }
    std::sort(files.begin(), files.end());
    // The scene is named after the scan.
    if (!folder) files.insert(files.begin(), scan);
    return files;
}

std::filesystem::path baked_scene(const BakeRequest& request) {
    const auto prep = find_program("tact-prep");
    auto scene = path_for(request, prep);
    std::error_code ignored;
    if (std::filesystem::exists(scene, ignored)) {
        std::filesystem::last_write_time(scene, std::filesystem::file_time_type::clock::now(), ignored);
        return scene;
    }
    ChildSettings settings;
    settings.arguments = request.words;
    settings.arguments.insert(settings.arguments.end(), {"-o", scene.string()});
    settings.arguments.insert(settings.arguments.end(), request.options.begin(), request.options.end());
    Signals signals;
    Child child("tact-prep", prep, settings);
    bool asked = false;
    while (!child.poll()) {
        if (signals.wait(50) != 0) {
            asked = true;
            child.stop();
        }
    }
    const Ending& ending = *child.poll();
    if (asked) return {};
    if (!ending.clean())
        throw StartupError("baking the scene", "tact-prep " + ending.text(),
                           "see the messages of tact-prep above, or tact-prep --help");
    if (!std::filesystem::exists(scene, ignored))
        throw StartupError("baking the scene", "tact-prep wrote no file " + scene.string(),
                           "check the free space of the cache folder");
    prune(scene.parent_path(), scene);
    return scene;
}

}  // namespace tact::launch
