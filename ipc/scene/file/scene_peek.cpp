#include "ipc/scene/file/scene_peek.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_layout.hpp"

namespace tact {
namespace {

struct PeekedFile {
    int fd;
    ~PeekedFile() {
        if (fd >= 0) ::close(fd);
    }
};

}  // namespace

bool is_scene(const std::filesystem::path& path) noexcept {
    const PeekedFile file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    char magic[sizeof scene_layout::kMagic];
    return file.fd >= 0 && ::pread(file.fd, magic, sizeof magic, 0) == static_cast<ssize_t>(sizeof magic) &&
           std::memcmp(magic, scene_layout::kMagic, sizeof magic) == 0;
}

SceneMeta peek_scene(const std::filesystem::path& path) {
    using namespace scene_layout;
    const auto fail = [&](const std::string& why) {
        throw StartupError("inspect scene " + path.string(), why,
                           "choose a scene written by tact-prep, or bake it again");
    };
    const PeekedFile file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    struct stat info {};
    if (file.fd < 0 || ::fstat(file.fd, &info) != 0) fail(last_error());
    if (!S_ISREG(info.st_mode)) fail("the file is not a regular file");
    const auto size = static_cast<std::uint64_t>(info.st_size);
    const auto read_at = [&](void* to, std::size_t bytes, std::uint64_t at) {
        if (at > size || bytes > size - at ||
            ::pread(file.fd, to, bytes, static_cast<off_t>(at)) != static_cast<ssize_t>(bytes))
            fail("the file ends before its content");
    };
    Header header;
    read_at(&header, sizeof header, 0);
    if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) fail("the file is not a Tact scene");
    if (header.format_version != kFormatVersion)
        fail("its format version is " + std::to_string(header.format_version) + ", this program reads " +
             std::to_string(kFormatVersion));
    if (header.total_bytes != size) fail("the file is incomplete");
    if (header.section_count == 0 || header.section_count > kSectionsMax) fail("its section count is wrong");
    std::vector<TableRow> table(header.section_count);
    const std::size_t table_bytes = table.size() * sizeof(TableRow);
    read_at(table.data(), table_bytes, sizeof header);
    if (crc_of(reinterpret_cast<const std::byte*>(table.data()), table_bytes) != header.table_crc)
        fail("the checksum of its section table is wrong");
    // Builds a scene of this one section, so that the same code checks it; only the number of the other
    // sections matters.
    SceneWriter alone;
    for (const TableRow& row : table) {
        std::vector<std::byte> bytes;
        if (row.tag == SceneMeta::kTag && row.index == 0) {
            if (row.bytes != sizeof(SceneMeta)) fail("its section META has the wrong size");
            bytes.resize(sizeof(SceneMeta));
            read_at(bytes.data(), bytes.size(), row.offset);
            if (crc_of(bytes.data(), bytes.size()) != row.crc)
                fail("the checksum of its section META is wrong");
        }
        alone.add(row.tag, row.version, row.index, std::move(bytes));
    }
    const std::vector<std::byte> whole = alone.to_bytes();
    return read_meta(SceneFile::from_bytes(whole, path.string()));
}

}  // namespace tact
