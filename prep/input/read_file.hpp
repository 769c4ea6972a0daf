// A whole input file in memory, unpacked when it is gzip'd.
//
// Bounds    never more than `bytes_max` after unpacking; a file that unpacks to more is refused while it
//           unpacks, before memory runs out. Whether it is packed is seen from its first two bytes.
// Fails by  StartupError naming the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tact {

std::vector<char> read_whole_file(const std::filesystem::path& path, std::uint64_t bytes_max);

// What tells whether a file is still the same: "312255 bytes, crc32 1a2b3c4d", of the file as it lies there.
std::string file_mark(const std::filesystem::path& path);

// Lower-case ending of the name without a trailing ".gz": "a.MRC.gz" -> ".mrc".
std::string format_ending(const std::filesystem::path& path);

}  // namespace tact
