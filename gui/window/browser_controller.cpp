#include "gui/window/browser_controller.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "gui/window/import_progress.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/base/whole_file.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_kinds.hpp"
#include "ipc/scene/file/scene_switch.hpp"

namespace tact {
namespace {

constexpr const char *kRecentName = "recent.json", *kAnswersName = "import_answers.json";

std::int64_t unix_now_s() { return static_cast<std::int64_t>(std::time(nullptr)); }

template <class T>
bool ready(std::future<T>& one) {
    return one.valid() && one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

// A table that a person wrote may hold remarks, and names for other scans.
void keep_before(const std::filesystem::path& table) {
    std::error_code failed;
    if (!std::filesystem::exists(table, failed)) return;
    const std::filesystem::path before = table.string() + ".before";
    std::filesystem::copy_file(table, before, std::filesystem::copy_options::overwrite_existing, failed);
    if (failed)
        throw StartupError("keep the old " + table.string(), failed.message(),
                           "make its folder writable, or move the file away");
}

std::filesystem::path folder_of(const std::filesystem::path& scene, const std::string& note) {
    const auto record = read_bake_record(note);
    const bool cached = scene.parent_path() == user_folder("XDG_CACHE_HOME", ".cache");
    return cached && record ? record->inputs.front().path.parent_path() : scene.parent_path();
}

void say(BrowserState& state, Grade grade, std::string words) {
    state.message = std::move(words);
    state.message_grade = grade;
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
    keeping_ = std::async(std::launch::async, [folder, path]() -> std::string {
        const auto file = folder / kRecentName;
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
                out.recent = recent_rows(read_recents(used / kRecentName), now);
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
        return say(state, Grade::watch,
                   "This window has no launcher and cannot switch scenes.\n"
                   "Close it and run: tact run " +
                       scene.string());
    try {
        ask_for_scene(scene_switch_, scene);
        asked_ = true;
        spdlog::info("requesting from the launcher: {}", scene.string());
        say(state, Grade::unknown, "Opening " + scene.string() + " ...");
    } catch (const StartupError& e) {
        say(state, Grade::bad, e.what());
    }
}

void BrowserController::drop(const std::vector<std::string>& files, BrowserState& state) {
    state.open = true;
    if (import_.running() || examine_.running())
        return say(state, Grade::watch, "An import is in progress: cancel it, or drop again when it ends.");
    Dropped meant = meaning_of(files, {current_, current_kind_});
    if (!meant.add.empty()) {
        state.form.reset();
        state.message.clear();
        marked_ = files;
        return show_marks(state);
    }
    if (!meant.scene.empty()) return open_scene(meant.scene, state);
    if (meant.import.empty()) return say(state, Grade::watch, meant.trouble + "\n" + dropped_kinds_text());
    import(std::move(meant), state);
}

void BrowserController::import(Dropped meant, BrowserState& state) {
    state.form.reset();
    const auto kinds = scene_kinds();
    const bool asks = std::any_of(kinds.begin(), kinds.end(), [&](const SceneKindRow& kind) {
        return meant.import[0] == kind.command && kind.asks;
    });
    if (!asks) return start_import(std::move(meant), state);
    asking_ = std::move(meant);
    begin_recalling(asking_);
    examine({}, state);
}

void BrowserController::begin_recalling(const Dropped& meant) {
    recall_.reset();
    choices_proposed_ = false;
    recalling_ =
        std::async(std::launch::async, [command = meant.import[0], path = meant.import[1]]() -> Recall {
            Recall out;
            if (const auto folder = state_folder(); !folder.empty()) try {
                    out.answers = recall(read_answers(folder / kAnswersName), imported_file(path, command));
                } catch (const StartupError& e) {
                    out.trouble = e.what();
                }
            return out;
        });
}

void BrowserController::propose_answers(ImportForm& form, BrowserState& state) {
    if (recalling_.valid()) recall_ = recalling_.get();  // was read long before the files were
    if (!recall_) return;
    if (!recall_->trouble.empty()) {
        spdlog::warn("{}", recall_->trouble);
        say(state, Grade::watch, std::exchange(recall_->trouble, {}));
    }
    if (recall_->answers)
        form.other_choice = propose(*recall_->answers, !std::exchange(choices_proposed_, true), form);
}

void BrowserController::keep_answers(const ImportForm& form) {
    const auto folder = state_folder();
    if (folder.empty() || answering_.valid()) return;
    answering_ = std::async(
        std::launch::async,
        [folder, command = asking_.import[0], path = asking_.import[1],
         answers = answers_of(form)]() -> std::string {
            const auto file = folder / kAnswersName;
            try {
                std::vector<ImportAnswers> imports;
                try {
                    imports = read_answers(file);
                } catch (const StartupError& e) {
                    spdlog::warn("{}", e.what());
                    spdlog::warn("starting new answers of imports; the old file is kept as {}",
                                 set_aside(file).string());
                }
                write_whole_file(file, answers_text(with_answers(std::move(imports),
                                                                 {imported_file(path, command), answers})));
            } catch (const StartupError& e) {
                return e.what();
            }
            return {};
        });
}

void BrowserController::examine(const std::vector<std::string>& choices, BrowserState& state) {
    std::vector<std::string> arguments{"examine"};
    arguments.insert(arguments.end(), asking_.import.begin(), asking_.import.end());
    arguments.insert(arguments.end(), choices.begin(), choices.end());
    importing_ = asking_.import[1];
    try {
        examine_.start("tact-prep", arguments);
        import_begun_ = Monotonic::now();
        cancelled_ = false;
    } catch (const StartupError& e) {
        say(state, Grade::bad, e.what());
    }
}

void BrowserController::follow_examination(BrowserState& state) {
    if (!examine_.running()) return;
    if (!state.open || std::exchange(state.cancel_wanted, false)) {
        cancelled_ = true;
        examine_.cancel();
    }
    state.importing = true;
    state.import_share.reset();
    const auto outcome = examine_.poll();
    if (!outcome) return say(state, Grade::unknown, "Reading " + importing_ + " ...");
    state.importing = false;
    state.message.clear();
    if (cancelled_) {
        state.form.reset();
        return;
    }
    if (!outcome->good()) return say(state, Grade::bad, error_text(outcome->output));
    asked_in_log_ = false;
    state.form = read_import_form(last_line(outcome->output));
    if (!state.form)
        return say(state, Grade::bad, "tact-prep examine gave no report: " + last_line(outcome->output));
    state.form->title = meaning_text(asking_);
    propose_answers(*state.form, state);
}

void BrowserController::follow_form(BrowserState& state) {
    if (!state.form || examine_.running()) return;
    ImportForm& form = *state.form;
    if (form.takes_keys && !std::exchange(asked_in_log_, true)) spdlog::info("asking about {}", importing_);
    if (form.cancelled || !state.open) {
        state.form.reset();
        return;
    }
    if (std::exchange(form.other_choice, false)) {
        // Answers that were given with another choice say nothing about this one.
        if (form.shown && recall_) recall_->answers.reset();
        return examine(form.choice_arguments(), state);
    }
    if (!std::exchange(form.answered, false) || !form.complete() || import_.running()) return;
    if (const std::string table = form.edited_table(); !table.empty()) {
        try {
            keep_before(form.structure_table);
            write_whole_file(form.structure_table, table);
        } catch (const StartupError& e) {
            return say(state, Grade::bad, e.what());
        }
        spdlog::info("names of structures written to {}", form.structure_table);
    }
    keep_answers(form);
    const std::vector<std::string> answers = form.arguments();
    asking_.import.insert(asking_.import.end(), answers.begin(), answers.end());
    state.form.reset();
    start_import(std::move(asking_), state);
}

void BrowserController::start_import(Dropped meant, BrowserState& state) {
    importing_ = meant.import[1];
    adding_ = false;
    run_tact(std::move(meant.import), state);
}

void BrowserController::start_adding(const Dropped& meant, BrowserState& state) {
    if (scene_switch_.empty()) {
        std::string command = "tact";
        for (const std::string& word : meant.add) command += " " + word;
        return say(state, Grade::watch,
                   "This window has no launcher and cannot switch scenes.\nClose it and run: " + command);
    }
    importing_ = meant.add[2];
    adding_ = true;
    run_tact(meant.add, state);
}

void BrowserController::run_tact(std::vector<std::string> arguments, BrowserState& state) {
    arguments.emplace_back("--bake-only");
    try {
        import_.start("tact", arguments);
        import_begun_ = Monotonic::now();
        cancelled_ = false;
        spdlog::info("importing {}", importing_);
    } catch (const StartupError& e) {
        say(state, Grade::bad, e.what());
    }
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

// tact-prep prints one line per step, most with the completed fraction of the whole.
void BrowserController::follow_steps(BrowserState& state) const {
    const std::string output = import_.output();
    state.import_share = share_done(output);
    say(state, Grade::unknown,
        "Importing " + importing_ + ", " +
            std::to_string(static_cast<long>(to_s(Monotonic::now() - import_begun_))) + " s" +
            (output.empty() ? ": reading" : ": " + last_line(output)));
}

// On success tact prints the path of the scene.
void BrowserController::follow_import(BrowserState& state) {
    if (import_.running() && std::exchange(state.cancel_wanted, false)) {
        cancelled_ = true;
        import_.cancel();
    }
    const auto outcome = import_.poll();
    state.importing = import_.running();
    if (!outcome) {
        if (state.importing) follow_steps(state);
        return;
    }
    const std::string last = last_line(outcome->output);
    if (cancelled_ && outcome->good())
        say(state, Grade::unknown, "The import finished before it could be cancelled: " + last);
    else if (cancelled_)
        say(state, Grade::unknown, "The import was cancelled; nothing was written.");
    else if (!outcome->good())
        say(state, Grade::bad, error_text(outcome->output));
    else if (last.starts_with('/') && last.ends_with(".tact") && adding_)
        state.added_scene = last;
    else if (last.starts_with('/') && last.ends_with(".tact"))
        open_scene(last, state);
    else
        say(state, Grade::bad, "The import ended without naming a scene: " + last);
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
                say(state, Grade::watch, trouble);
            }
    if (!scene_switch_.empty()) {
        if (const auto refusal = take_refusal(scene_switch_)) {
            asked_ = false;
            state.open = true;
            spdlog::warn("scene switch refused: {}", *refusal);
            say(state, Grade::bad, *refusal);
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
