// The list of scenes and the way to another one: what was used is kept, a folder is read beside the frame loop, and
// the launcher is asked. Without a launcher there is nobody who could end the controller and start it on another scene.
//
// Thread  frame thread; disks are waited for on another.
#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "gui/base/child_job.hpp"
#include "gui/window/dropped_files.hpp"
#include "gui/window/scene_list.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

class BrowserController {
public:
    // scene_switch: the launcher's folder; empty: there is none.
    explicit BrowserController(std::filesystem::path scene_switch) : scene_switch_(std::move(scene_switch)) {}
    // A scene is shown: it goes into the list, where a launcher runs it.
    void used(const std::filesystem::path& scene, BrowserState& state);
    // Once a frame.
    void follow(BrowserState& state);
    // From the list or from elsewhere.
    void open_scene(const std::filesystem::path& scene, BrowserState& state);
    // Files that were dropped: a scene is opened, raw data are baked by `tact` into its cache and opened then.
    void drop(const std::vector<std::string>& files, BrowserState& state);

private:
    void follow_import(BrowserState& state);
    void follow_steps(BrowserState& state) const;
    void follow_marks(BrowserState& state);
    void show_marks(BrowserState& state) const;
    void start_import(Dropped meant, BrowserState& state);
    struct Read {
        std::vector<SceneRow> recent;
        std::string recent_trouble;
        FolderRows folder;
    };
    void read(const BrowserState& state);

    std::filesystem::path scene_switch_;
    std::string current_;
    bool was_open_ = false, asked_ = false;
    std::vector<std::string> marked_;  // of any folder, at most one more than can be imported at once
    ChildJob import_;
    std::string importing_;  // the file
    Instant import_begun_{};
    bool cancelled_ = false;
    std::future<Read> reading_;
    std::future<std::string> keeping_;  // trouble, or nothing
};

}  // namespace tact
