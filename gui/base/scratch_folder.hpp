// A folder for the files of a child program, which goes with this object.
//
// Left over  by an owner that was killed: the next one made by the same user removes it. Its owner holds a lock on
//            it, which the kernel lets go when the owner dies, however that is; so neither a process number
//            that was used again nor another user's folder is mistaken for it.
// Fails by   StartupError where no folder can be made
// Thread     any
#pragma once

#include <filesystem>

namespace tact {

class ScratchFolder {
public:
    // In `parent`, named "tact-gui-scratch-" and six letters.
    explicit ScratchFolder(const std::filesystem::path& parent = std::filesystem::temp_directory_path());
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    [[nodiscard]] bool make(const std::filesystem::path& parent);
    std::filesystem::path path_;
    int lock_fd_ = -1;
};

}  // namespace tact
