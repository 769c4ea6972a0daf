#include "prep/input/read_file.hpp"

#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "ipc/base/error.hpp"

namespace tact {

std::vector<char> read_whole_file(const std::filesystem::path& path, std::uint64_t bytes_max) {
    const std::string attempt = "read " + path.string();
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) {
        throw StartupError(attempt, std::strerror(errno), "check the path and its permissions");
    }
    if (!S_ISREG(info.st_mode))
        throw StartupError(attempt, "the path is not a regular file", "give the path of a file");
    if (info.st_size == 0) throw StartupError(attempt, "the file is empty", "fetch the file again");
    const auto too_big = [&] {
        throw StartupError(
            attempt,
            "the file is larger than " + std::to_string(bytes_max >> 20) + " MiB, the largest size supported",
            "crop the data, or bin it to larger voxels");
    };
    // gzread passes uncompressed files through.
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(::gzopen(path.c_str(), "rb"), &::gzclose);
    if (!file) throw StartupError(attempt, std::strerror(errno), "check the path and its permissions");
    ::gzbuffer(file.get(), 1 << 18);
    const bool packed = ::gzdirect(file.get()) == 0;
    if (!packed && static_cast<std::uint64_t>(info.st_size) > bytes_max) too_big();
    std::vector<char> bytes;
    if (!packed) bytes.reserve(static_cast<std::size_t>(info.st_size) + 1);
    constexpr std::size_t kStep = std::size_t{1} << 22;
    while (true) {
        const std::size_t used = bytes.size();
        const std::size_t step = packed ? kStep : std::min(kStep, bytes.capacity() - used);
        bytes.resize(used + std::max<std::size_t>(step, 1));
        const int got = ::gzread(file.get(), bytes.data() + used, static_cast<unsigned>(bytes.size() - used));
        int code = Z_OK;
        const char* const text = ::gzerror(file.get(), &code);
        if (got < 0 || (code != Z_OK && code != Z_STREAM_END)) {
            throw StartupError(attempt,
                               code == Z_ERRNO ? std::strerror(errno)
                                               : "the gzip stream is damaged or ends early, after " +
                                                     std::to_string(used) + " bytes (" + text + ")",
                               "fetch the file again");
        }
        bytes.resize(used + static_cast<std::size_t>(got));
        if (bytes.size() > bytes_max) too_big();
        if (got == 0) return bytes;
    }
}

std::string format_ending(const std::filesystem::path& path) {
    const auto lower = [](std::string text) {
        std::transform(text.begin(), text.end(), text.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return text;
    };
    std::filesystem::path name = path.filename();
    if (lower(name.extension().string()) == ".gz") name = name.stem();
    return lower(name.extension().string());
}

}  // namespace tact
