#include "gui/window/dropped_files.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace tact {
namespace {

RawKind raw_kind(const std::string& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) return RawKind::scan;  // of DICOM files or pictures
    return file_kind(file);
}

// A file's name for a line of words: no control characters, and what is long keeps its beginning and its ending.
std::string shown_name(const std::string& file) {
    constexpr std::size_t kHead = 24, kTail = 12;
    std::string name = std::filesystem::path(file).filename().string();
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    if (name.size() <= kHead + 3 + kTail) return name;
    std::size_t head = kHead, tail = name.size() - kTail;  // whole characters of UTF-8
    const auto inside = [&](std::size_t at) {
        return (static_cast<unsigned char>(name[at]) & 0xc0U) == 0x80U;
    };
    while (head > 0 && inside(head)) --head;
    while (tail < name.size() && inside(tail)) ++tail;
    return name.substr(0, head) + "..." + name.substr(tail);
}

}  // namespace

const char* const kDroppedKinds =
    "What can be dropped: a scene (.tact); a map (.mrc .map .ccp4 .rec .situs) together with its structures "
    "(.pdb "
    ".cif); a mesh (.ply .obj .stl .off); a scan (.nrrd .nhdr .nii .mhd .mha, or a folder of DICOM files or "
    "pictures).";

RawKind file_kind(const std::string& file) {
    std::string name = std::filesystem::path(file).filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.ends_with(".tact")) return RawKind::scene;
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    const std::string ending = std::filesystem::path(name).extension().string();
    struct Endings {
        RawKind kind;
        std::vector<std::string> endings;
    };
    static const Endings kEndings[] = {
        {RawKind::map, {".mrc", ".map", ".ccp4", ".rec", ".situs", ".sit"}},
        {RawKind::structure, {".pdb", ".ent", ".cif", ".mmcif"}},
        {RawKind::mesh, {".ply", ".obj", ".stl", ".off"}},
        {RawKind::scan, {".nrrd", ".nhdr", ".nii", ".mhd", ".mha"}},
    };
    for (const Endings& e : kEndings)
        if (std::find(e.endings.begin(), e.endings.end(), ending) != e.endings.end()) return e.kind;
    return RawKind::none;
}

const char* raw_kind_text(RawKind kind) {
    switch (kind) {
        case RawKind::scene:
            return "scene";
        case RawKind::map:
            return "map";
        case RawKind::structure:
            return "structure";
        case RawKind::mesh:
            return "mesh";
        case RawKind::scan:
            return "scan";
        case RawKind::none:
            break;
    }
    return "";
}

Dropped meaning_of(const std::vector<std::string>& files) {
    Dropped out;
    const auto no = [&](const std::string& why) {
        out = {{}, {}, why};
        return out;
    };
    if (files.empty()) return no("There is no file.");
    if (files.size() > kDroppedMost)
        return no("Too many files at once: a map and 16 structures are the most.");
    std::vector<std::string> maps, structures, others;
    for (const std::string& file : files) {
        // Words of a command: an option must not be made of a name.
        if (file.empty() || file.front() != '/') return no("A file has no absolute path.");
        switch (raw_kind(file)) {
            case RawKind::none:
                return no("'" + std::filesystem::path(file).filename().string() +
                          "' is of no kind that Tact reads: its ending says what a file is.");
            case RawKind::map:
                maps.push_back(file);
                break;
            case RawKind::structure:
                structures.push_back(file);
                break;
            default:
                others.push_back(file);
        }
    }
    if (maps.empty() && structures.empty()) {
        if (others.size() > 1) return no("One scene, mesh or scan at a time.");
        const RawKind kind = raw_kind(others[0]);
        if (kind == RawKind::scene)
            out.scene = others[0];
        else
            out.import = {kind == RawKind::mesh ? "touch" : "drill", others[0]};
        return out;
    }
    if (!others.empty()) return no("A map and its structures cannot come together with other files.");
    if (maps.size() != 1 || structures.empty())
        return no(maps.empty()       ? "A structure needs the map that it is docked into: give both together."
                  : maps.size() == 1 ? "A map needs a structure to dock into it: give both together."
                                     : "One map at a time.");
    out.import = {"dock", maps[0]};
    out.import.insert(out.import.end(), structures.begin(), structures.end());
    return out;
}

std::string meaning_text(const Dropped& meant) {
    if (!meant.scene.empty()) return "Open " + shown_name(meant.scene) + ".";
    if (meant.import.empty()) return meant.trouble;
    const std::string& command = meant.import[0];
    const std::string first = shown_name(meant.import[1]);
    if (command == "touch") return "Touch " + first + ".";
    if (command == "drill") return "Drill " + first + ".";
    const std::size_t more = meant.import.size() - 3;
    return "Dock " + shown_name(meant.import[2]) +
           (more > 0 ? " and " + std::to_string(more) + " more" : std::string()) + " into " + first + ".";
}

}  // namespace tact
