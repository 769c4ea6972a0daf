#include "gui/app/browser_desk.hpp"

#include <spdlog/spdlog.h>

#include <ctime>
#include <utility>

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
        std::vector<RecentScene> scenes;
        try {
            scenes = read_recents(file);
        } catch (const StartupError& e) {
            spdlog::warn("{}", e.what());  // and written anew
        }
        try {
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

void BrowserDesk::follow(BrowserFacts& facts) {
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
    }
    facts.reading = reading_.valid();
    if (!facts.scene_wanted.empty()) open_scene(std::exchange(facts.scene_wanted, {}), facts);
}

}  // namespace tact
