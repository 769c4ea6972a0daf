// An input file as one run of bytes: mapped where it lies, or unpacked into memory when it is gzip'd.
//
// Memory    a plain file takes none of its own: its pages are read as they are walked and may be dropped
//           again. A packed one takes what it unpacks to, at the most `unpacked_max`.
// Bounds    a plain file of more than `bytes_max` is refused.
// Fails by  StartupError naming the file. A file that another program cuts short while it is read ends this
//           one (SIGBUS), as for a baked scene.
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
