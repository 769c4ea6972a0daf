// Imports of the scene list: examination, dialog, and `tact` that bakes.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "gui/window/browser_controller.hpp"
#include "gui/window/import_progress.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/base/whole_file.hpp"
#include "ipc/scene/file/scene_kinds.hpp"

namespace tact {
namespace {

constexpr const char* kAnswersName = "import_answers.json";

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

}  // namespace

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
        state.say(Grade::watch, std::exchange(recall_->trouble, {}));
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
        state.say(Grade::bad, e.what());
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
    if (!outcome) return state.say(Grade::unknown, "Reading " + importing_ + " ...");
    state.importing = false;
    state.message.clear();
    if (cancelled_) {
        state.form.reset();
        return;
    }
    if (!outcome->good()) return state.say(Grade::bad, error_text(outcome->output));
    asked_in_log_ = false;
    state.form = read_import_form(last_line(outcome->output));
    if (!state.form)
        return state.say(Grade::bad, "tact-prep examine gave no report: " + last_line(outcome->output));
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
            return state.say(Grade::bad, e.what());
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
        return state.say(
            Grade::watch,
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
        state.say(Grade::bad, e.what());
    }
}

// tact-prep prints one line per step, most with the completed fraction of the whole.
void BrowserController::follow_steps(BrowserState& state) const {
    const std::string output = import_.output();
    state.import_share = share_done(output);
    state.say(Grade::unknown, "Importing " + importing_ + ", " +
                                  std::to_string(static_cast<long>(to_s(Monotonic::now() - import_begun_))) +
                                  " s" + (output.empty() ? ": reading" : ": " + last_line(output)));
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
        state.say(Grade::unknown, "The import finished before it could be cancelled: " + last);
    else if (cancelled_)
        state.say(Grade::unknown, "The import was cancelled; nothing was written.");
    else if (!outcome->good())
        state.say(Grade::bad, error_text(outcome->output));
    else if (last.starts_with('/') && last.ends_with(".tact") && adding_)
        state.added_scene = last;
    else if (last.starts_with('/') && last.ends_with(".tact"))
        open_scene(last, state);
    else
        state.say(Grade::bad, "The import ended without naming a scene: " + last);
}

}  // namespace tact
