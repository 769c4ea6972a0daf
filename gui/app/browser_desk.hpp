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

#include "gui/app/child_job.hpp"
#include "gui/desk/dropped_files.hpp"
#include "gui/desk/scene_list.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

class BrowserDesk {
public:
    // hand_over: the launcher's folder; empty: there is none.
    explicit BrowserDesk(std::filesystem::path hand_over) : hand_over_(std::move(hand_over)) {}
    // A scene is shown: it goes into the list, where a launcher runs it.
    void used(const std::filesystem::path& scene, BrowserFacts& facts);
    // Once a frame.
    void follow(BrowserFacts& facts);
    // From the list or from elsewhere.
    void open_scene(const std::filesystem::path& scene, BrowserFacts& facts);
    // Files that were dropped: a scene is opened, raw data are baked by `tact` into its cache and opened then.
    void drop(const std::vector<std::string>& files, BrowserFacts& facts);

private:
    void follow_import(BrowserFacts& facts);
    void follow_steps(BrowserFacts& facts) const;
    void follow_marks(BrowserFacts& facts);
    void show_marks(BrowserFacts& facts) const;
    void start_import(Dropped meant, BrowserFacts& facts);
    struct Read {
        std::vector<SceneRow> recent;
        std::string recent_trouble;
        FolderRows folder;
    };
    void read(const BrowserFacts& facts);

    std::filesystem::path hand_over_;
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
