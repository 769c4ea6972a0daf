#include "deploy/tact/station/journal.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;
constexpr const char* kHex = "0123456789abcdef";

// Any bytes, also invalid UTF-8.
std::string to_hex(const std::string& bytes) {
    std::string text;
    for (const char c : bytes) {
        text += kHex[static_cast<unsigned char>(c) >> 4U];
        text += kHex[static_cast<unsigned char>(c) & 15U];
    }
    return text;
}

std::string from_hex(const std::string& text) {
    std::string bytes;
    if (text.size() % 2 != 0) throw std::invalid_argument("odd number of hex digits");
    for (std::size_t i = 0; i < text.size(); i += 2) {
        const std::string pair = text.substr(i, 2);
        if (pair.find_first_not_of(kHex) != std::string::npos)
            throw std::invalid_argument("a character that is not a hex digit");
        bytes += static_cast<char>(std::stoi(pair, nullptr, 16));
    }
    return bytes;
}

json content_json(const FileContent& c) {
    if (c.kind == FileKind::absent) return nullptr;
    return {{"kind", c.kind == FileKind::file ? "file" : "link"},
            {"bytes", to_hex(c.bytes)},
            {"mode", c.mode},
            {"uid", c.uid},
            {"gid", c.gid}};
}

FileContent content_from(const json& j) {
    if (j.is_null()) return {};
    const std::string kind = j.at("kind");
    if (kind != "file" && kind != "link") throw std::invalid_argument("kind " + kind);
    const auto mode = j.at("mode").get<mode_t>();
    if (mode > 07777U) throw std::invalid_argument("invalid file mode");
    return {.kind = kind == "file" ? FileKind::file : FileKind::link,
            .bytes = from_hex(j.at("bytes")),
            .mode = mode,
            .uid = j.at("uid"),
            .gid = j.at("gid")};
}

json paths_json(const std::vector<std::filesystem::path>& paths) {
    json all = json::array();
    for (const auto& path : paths) all.push_back(path.string());
    return all;
}

// Paths must stay inside the root: no "..".
std::filesystem::path path_from(const json& j) {
    std::filesystem::path path = j.get<std::string>();
    for (const auto& part : path)
        if (part == "..") throw std::invalid_argument("path " + path.string());
    return path;
}

std::vector<std::filesystem::path> paths_from(const json& j) {
    std::vector<std::filesystem::path> paths;
    for (const json& path : j) paths.push_back(path_from(path));
    return paths;
}

std::filesystem::path place(const std::filesystem::path& root) {
    return root / std::filesystem::path(kJournalPath).relative_path();
}

}  // namespace

std::string journal_text(const Journal& journal) {
    json steps = json::array();
    for (const JournalStep& s : journal.steps) {
        json changes = json::array();
        for (const FileChange& c : s.changes)
            changes.push_back({{"path", c.path.string()},
                               {"before", content_json(c.before)},
                               {"after", content_json(c.after)},
                               {"folders", paths_json(c.folders)}});
        steps.push_back({{"name", s.name},
                         {"state", s.state == StepState::done ? "done" : "begun"},
                         {"changes", changes},
                         {"undo_first", s.undo_first},
                         {"undo", s.undo}});
    }
    const json j = {{"format", "tact station journal"},
                    {"version", kVersion},
                    {"core", journal.core},
                    {"kernel_arguments", journal.kernel_arguments},
                    {"complete", journal.complete},
                    {"folders", paths_json(journal.folders)},
                    {"steps", steps}};
    return j.dump(1) + "\n";
}

Journal parse_journal(const std::string& text) {
    try {
        const json j = json::parse(text);
        if (j.at("format") != "tact station journal" || j.at("version") != kVersion)
            throw std::invalid_argument("another format or version");
        Journal journal;
        journal.core = j.at("core");
        journal.kernel_arguments = j.at("kernel_arguments");
        journal.complete = j.at("complete");
        journal.folders = paths_from(j.at("folders"));
        for (const json& s : j.at("steps")) {
            JournalStep step;
            step.name = s.at("name");
            step.state = s.at("state") == "done" ? StepState::done : StepState::begun;
            step.undo_first = s.at("undo_first").get<std::vector<Command>>();
            step.undo = s.at("undo").get<std::vector<Command>>();
            for (const json& c : s.at("changes"))
                step.changes.push_back({.path = path_from(c.at("path")),
                                        .before = content_from(c.at("before")),
                                        .after = content_from(c.at("after")),
                                        .folders = paths_from(c.at("folders"))});
            journal.steps.push_back(std::move(step));
        }
        return journal;
    } catch (const std::exception& e) {
        throw StartupError("read the journal of the station", e.what(),
                           "restore the file from a backup; without it nothing can be undone automatically");
    }
}

std::optional<Journal> read_journal(const std::filesystem::path& root) {
    const std::filesystem::path path = place(root);
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0 && errno == ENOENT) return std::nullopt;
    const FileContent content = read_content(path);
    if ((content.uid != geteuid() && content.uid != 0) || (content.mode & (S_IWGRP | S_IWOTH)) != 0)
        throw StartupError(
            "read " + path.string(), "users other than you and root may have changed the file",
            "check the content, then run: chown root " + path.string() + "; chmod 600 " + path.string());
    return parse_journal(content.bytes);
}

void write_journal(const std::filesystem::path& root, const Journal& journal) {
    for (const auto& folder : journal.folders)
        if (mkdir((root / folder).c_str(), 0755) != 0 && errno != EEXIST)
            throw StartupError("make folder " + (root / folder).string(), last_error(),
                               "run tact station as root");
    put_content(place(root), {.kind = FileKind::file,
                              .bytes = journal_text(journal),
                              .mode = 0600,
                              .uid = geteuid(),
                              .gid = getegid()});
}

void remove_journal(const std::filesystem::path& root, const Journal& journal) {
    put_content(place(root), {});
    for (auto folder = journal.folders.rbegin(); folder != journal.folders.rend(); ++folder)
        rmdir((root / *folder).c_str());
}

}  // namespace tact::launch
