#include "gui/window/browser_controller.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/base/whole_file.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_kinds.hpp"
#include "ipc/scene/file/scene_switch.hpp"

namespace tact {
namespace {

std::int64_t unix_now_s() { return static_cast<std::int64_t>(std::time(nullptr)); }

template <class T>
bool ready(std::future<T>& one) {
    return one.valid() && one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::filesystem::path folder_of(const std::filesystem::path& scene, const std::string& note) {
    const auto record = read_bake_record(note);
    const bool cached = scene.parent_path() == user_folder("XDG_CACHE_HOME", ".cache");
    return cached && record ? record->inputs.front().path.parent_path() : scene.parent_path();
}

}  // namespace

void BrowserController::used(const std::filesystem::path& scene, SceneKind kind, const std::string& note,
                             BrowserState& state) {
    const auto path = std::filesystem::absolute(scene).lexically_normal();
    current_ = path.string();
    current_kind_ = kind;
    if (state.folder.empty()) state.folder = folder_of(path, note).string();
    remember(path);
}

void BrowserController::remember(const std::filesystem::path& path) {
    const auto folder = state_folder();
    if (scene_switch_.empty() || folder.empty() || keeping_.valid()) return;
    keeping_ = std::async(std::launch::async, [path]() -> std::string {
        const auto file = recents_file();
        try {
            std::vector<RecentScene> scenes;
            try {
                scenes = read_recents(file);
            } catch (const StartupError& e) {
                spdlog::warn("{}", e.what());
                spdlog::warn("starting a new list of scenes; the old file is kept as {}",
                             set_aside(file).string());
            }
            write_whole_file(file, recents_text(with_recent(scenes, {path.string(), unix_now_s()})));
        } catch (const StartupError& e) {
            return e.what();
        }
        return {};
    });
}

void BrowserController::read(const BrowserState& state) {
    reading_ = std::async(std::launch::async, [folder = state.folder, current = current_] {
        Read out;
        const std::int64_t now = unix_now_s();
        if (const auto used = state_folder(); used.empty()) {
            out.recent_trouble = "Recent scenes are not saved: neither XDG_STATE_HOME nor HOME is set.";
        } else {
            try {
                out.recent = recent_rows(read_recents(recents_file()), now);
            } catch (const StartupError& e) {
                out.recent_trouble = e.what();
            }
            try {
                if (!current.empty())
                    out.drilled = drilled_rows(used / "drilled", SceneFile::open(current).checksum(), now);
            } catch (const StartupError&) {  // the scene is gone: nothing belongs to it
            }
        }
        if (!folder.empty()) out.folder = folder_rows(folder, now);
        return out;
    });
}

void BrowserController::open_scene(const std::filesystem::path& scene, BrowserState& state) {
    state.open = true;
    if (scene_switch_.empty())
        return state.say(Grade::watch,
                         "This window has no launcher and cannot switch scenes.\n"
                         "Close it and run: tact run " +
                             scene.string());
    try {
        ask_for_scene(scene_switch_, scene);
        asked_ = true;
        spdlog::info("requesting from the launcher: {}", scene.string());
        state.say(Grade::unknown, "Opening " + scene.string() + " ...");
    } catch (const StartupError& e) {
        state.say(Grade::bad, e.what());
    }
}

void BrowserController::drop(const std::vector<std::string>& files, BrowserState& state) {
    state.open = true;
    if (import_.running() || examine_.running())
        return state.say(Grade::watch, "An import is in progress: cancel it, or drop again when it ends.");
    Dropped meant = meaning_of(files, {current_, current_kind_});
    if (!meant.add.empty()) {
        state.form.reset();
        state.message.clear();
        marked_ = files;
        return show_marks(state);
    }
    if (!meant.scene.empty()) return open_scene(meant.scene, state);
    if (meant.import.empty()) return state.say(Grade::watch, meant.trouble + "\n" + dropped_kinds_text());
    import(std::move(meant), state);
}

void BrowserController::show_marks(BrowserState& state) const {
    for (SceneRow& row : state.here)
        row.marked = std::find(marked_.begin(), marked_.end(), row.path) != marked_.end();
    if (marked_.empty()) {
        state.marks_text.clear();
        return;
    }
    const Dropped meant = meaning_of(marked_, {current_, current_kind_});
    state.marks_import = !meant.import.empty();
    state.marks_add = !meant.add.empty();
    state.marks_text = meaning_text(meant);
    if (!state.marks_import && !state.marks_add)
        state.marks_text.insert(0, std::to_string(marked_.size()) + " marked. ");
}

void BrowserController::follow_marks(BrowserState& state) {
    if (!state.mark_wanted.empty()) {
        const std::string path = std::exchange(state.mark_wanted, {});
        if (std::erase(marked_, path) == 0 && marked_.size() <= kDroppedMost) marked_.push_back(path);
        show_marks(state);
    }
    if (std::exchange(state.clear_wanted, false)) {
        marked_.clear();
        show_marks(state);
    }
    if (std::exchange(state.import_wanted, false) && !import_.running() && !examine_.running()) {
        Dropped meant = meaning_of(marked_, {current_, current_kind_});
        if (meant.import.empty() && meant.add.empty()) return show_marks(state);
        if (!meant.add.empty())
            start_adding(meant, state);
        else
            import(std::move(meant), state);
        if (!import_.running() && !examine_.running()) return;
        marked_.clear();
        show_marks(state);
    }
}

void BrowserController::follow(BrowserState& state) {
    follow_import(state);
    follow_marks(state);
    follow_examination(state);
    follow_form(state);
    for (std::future<std::string>* const kept : {&keeping_, &answering_})
        if (ready(*kept))
            if (const std::string trouble = kept->get(); !trouble.empty()) {
                spdlog::warn("{}", trouble);
                state.say(Grade::watch, trouble);
            }
    if (!scene_switch_.empty()) {
        if (const auto refusal = take_refusal(scene_switch_)) {
            asked_ = false;
            state.open = true;
            spdlog::warn("scene switch refused: {}", *refusal);
            state.say(Grade::bad, *refusal);
        }
    }
    if (state.open && !was_open_) {
        if (state.folder.empty()) {
            std::error_code ignored;
            state.folder = std::filesystem::current_path(ignored).string();
        }
        refresh(state);
    }
    if (!state.open && was_open_ && !asked_) state.message.clear();
    was_open_ = state.open;
    if (!state.folder_wanted.empty() && !reading_.valid()) {
        state.folder = std::exchange(state.folder_wanted, {});
        read(state);
    }
    if (ready(reading_)) {
        Read got = reading_.get();
        state.recent = std::move(got.recent);
        state.drilled = std::move(got.drilled);
        state.recent_trouble = std::move(got.recent_trouble);
        state.here = std::move(got.folder.rows);
        state.folder_trouble = std::move(got.folder.trouble);
        for (auto* const list : {&state.recent, &state.here})
            for (SceneRow& row : *list) row.current = row.path == current_;
        show_marks(state);
    }
    state.reading = reading_.valid();
    if (!state.scene_wanted.empty()) open_scene(std::exchange(state.scene_wanted, {}), state);
}

}  // namespace tact
