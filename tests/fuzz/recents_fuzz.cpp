// A list of recent scenes with arbitrary bytes: refused with a message, or absolute paths that survive write and read.
#include <cstring>

#include "ipc/base/error.hpp"
#include "ipc/scene/session/recent_scenes.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    std::vector<RecentScene> scenes;
    try {
        scenes = read_recents_text(text, "file");
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
        return false;
    }
    require(scenes.size() <= kRecentsMost);
    for (const RecentScene& s : scenes) {
        require(s.path.front() == '/' && s.used_unix_s >= 0);
        for (const char c : s.path) require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
    }
    require(read_recents_text(recents_text(scenes), "written") == scenes);
    // With one more scene it is still a list, with that scene first.
    const auto more = with_recent(scenes, {"/new.tact", 1});
    require(more.size() <= kRecentsMost && more.front().path == "/new.tact");
    require(read_recents_text(recents_text(more), "written") == more);
    return true;
}

std::vector<Input> seeds() {
    std::vector<RecentScene> many;
    for (int i = 0; i < 30; ++i) many.push_back({"/data/m\u00fcnchen " + std::to_string(i) + ".tact", i});
    std::vector<Input> all;
    for (const std::string& text :
         {recents_text({}), recents_text({{"/a b.tact", 1793000000}, {"/\"\\", 0}}), recents_text(many),
          std::string(
              R"({"of":[1e3,null,true],"scenes":[{"path":"\/\u00e9\ud83d\ude00","used_unix_s":7,"x":{}}]})")})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
