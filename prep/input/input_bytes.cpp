#include "prep/input/input_bytes.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "ipc/base/error.hpp"
#include "prep/input/read_file.hpp"

namespace tact {

InputBytes::InputBytes(const std::filesystem::path& path, std::uint64_t bytes_max,
                       std::uint64_t unpacked_max) {
    const auto fail = [&](const std::string& why, const char* fix) {
        throw StartupError("read " + path.string(), why, fix);
    };
    struct Handle {
        int fd;
        ~Handle() {
            if (fd >= 0) ::close(fd);
        }
    } const file{
        ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};  // does not wait for the writer of a pipe
    if (file.fd < 0) fail(std::strerror(errno), "check the path and its permissions");
    struct stat info {};
    if (::fstat(file.fd, &info) != 0) fail(std::strerror(errno), "check the path and its permissions");
    unsigned char magic[2]{};
    const bool packed =
        S_ISREG(info.st_mode) && ::pread(file.fd, magic, 2, 0) == 2 && magic[0] == 0x1f && magic[1] == 0x8b;
    if (packed || !S_ISREG(info.st_mode) || info.st_size == 0) {  // read_whole_file() also rejects non-files
        unpacked_ = read_whole_file(path, unpacked_max);
        view_ = {unpacked_.data(), unpacked_.size()};
        return;
    }
    const auto size = static_cast<std::size_t>(info.st_size);
    if (size > bytes_max)
        fail(
            "the file is larger than " + std::to_string(bytes_max >> 20) + " MiB, the largest size supported",
            "split the file into parts");
    mapped_ = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd, 0);
    if (mapped_ == MAP_FAILED) {
        mapped_ = nullptr;
        fail(std::strerror(errno), "free memory, or raise the limit on address space");
    }
    (void)::madvise(mapped_, size, MADV_SEQUENTIAL);
    view_ = {static_cast<const char*>(mapped_), size};
}

InputBytes::~InputBytes() {
    if (mapped_ != nullptr) ::munmap(mapped_, view_.size());
}

}  // namespace tact
