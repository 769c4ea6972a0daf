// The first bytes of a region's file, and the reader's checks of them.
//
// Input    untrusted: the header comes from another process; it is copied once, then checked; no field is
//          used before
// Errors   a refusal is a sentence with the value found and the value expected; empty: accepted
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "ipc/shm/region.hpp"
#include "ipc/shm/words.hpp"

namespace tact {

inline constexpr std::uint64_t kRegionHeaderBytes = 256;  // the content follows, suitably aligned
inline constexpr std::uint32_t kRegionHeaderVersion = 1;
inline constexpr std::uint64_t kRegionReady = 0x5944414552544341ULL;  // stored last, with release

struct RegionHeader {
    std::uint64_t magic;
    std::uint32_t version;
    std::uint32_t pid;  // of the writer
    std::uint64_t layout_hash;
    std::uint64_t content_bytes;
    std::uint64_t generation;
    char name[32];               // ends with 0
    char build[32];              // ends with 0; for people
    std::uint64_t reserved[16];  // zero
};
static_assert(std::is_trivially_copyable_v<RegionHeader> && sizeof(RegionHeader) == 232);

struct alignas(64) SharedRegionHeader {
    SharedWords<RegionHeader> fields;
    std::atomic<std::uint64_t> ready;
};
static_assert(sizeof(SharedRegionHeader) == kRegionHeaderBytes);

[[nodiscard]] RegionHeader make_region_header(const RegionIdentity& identity, std::uint64_t generation);

// Pure function for any bytes. file_bytes is the sealed size of the whole file.
[[nodiscard]] std::string refuse_region_header(const RegionHeader& header, std::uint64_t ready,
                                               std::uint64_t file_bytes, const RegionIdentity& wanted);

}  // namespace tact
