// The scene list, and the switch to another scene: remembers used scenes, reads a folder in the background, and
// sends requests to the launcher. Without a launcher nothing can restart the controller on another scene.
//
// Thread  frame thread; disks are accessed on another one.
#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "gui/base/child_job.hpp"
#include "gui/window/dropped_files.hpp"
#include "gui/window/import_answers.hpp"
#include "gui/window/scene_list.hpp"
#include "ipc/base/clock.hpp"

namespace tact {

class BrowserController {
public:
    // scene_switch: the launcher's folder; empty: no launcher.
    explicit BrowserController(std::filesystem::path scene_switch) : scene_switch_(std::move(scene_switch)) {}
    // A scene is shown: adds it to the list if a launcher runs the window. note: of the scene; one that `tact` baked leads to the folder of its
    // files.
    void used(const std::filesystem::path& scene, SceneKind kind, const std::string& note,
              BrowserState& state);
    // Puts a file in front of the recent ones.
    void remember(const std::filesystem::path& file);
    // Reads the list of recent scenes, and the folder, again.
    void refresh(const BrowserState& state) {
        if (!reading_.valid()) read(state);
    }
    // Call once a frame.
    void follow(BrowserState& state);
    // Requests a scene, from the list or from elsewhere.
    void open_scene(const std::filesystem::path& scene, BrowserState& state);
    // Handles dropped files: opens a scene; has raw data baked by `tact` into its cache, then opens the result. Files that can be added to
    // the scene that is shown are marked, and a person adds them: BrowserState::added_scene names the result.
    void drop(const std::vector<std::string>& files, BrowserState& state);

private:
    void follow_import(BrowserState& state);
    void follow_steps(BrowserState& state) const;
    void follow_marks(BrowserState& state);
    void show_marks(BrowserState& state) const;
    // Examines the files first where a person must answer something.
    void import(Dropped meant, BrowserState& state);
    void examine(const std::vector<std::string>& choices, BrowserState& state);
    void follow_examination(BrowserState& state);
    void follow_form(BrowserState& state);
    void begin_recalling(const Dropped& meant);
    void propose_answers(ImportForm& form, BrowserState& state);
    void keep_answers(const ImportForm& form);
    void start_import(Dropped meant, BrowserState& state);
    void start_adding(const Dropped& meant, BrowserState& state);
    void run_tact(std::vector<std::string> arguments, BrowserState& state);
    struct Read {
        std::vector<SceneRow> recent, drilled;
        std::string recent_trouble;
        FolderRows folder;
    };
    void read(const BrowserState& state);

    std::filesystem::path scene_switch_;
    std::string current_;
    SceneKind current_kind_{};
    bool adding_ = false;  // the import adds to the scene that is shown
    bool was_open_ = false, asked_ = false;
    std::vector<std::string> marked_;  // from any folder, at most one more than an import allows
    Dropped asking_;                   // is examined, or waits for the answers of BrowserState::form
    ChildJob import_, examine_;
    std::string importing_;  // first file of the import
    Instant import_begun_{};
    bool cancelled_ = false;
    bool asked_in_log_ = false;
    std::future<Read> reading_;
    std::future<std::string> keeping_;  // error, or empty
    // Answers of earlier imports, proposed in the dialog.
    struct Recall {
        std::optional<Recalled> answers;
        std::string trouble;
    };
    std::future<Recall> recalling_;
    std::optional<Recall> recall_;  // for asking_
    bool choices_proposed_ = false;
    std::future<std::string> answering_;  // keeps them: error, or empty
};

}  // namespace tact
