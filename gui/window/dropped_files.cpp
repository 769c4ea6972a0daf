#include "gui/window/dropped_files.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "ipc/base/printable.hpp"
#include "ipc/scene/file/scene_kinds.hpp"
#include "ipc/scene/session/session_file.hpp"

namespace tact {
namespace {

struct RawKind {
    const SceneKindRow* system = nullptr;  // null: no system reads it
    std::size_t type = 0;                  // in system->raw
};

// A scene, a session, or bone that was drilled in the one that is shown.
bool is_scene(const std::string& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) return false;
    std::string ending = std::filesystem::path(file).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending == ".tact" || ending == ".bone" || ending == kSessionEnding;
}

template <class Fits>
RawKind first_kind(Fits&& fits) {
    for (const SceneKindRow& system : scene_kinds())
        for (std::size_t i = 0; i < system.raw.size(); ++i)
            if (fits(system.raw[i])) return {&system, i};
    return {};
}

RawKind kind_of_name(const std::string& file) {
    std::string name = std::filesystem::path(file).filename().string();
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    const std::string ending = std::filesystem::path(name).extension().string();
    return first_kind([&](const RawFileType& type) {
        return std::find(type.endings.begin(), type.endings.end(), ending) != type.endings.end();
    });
}

RawKind kind_of_folder() {
    return first_kind([](const RawFileType& type) { return type.folder_of != nullptr; });
}

RawKind kind_of(const std::string& file) {
    std::error_code ignored;
    return std::filesystem::is_directory(file, ignored) ? kind_of_folder() : kind_of_name(file);
}

// A file's name for a line of text: no control characters; a long name keeps its beginning and its ending.
std::string shown_name(const std::string& file) {
    constexpr std::size_t kHead = 24, kTail = 12;
    std::string name = printable(std::filesystem::path(file).filename().string());
    if (name.size() <= kHead + 3 + kTail) return name;
    std::size_t head = kHead, tail = name.size() - kTail;  // whole characters of UTF-8
    const auto inside = [&](std::size_t at) {
        return (static_cast<unsigned char>(name[at]) & 0xc0U) == 0x80U;
    };
    while (head > 0 && inside(head)) --head;
    while (tail < name.size() && inside(tail)) ++tail;
    return name.substr(0, head) + "..." + name.substr(tail);
}

// All files are of a type that can be added to the scene that is shown.
bool adds_to(const ShownScene& shown, const SceneKindRow& system,
             const std::vector<std::vector<std::string>>& by_type) {
    if (shown.path.empty() || shown.path.front() != '/' || shown.kind != system.kind) return false;
    for (std::size_t i = 0; i < by_type.size(); ++i)
        if (!by_type[i].empty() && (!system.raw[i].adds || by_type[i].size() > system.raw[i].files_max))
            return false;
    return true;
}

}  // namespace

const std::string& dropped_kinds_text() {
    static const std::string text = [] {
        std::string all =
            "Files to drop: a scene (.tact) or a session (.tact-session); drilled bone of the scene that is "
            "shown (.bone)";
        for (const SceneKindRow& system : scene_kinds()) {
            for (const RawFileType& type : system.raw) {
                all +=
                    (&type == system.raw.data() ? "; " : " together with ") + std::string(type.phrase) + " (";
                for (const char* const ending : type.endings)
                    all += (ending == type.endings.front() ? "" : " ") + std::string(ending);
                if (type.folder_of != nullptr) all += ", or a folder of " + std::string(type.folder_of);
                all += ")";
            }
        }
        return all + ".";
    }();
    return text;
}

const char* raw_file_text(const std::string& name) {
    const RawKind kind = kind_of_name(name);
    return kind.system != nullptr ? kind.system->raw[kind.type].name : "";
}

const char* raw_folder_text() {
    const RawKind kind = kind_of_folder();
    return kind.system != nullptr ? kind.system->raw[kind.type].name : "";
}

Dropped meaning_of(const std::vector<std::string>& files, const ShownScene& shown) {
    Dropped out;
    const auto no = [&](const std::string& why) {
        out = {{}, {}, {}, why};
        return out;
    };
    if (files.empty()) return no("No file.");
    if (files.size() > kDroppedMost) return no("Too many files: at most a map and 16 structures.");
    const SceneKindRow* system = nullptr;
    std::vector<std::vector<std::string>> by_type;
    for (const std::string& file : files) {
        // Names become arguments of a command: none may look like an option.
        if (file.empty() || file.front() != '/') return no("A file has no absolute path.");
        if (is_scene(file)) {
            if (files.size() > 1) return no("One scene at a time, without other files.");
            out.scene = file;
            return out;
        }
        const RawKind kind = kind_of(file);
        if (kind.system == nullptr)
            return no("'" + std::filesystem::path(file).filename().string() +
                      "' has an ending that Tact does not read.");
        if (system != nullptr && system != kind.system)
            return no("These files belong to different systems: choose those of one.");
        system = kind.system;
        by_type.resize(system->raw.size());
        by_type[kind.type].push_back(file);
    }
    if (system == nullptr) return no("No file.");
    if (adds_to(shown, *system, by_type)) {
        out.add = {system->command, shown.path};
        out.add.insert(out.add.end(), files.begin(), files.end());
        return out;
    }
    out.import = {system->command};
    for (std::size_t i = 0; i < by_type.size(); ++i) {
        const RawFileType& type = system->raw[i];
        if (by_type[i].empty()) return no(type.missing);
        if (by_type[i].size() > type.files_max)
            return no(type.files_max == 1 ? std::string("One ") + type.name + " at a time."
                                          : "At most " + std::to_string(type.files_max) +
                                                " files of the type " + type.name + ".");
        out.import.insert(out.import.end(), by_type[i].begin(), by_type[i].end());
    }
    return out;
}

std::string meaning_text(const Dropped& meant) {
    if (!meant.scene.empty()) return "Open " + shown_name(meant.scene) + ".";
    if (meant.add.size() > 2) {
        const std::size_t others = meant.add.size() - 3;
        return "Add " + shown_name(meant.add[2]) +
               (others > 0 ? " and " + std::to_string(others) + " more" : std::string()) +
               " to this scene, whose bodies stay where they are.";
    }
    if (meant.import.empty()) return meant.trouble;
    std::string action;
    for (const SceneKindRow& system : scene_kinds())
        if (meant.import[0] == system.command) action = system.action;
    const std::string first = shown_name(meant.import[1]);
    if (meant.import.size() == 2) return action + " " + first + ".";
    const std::size_t more = meant.import.size() - 3;
    return action + " " + shown_name(meant.import[2]) +
           (more > 0 ? " and " + std::to_string(more) + " more" : std::string()) + " into " + first + ".";
}

}  // namespace tact
