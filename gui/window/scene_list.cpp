#include "gui/window/scene_list.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <fstream>

#include "gui/window/dropped_files.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "ipc/scene/file/scene_peek.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact {
namespace {

constexpr std::size_t kLookedAtMost = 20'000;  // entries of a folder
constexpr std::size_t kImagesLeast = 2;        // of a stack
constexpr std::size_t kOpenedMost = 16;        // of them, to check for DICOM

// Only the reason: attempt and fix are for a terminal.
std::string reason_of(const std::string& error, const std::string& path) {
    std::string words = error.substr(0, error.find('\n'));
    if (const auto at = words.find(path); at != std::string::npos) words.erase(0, at + path.size());
    while (!words.empty() && (words.front() == ':' || words.front() == ' ')) words.erase(0, 1);
    return words;
}

// Files of an examination often have no ending.
bool is_dicom(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<char, 132> head{};
    return in.read(head.data(), head.size()) && std::string_view(&head[128], 4) == "DICM";
}

SceneRow raw_row_of(const std::filesystem::path& path, const char* kind, std::int64_t now_unix_s) {
    SceneRow row;
    row.path = path.string();
    row.name = path.filename().string();
    row.place = path.parent_path().string();
    row.kind = kind;
    row.raw = true;
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) {
        row.trouble = last_error();
    } else {
        row.size = size_text(static_cast<std::uint64_t>(info.st_size));
        row.when = ago_text(info.st_mtime, now_unix_s);
    }
    return row;
}

}  // namespace

std::string size_text(std::uint64_t bytes) {
    const auto n = static_cast<double>(bytes);
    char text[32];
    if (bytes < 1000)
        std::snprintf(text, sizeof text, "%llu B", static_cast<unsigned long long>(bytes));
    else if (n < 999.5e3)
        std::snprintf(text, sizeof text, "%.0f kB", 1e-3 * n);
    else if (n < 999.5e6)
        std::snprintf(text, sizeof text, "%.3g MB", 1e-6 * n);
    else
        std::snprintf(text, sizeof text, "%.3g GB", 1e-9 * n);
    return text;
}

std::string ago_text(std::int64_t then, std::int64_t now) {
    const std::int64_t s = now - then;
    if (s > -60 && s < 60) return "just now";
    if (s > 0 && s < 3600) return std::to_string(s / 60) + " min ago";
    if (s > 0 && s < std::int64_t{24} * 3600) return std::to_string(s / 3600) + " h ago";
    const std::time_t t = then;
    std::tm local{};
    localtime_r(&t, &local);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%d", &local)};
}

SceneRow scene_row_of(const std::filesystem::path& path, std::int64_t used_unix_s, std::int64_t now_unix_s) {
    SceneRow row;
    row.path = path.string();
    row.name = path.filename().string();
    row.place = path.parent_path().string();
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) {
        row.trouble = errno == ENOENT || errno == ENOTDIR ? "missing: " + row.path : last_error();
        if (used_unix_s != 0) row.when = ago_text(used_unix_s, now_unix_s);
        return row;
    }
    row.size = size_text(static_cast<std::uint64_t>(info.st_size));
    row.when = ago_text(used_unix_s != 0 ? used_unix_s : info.st_mtime, now_unix_s);
    try {
        if (is_session(path)) {
            static_cast<void>(read_session(path));
            row.kind = "session";
            return row;
        }
        const SceneMeta meta = peek_scene(path);
        row.kind = scene_kind_text(meta.kind);
        row.title = meta.title;
    } catch (const StartupError& e) {
        row.trouble = reason_of(e.what(), row.path);
    }
    return row;
}

std::vector<SceneRow> recent_rows(const std::vector<RecentScene>& scenes, std::int64_t now_unix_s) {
    std::vector<SceneRow> rows;
    rows.reserve(scenes.size());
    for (const RecentScene& s : scenes) {
        SceneRow row = scene_row_of(s.path, s.used_unix_s, now_unix_s);
        // The cache names files by numbers.
        if (!row.title.empty()) {
            row.name = row.title;
            row.place = row.path;
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<SceneRow> drilled_rows(const std::filesystem::path& folder, std::uint64_t scene_checksum,
                                   std::int64_t now_unix_s) {
    std::vector<std::pair<std::int64_t, SceneRow>> found;
    std::error_code failed;
    for (std::filesystem::directory_iterator it(folder, failed), end; !failed && it != end;
         it.increment(failed)) {
        const std::filesystem::path& path = it->path();
        struct stat info {};
        if (path.extension() != ".bone" || found.size() >= kFolderRowsMost ||
            ::stat(path.c_str(), &info) != 0 || drilled_bone_scene(path) != scene_checksum)
            continue;
        SceneRow row;
        row.path = path.string();
        row.name = path.filename().string();
        row.place = folder.string();
        row.kind = "bone";
        row.size = size_text(static_cast<std::uint64_t>(info.st_size));
        row.when = ago_text(info.st_mtime, now_unix_s);
        found.emplace_back(info.st_mtime, std::move(row));
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second.name > b.second.name;
    });
    std::vector<SceneRow> rows;
    rows.reserve(found.size());
    for (auto& [time, row] : found) rows.push_back(std::move(row));
    return rows;
}

FolderRows folder_rows(const std::filesystem::path& folder, std::int64_t now_unix_s) {
    FolderRows out;
    std::vector<std::filesystem::path> folders, scenes, raw;
    std::error_code failed;
    std::size_t looked_at = 0, opened = 0;
    std::size_t images = 0;
    bool dicom = false;
    for (std::filesystem::directory_iterator it(folder, failed), end; !failed && it != end;
         it.increment(failed)) {
        if (++looked_at > kLookedAtMost) break;
        const std::filesystem::path& path = it->path();
        const std::string name = path.filename().string();
        if (name.starts_with('.')) continue;
        std::error_code ignored;
        if (it->is_directory(ignored)) {
            folders.push_back(path);
        } else if (path.extension() == ".tact" || is_session(path)) {
            scenes.push_back(path);
        } else if (it->is_regular_file(ignored)) {
            if (raw_file_text(name)[0] != '\0')
                raw.push_back(path);
            else if (path.extension() == ".png")
                ++images;
            else if (!dicom && opened++ < kOpenedMost)
                dicom = is_dicom(path);
        }
    }
    if (failed) out.trouble = "This folder cannot be read: " + failed.message();
    for (auto* const list : {&folders, &scenes, &raw}) std::sort(list->begin(), list->end());
    const auto add_folder = [&](const std::filesystem::path& path, const std::string& name) {
        SceneRow row;
        row.path = path.string();
        row.name = name;
        row.folder = true;
        out.rows.push_back(std::move(row));
    };
    if (folder.has_parent_path() && folder.parent_path() != folder) add_folder(folder.parent_path(), "..");
    if (dicom || images >= kImagesLeast) {
        SceneRow row = raw_row_of(folder, raw_folder_text(), now_unix_s);
        row.name =
            dicom ? "This folder (DICOM files)" : "This folder (" + std::to_string(images) + " images)";
        row.size.clear();
        out.rows.push_back(std::move(row));
    }
    // Scenes take precedence; raw data leave half of the rest to folders if these need it.
    const std::size_t scenes_shown = std::min(scenes.size(), kFolderRowsMost),
                      rest = kFolderRowsMost - scenes_shown;
    const std::size_t raw_shown =
        std::min(raw.size(), std::max(rest / 2, rest - std::min(rest, folders.size())));
    const std::size_t folders_shown = std::min(folders.size(), rest - raw_shown);
    for (std::size_t i = 0; i < folders_shown; ++i) add_folder(folders[i], folders[i].filename().string());
    for (std::size_t i = 0; i < scenes_shown; ++i) {
        out.rows.push_back(scene_row_of(scenes[i], 0, now_unix_s));
        if (SceneRow& row = out.rows.back(); !row.title.empty()) row.place = row.title;
    }
    for (std::size_t i = 0; i < raw_shown; ++i)
        out.rows.push_back(raw_row_of(raw[i], raw_file_text(raw[i].filename().string()), now_unix_s));
    if (out.trouble.empty() &&
        (folders.size() + scenes.size() + raw.size() > kFolderRowsMost || looked_at > kLookedAtMost))
        out.trouble = "Only part of this folder is shown: too many entries.";
    return out;
}

}  // namespace tact
