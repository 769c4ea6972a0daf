// A folder for the files of a child program; the destructor removes it.
//
// Left over  if its owner is killed, the next ScratchFolder of the same user removes the folder. The owner holds a
//            lock on it, which the kernel releases when the owner dies for any reason. So neither a reused process
//            id nor another user's folder is removed by mistake.
// Fails by   StartupError if no folder can be created
// Thread     any
#pragma once

#include <filesystem>

namespace tact {

class ScratchFolder {
public:
    // Created in `parent`, named "tact-gui-scratch-" and six random letters.
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
