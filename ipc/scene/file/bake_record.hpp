// The files and options that a scene was baked from, as lines of its note, so that it can be baked again.
//
//   input: map, 312255 bytes, crc32 1a2b3c4d, /data/emd.mrc
//   input: structure, 4711 bytes, crc32 00c0ffee, /data/1oel.pdb
//   bake options: --resolution-a 9 --modes 12
//
// Untrusted  a scene may come from anywhere: paths are absolute, options are words of lower-case letters and numbers
// Fails by   StartupError
// Thread     any but the servo thread
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tact {

struct BakeInput {
    std::string role;  // "map", "half-map", "mask", "structure"
    std::string mark;  // file_mark() when the scene was baked
    std::filesystem::path path;
    bool operator==(const BakeInput&) const = default;
};

struct BakeRecord {
    static constexpr std::size_t kInputsMost = 64, kOptionsMost = 32;
    std::vector<BakeInput> inputs;     // in the order of the command
    std::vector<std::string> options;  // "--resolution-a", "9", ...
    [[nodiscard]] std::vector<std::string> paths(const std::string& role) const;
};

// Identifies the content of a file as stored: "312255 bytes, crc32 1a2b3c4d". Throws if it cannot be read.
[[nodiscard]] std::string file_mark(const std::filesystem::path& path);
// A file as it is now.
[[nodiscard]] BakeInput bake_input(const std::string& role, const std::filesystem::path& path);

[[nodiscard]] std::vector<std::string> note_lines(const BakeRecord& record);
// nullopt: the note names no files, as that of a synthetic scene or of one that an older tact-prep baked; or the lines are damaged.
[[nodiscard]] std::optional<BakeRecord> read_bake_record(const std::string& note);

// Throws, naming the file and the fix, if one of the files is missing or has changed. attempt: "add to the scene x.tact".
void check_unchanged(const BakeRecord& record, const std::string& attempt);

// True if `whole` was baked from all that `part` was, with the same options, and perhaps from more files.
[[nodiscard]] bool extends(const BakeRecord& whole, const BakeRecord& part);

}  // namespace tact
