// Reads a whole input file into memory and unpacks gzip.
//
// Bounds    at most `bytes_max` after unpacking; a larger file is rejected while it unpacks, before memory runs out.
//           The first two bytes tell whether a file is compressed.
// Fails by  StartupError naming the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tact {

std::vector<char> read_whole_file(const std::filesystem::path& path, std::uint64_t bytes_max);

// Lower-case ending of the name without a trailing ".gz": "a.MRC.gz" -> ".mrc".
std::string format_ending(const std::filesystem::path& path);

}  // namespace tact
