// The scene: one file of checked sections that both processes map read-only.
//
// Layout    header (magic "TACTSCN1", format version, section count, total bytes, CRC-32 of the section
//           table), section table (tag, index, version, offset, bytes, CRC-32), then the sections, each at
//           a multiple of 64 bytes. Little endian. A section holds plain data; its own header contains the
//           counts.
// Written   by tact-prep, to a temporary file beside the target that is synced and renamed: complete or
//           absent
// Errors    StartupError with the file, the section, the fault and the fix. open() checks everything:
//           magic, version, sizes, overlap, checksums. Readers check the contents
// Thread    open() on any thread but the servo thread; views are immutable and readable on any thread
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tact {

using SectionTag = std::array<char, 4>;  // "META", "GRID", "BODY", …

class SceneFile {
public:
    static SceneFile open(const std::filesystem::path& path);
    // The same checks on bytes in memory, for tests and fuzzing. The bytes must outlive the object.
    static SceneFile from_bytes(std::span<const std::byte> bytes, const std::string& name);

    SceneFile(SceneFile&& other) noexcept;
    SceneFile& operator=(SceneFile&& other) noexcept;
    ~SceneFile();

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] std::uint64_t checksum() const {
        return checksum_;
    }                                                         // of all sections; identifies the content
    [[nodiscard]] std::uint32_t count(SectionTag tag) const;  // sections with this tag: 0, 1, …
    // Throws if absent or of another version.
    [[nodiscard]] std::span<const std::byte> section(SectionTag tag, std::uint32_t version,
                                                     std::uint32_t index = 0) const;

private:
    SceneFile() = default;
    void check();
    struct Row {
        SectionTag tag;
        std::uint32_t index, version;
        std::span<const std::byte> bytes;
    };
    std::string name_;
    std::span<const std::byte> bytes_;
    void* mapped_ = nullptr;
    std::uint64_t checksum_ = 0;
    std::vector<Row> rows_;
};

class SceneWriter {
public:
    void add(SectionTag tag, std::uint32_t version, std::uint32_t index, std::vector<std::byte> bytes);
    void write(const std::filesystem::path& path) const;
    [[nodiscard]] std::vector<std::byte> to_bytes() const;

private:
    struct Section {
        SectionTag tag;
        std::uint32_t version, index;
        std::vector<std::byte> bytes;
    };
    std::vector<Section> sections_;
};

}  // namespace tact
