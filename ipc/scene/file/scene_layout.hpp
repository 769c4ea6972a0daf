// Header and section table of a scene file, shared by SceneFile and peek_scene().
#pragma once

#include <cstddef>
#include <cstdint>

#include "ipc/scene/file/packing.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact::scene_layout {

inline constexpr char kMagic[8] = {'T', 'A', 'C', 'T', 'S', 'C', 'N', '1'};
inline constexpr std::uint32_t kFormatVersion = 1;
inline constexpr std::uint32_t kSectionsMax = 4096;
inline constexpr std::uint64_t kAlign = 64;
inline constexpr std::uint64_t kBytesMax = std::uint64_t{1} << 36;  // 64 GiB

struct Header {
    char magic[8];
    std::uint32_t format_version;
    std::uint32_t section_count;
    std::uint64_t total_bytes;
    std::uint32_t table_crc;
    std::uint8_t reserved[36];  // zero
};
static_assert(sizeof(Header) == 64);

struct TableRow {
    SectionTag tag;
    std::uint32_t index, version, crc;
    std::uint64_t offset, bytes;
};
static_assert(sizeof(TableRow) == 32);

}  // namespace tact::scene_layout
