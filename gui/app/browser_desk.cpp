#include "gui/app/browser_desk.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "gui/desk/import_said.hpp"
#include "ipc/assets/scene_hand_over.hpp"
#include "ipc/base/error.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
namespace {

constexpr const char* kRecentName = "recent.json";

std::int64_t unix_now_s() { return static_cast<std::int64_t>(std::time(nullptr)); }

template <class T>
bool ready(std::future<T>& one) {
    return one.valid() && one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void say(BrowserFacts& facts, Grade grade, std::string words) {
    facts.said = std::move(words);
    facts.said_grade = grade;
}

}  // namespace

void BrowserDesk::used(const std::filesystem::path& scene, BrowserFacts& facts) {
    const auto path = std::filesystem::absolute(scene).lexically_normal();
    current_ = path.string();
    if (facts.folder.empty()) facts.folder = path.parent_path().string();
    const auto folder = state_folder();
    if (hand_over_.empty() || folder.empty() || keeping_.valid()) return;
    keeping_ = std::async(std::launch::async, [folder, path]() -> std::string {
        const auto file = folder / kRecentName;
        try {
            std::vector<RecentScene> scenes;
            try {
                scenes = read_recents(file);
            } catch (const StartupError& e) {
                spdlog::warn("{}", e.what());
                spdlog::warn("the list of scenes begins anew; the old file is kept as {}",
                             set_aside(file).string());
            }
            write_whole_file(file, recents_text(with_recent(scenes, {path.string(), unix_now_s()})));
        } catch (const StartupError& e) {
            return e.what();
        }
        return {};
    });
}

void BrowserDesk::read(const BrowserFacts& facts) {
    reading_ = std::async(std::launch::async, [folder = facts.folder] {
        Read out;
        const std::int64_t now = unix_now_s();
        if (const auto state = state_folder(); state.empty()) {
            out.recent_trouble =
                "Scenes that were used are not kept: neither XDG_STATE_HOME nor HOME is set.";
        } else {
            try {
                out.recent = recent_rows(read_recents(state / kRecentName), now);
            } catch (const StartupError& e) {
                out.recent_trouble = e.what();
            }
        }
        if (!folder.empty()) out.folder = folder_rows(folder, now);
        return out;
    });
}

void BrowserDesk::open_scene(const std::filesystem::path& scene, BrowserFacts& facts) {
    facts.open = true;
    if (hand_over_.empty())
        return say(facts, Grade::watch,
                   "This window was started alone and cannot end the controller for another scene.\n"
                   "Close it and start: tact run " +
                       scene.string());
    try {
        ask_for_scene(hand_over_, scene);
        asked_ = true;
        spdlog::info("asking the launcher for {}", scene.string());
        say(facts, Grade::unknown, "Opening " + scene.string() + " ...");
    } catch (const StartupError& e) {
        say(facts, Grade::bad, e.what());
    }
}

void BrowserDesk::drop(const std::vector<std::string>& files, BrowserFacts& facts) {
    facts.open = true;
    if (import_.running())
        return say(facts, Grade::watch, "An import is under way: cancel it, or drop again when it is done.");
    Dropped meant = meaning_of(files);
    if (!meant.scene.empty()) return open_scene(meant.scene, facts);
    if (meant.import.empty()) return say(facts, Grade::watch, meant.trouble + "\n" + kDroppedKinds);
    start_import(std::move(meant), facts);
}

void BrowserDesk::start_import(Dropped meant, BrowserFacts& facts) {
    importing_ = meant.import[1];
    meant.import.emplace_back("--bake-only");
    try {
        import_.start("tact", meant.import);
        import_begun_ = Monotonic::now();
        cancelled_ = false;
        spdlog::info("importing {}", importing_);
    } catch (const StartupError& e) {
        say(facts, Grade::bad, e.what());
    }
}

void BrowserDesk::show_marks(BrowserFacts& facts) const {
    for (SceneRow& row : facts.here)
        row.marked = std::find(marked_.begin(), marked_.end(), row.path) != marked_.end();
    if (marked_.empty()) {
        facts.marks_say.clear();
        return;
    }
    const Dropped meant = meaning_of(marked_);
    facts.marks_import = !meant.import.empty();
    facts.marks_say = meaning_text(meant);
    if (!facts.marks_import) facts.marks_say.insert(0, std::to_string(marked_.size()) + " marked. ");
}

void BrowserDesk::follow_marks(BrowserFacts& facts) {
    if (!facts.mark_wanted.empty()) {
        const std::string path = std::exchange(facts.mark_wanted, {});
        if (std::erase(marked_, path) == 0 && marked_.size() <= kDroppedMost) marked_.push_back(path);
        show_marks(facts);
    }
    if (std::exchange(facts.clear_wanted, false)) {
        marked_.clear();
        show_marks(facts);
    }
    if (std::exchange(facts.import_wanted, false) && !import_.running()) {
        Dropped meant = meaning_of(marked_);
        if (meant.import.empty()) return show_marks(facts);
        start_import(std::move(meant), facts);
        if (!import_.running()) return;
        marked_.clear();
        show_marks(facts);
    }
}

// tact-prep prints a line a step, most with the share of the whole that is done.
void BrowserDesk::follow_steps(BrowserFacts& facts) const {
    const std::string said = import_.said();
    facts.import_share = share_done(said);
    say(facts, Grade::unknown,
        "Importing " + importing_ + ", " +
            std::to_string(static_cast<long>(to_s(Monotonic::now() - import_begun_))) + " s" +
            (said.empty() ? ": reading it" : ": " + last_line(said)));
}

// At the end tact prints the path of the scene.
void BrowserDesk::follow_import(BrowserFacts& facts) {
    if (std::exchange(facts.cancel_wanted, false) && import_.running()) {
        cancelled_ = true;
        import_.cancel();
    }
    const auto outcome = import_.poll();
    facts.importing = import_.running();
    if (!outcome) {
        if (facts.importing) follow_steps(facts);
        return;
    }
    const std::string last = last_line(outcome->output);
    if (cancelled_ && outcome->good())
        say(facts, Grade::unknown, "The import was done before it could be cancelled: " + last);
    else if (cancelled_)
        say(facts, Grade::unknown, "The import was cancelled; nothing was written.");
    else if (!outcome->good())
        say(facts, Grade::bad, errors_said(outcome->output));
    else if (last.starts_with('/') && last.ends_with(".tact"))
        open_scene(last, facts);
    else
        say(facts, Grade::bad, "The import ended without naming a scene: " + last);
}

void BrowserDesk::follow(BrowserFacts& facts) {
    follow_import(facts);
    follow_marks(facts);
    if (ready(keeping_))
        if (const std::string trouble = keeping_.get(); !trouble.empty()) {
            spdlog::warn("{}", trouble);
            say(facts, Grade::watch, trouble);
        }
    if (!hand_over_.empty()) {
        if (const auto refusal = take_refusal(hand_over_)) {
            asked_ = false;
            facts.open = true;
            spdlog::warn("another scene was refused: {}", *refusal);
            say(facts, Grade::bad, *refusal);
        }
    }
    if (facts.open && !was_open_) {
        if (facts.folder.empty()) {
            std::error_code ignored;
            facts.folder = std::filesystem::current_path(ignored).string();
        }
        if (!reading_.valid()) read(facts);
    }
    if (!facts.open && was_open_ && !asked_) facts.said.clear();
    was_open_ = facts.open;
    if (!facts.folder_wanted.empty() && !reading_.valid()) {
        facts.folder = std::exchange(facts.folder_wanted, {});
        read(facts);
    }
    if (ready(reading_)) {
        Read got = reading_.get();
        facts.recent = std::move(got.recent);
        facts.recent_trouble = std::move(got.recent_trouble);
        facts.here = std::move(got.folder.rows);
        facts.folder_trouble = std::move(got.folder.trouble);
        for (auto* const list : {&facts.recent, &facts.here})
            for (SceneRow& row : *list) row.current = row.path == current_;
        show_marks(facts);
    }
    facts.reading = reading_.valid();
    if (!facts.scene_wanted.empty()) open_scene(std::exchange(facts.scene_wanted, {}), facts);
}

}  // namespace tact
