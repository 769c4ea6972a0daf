// An input file as contiguous bytes: memory-mapped, or unpacked into memory if it is compressed with gzip.
//
// Memory    a plain file needs none: its pages are loaded on access and may be evicted. A compressed file needs its
//           unpacked size, at most `unpacked_max`.
// Bounds    a plain file of more than `bytes_max` is rejected.
// Fails by  StartupError naming the file. If another program truncates the file during reading, this program ends
//           with SIGBUS, as for a baked scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace tact {

class InputBytes {
public:
    InputBytes(const std::filesystem::path& path, std::uint64_t bytes_max, std::uint64_t unpacked_max);
    ~InputBytes();
    InputBytes(const InputBytes&) = delete;
    InputBytes& operator=(const InputBytes&) = delete;

    [[nodiscard]] std::string_view view() const { return view_; }

private:
    std::vector<char> unpacked_;
    void* mapped_ = nullptr;
    std::string_view view_;
};

}  // namespace tact
