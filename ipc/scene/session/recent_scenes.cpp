#include "ipc/scene/session/recent_scenes.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"

namespace tact {
namespace {

constexpr std::size_t kRecentPathMost = 4096;
constexpr const char* kRecentsFix =
    "fix or remove it; with the next scene it is renamed and a new one written";
constexpr std::int64_t kLatestUnixS = 253402300799;  // the year 9999

}  // namespace

std::vector<RecentScene> read_recents_text(std::string_view text, const std::string& name) {
    const auto fail = [&](const std::string& why) {
        throw StartupError("reading the recent scenes, " + name, why, kRecentsFix);
    };
    if (text.size() > kRecentsBytesMost) fail("the file is too large");
    const nlohmann::json all = nlohmann::json::parse(text, nullptr, false);
    if (all.is_discarded()) fail("it is not JSON");
    if (!all.is_object() || !all.contains("scenes") || !all["scenes"].is_array())
        fail("it has no list 'scenes'");
    std::vector<RecentScene> scenes;
    for (const auto& each : all["scenes"]) {
        if (scenes.size() == kRecentsMost) break;
        if (!each.is_object() || !each.contains("path") || !each["path"].is_string() ||
            !each.contains("used_unix_s") || !each["used_unix_s"].is_number_integer())
            fail("a scene in it has no path or no time");
        RecentScene scene{each["path"].get<std::string>(), each["used_unix_s"].get<std::int64_t>()};
        if (scene.path.empty() || scene.path.front() != '/' || scene.path.size() > kRecentPathMost ||
            std::any_of(scene.path.begin(), scene.path.end(),
                        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }))
            fail("a path in it is not absolute, too long, or holds a control character");
        if (scene.used_unix_s < 0 || scene.used_unix_s > kLatestUnixS) fail("a time in it is out of range");
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

std::string recents_text(const std::vector<RecentScene>& scenes) {
    nlohmann::json list = nlohmann::json::array();
    for (const RecentScene& s : scenes) list.push_back({{"path", s.path}, {"used_unix_s", s.used_unix_s}});
    try {
        return nlohmann::json{{"scenes", std::move(list)}}.dump(1) + "\n";
    } catch (const nlohmann::json::exception&) {
        throw StartupError("writing the recent scenes", "a path is not UTF-8",
                           "give the file a name in UTF-8");
    }
}

std::filesystem::path recents_file() {
    const std::filesystem::path folder = state_folder();
    return folder.empty() ? folder : folder / "recent.json";
}

std::vector<RecentScene> read_recents(const std::filesystem::path& file) {
    const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0 && errno == ENOENT) return {};
    struct stat info {};
    std::string text;
    ssize_t got = -1;
    if (fd >= 0 && ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode)) {
        text.resize(kRecentsBytesMost + 1);
        got = ::pread(fd, text.data(), text.size(), 0);
    }
    const std::string why = fd >= 0 && !S_ISREG(info.st_mode) ? "it is not a regular file" : last_error();
    if (fd >= 0) ::close(fd);
    if (got < 0) throw StartupError("reading the recent scenes, " + file.string(), why, kRecentsFix);
    text.resize(static_cast<std::size_t>(got));
    return read_recents_text(text, file.string());
}

std::filesystem::path set_aside(const std::filesystem::path& file) {
    std::filesystem::path aside = file.string() + ".damaged";
    std::error_code failed;
    std::filesystem::rename(file, aside, failed);
    if (failed)
        throw StartupError("renaming " + file.string() + " to " + aside.string(), failed.message(),
                           "move the file away, or fix the permissions of its folder");
    return aside;
}

std::vector<RecentScene> with_recent(std::vector<RecentScene> scenes, RecentScene used) {
    std::erase_if(scenes, [&](const RecentScene& s) { return s.path == used.path; });
    scenes.insert(scenes.begin(), std::move(used));
    if (scenes.size() > kRecentsMost) scenes.resize(kRecentsMost);
    return scenes;
}

}  // namespace tact
