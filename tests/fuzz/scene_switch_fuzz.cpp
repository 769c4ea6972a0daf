// The scene-switch files between window and launcher with arbitrary bytes: requests and refusals survive write and read.
// Reading a file removes it, whatever its content.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_switch.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

bool control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

// In memory, because the files are synced.
struct Folder {
    std::filesystem::path path;
    Folder() {
        char name[] = "/dev/shm/tact-fuzz-XXXXXX";
        require(mkdtemp(name) != nullptr);
        path = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { std::filesystem::remove_all(path); }
    void put(const char* name, std::string_view text) const {
        std::ofstream(path / name, std::ios::binary) << text;
    }
};

void judge_refusal(const Folder& folder, std::string_view text) {
    folder.put("refused", text);
    const auto refusal = take_refusal(folder.path);
    require(refusal.has_value() && !take_refusal(folder.path));
    require(refusal->size() == (text.size() <= kRefusalMost ? text.size() : 0));
    require(std::none_of(refusal->begin(), refusal->end(), [](char c) { return control(c) && c != '\n'; }));
    refuse_scene(folder.path, *refusal);
    require(take_refusal(folder.path) == refusal);
}

void judge_demo(const Folder& folder, std::string_view text) {
    folder.put("demo", text);
    std::optional<std::string> demo;
    try {
        demo = take_asked_demo(folder.path);
        require(demo.has_value() && !demo->empty() && demo->size() <= kDemoNameMost);
        require(std::all_of(demo->begin(), demo->end(), [](char c) { return c >= 'a' && c <= 'z'; }));
        require(text == *demo + "\n");
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
    }
    require(!take_asked_demo(folder.path));
}

void judge_past(const Folder& folder, std::string_view text) {
    folder.put("past", text);
    try {
        const auto ago_s = take_asked_past(folder.path);
        require(ago_s.has_value() && *ago_s >= 0.0 && *ago_s <= kPastMostS);
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
    }
    require(!take_asked_past(folder.path));
}

}  // namespace

bool run(std::span<const std::byte> input) {
    static const Folder folder;
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    judge_refusal(folder, text);
    judge_demo(folder, text);
    judge_past(folder, text);
    folder.put("open", text);
    std::optional<std::filesystem::path> asked;
    try {
        asked = take_asked_scene(folder.path);
        require(asked.has_value());
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
    }
    require(!take_asked_scene(folder.path));
    if (!asked) return false;
    const std::string& path = asked->native();
    require(path.size() < kAskedPathMost && path.front() == '/' && text == path + "\n");
    require(std::none_of(path.begin(), path.end(), control));
    ask_for_scene(folder.path, *asked);
    require(take_asked_scene(folder.path) == asked->lexically_normal());
    return true;
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    for (const std::string& text :
         {std::string("/data/a b.tact\n"), std::string("/a/../\u00fc/./b//c.tact\n"),
          "/" + std::string(kAskedPathMost - 2, 'x') + "\n"})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
