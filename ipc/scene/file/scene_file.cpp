// Method. The layout is canonical: the sections follow each other in the order of the table, each at the
// next multiple of 64; the bytes between them are zero, and the file ends with the last one. So sections
// cannot overlap, every byte of the file is covered by a check, and open() detects any changed bit.
//
// The file is never changed in place (tact-prep renames a complete one over it), so the map stays valid.
#include "ipc/scene/file/scene_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/bytes.hpp"
#include "ipc/scene/file/scene_layout.hpp"

namespace tact {

using namespace scene_layout;

namespace {

constexpr std::uint64_t align_up(std::uint64_t n) { return (n + kAlign - 1) / kAlign * kAlign; }

bool all_zero(const std::byte* first, std::size_t size) {
    return std::all_of(first, first + size, [](std::byte b) { return b == std::byte{0}; });
}

// Tags of untrusted files may contain any bytes; messages stay printable.
std::string shown(SectionTag tag) {
    std::string text;
    for (const char c : tag) text += c >= 0x20 && c < 0x7f ? c : '?';
    return text;
}

std::string hex(std::uint32_t value) {
    char text[12];
    std::snprintf(text, sizeof text, "%08x", value);
    return text;
}

constexpr char kFixBake[] = "bake it again: tact-prep dock MAP MODEL -o SCENE.tact";

// Closes the descriptor on every return path.
struct Descriptor {
    int fd;
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
};

}  // namespace

SceneFile SceneFile::open(const std::filesystem::path& path) {
    const std::string attempt = "open scene " + path.string();
    // O_NONBLOCK: a named pipe must not hang the start.
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.fd < 0) {
        throw StartupError(
            attempt, std::strerror(errno),
            "check the path and its permissions, or bake one: tact-prep dock MAP MODEL -o SCENE.tact");
    }
    struct stat info {};
    if (::fstat(file.fd, &info) != 0)
        throw StartupError(attempt, std::strerror(errno), "check the file system");
    if (!S_ISREG(info.st_mode)) {
        throw StartupError(attempt, "the file is not a regular file", "choose a scene written by tact-prep");
    }
    const auto size = static_cast<std::uint64_t>(info.st_size);
    if (size < sizeof(Header)) {
        throw StartupError(attempt,
                           "it has " + std::to_string(size) + " bytes, fewer than the header of a scene (64)",
                           kFixBake);
    }
    if (size > kBytesMax) {
        throw StartupError(attempt,
                           "it has " + std::to_string(size) + " bytes, more than the limit of a scene",
                           "choose a scene written by tact-prep");
    }
    void* const mapped = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd, 0);
    if (mapped == MAP_FAILED) {
        throw StartupError(attempt, std::string("the file cannot be mapped: ") + std::strerror(errno),
                           "free memory");
    }
    SceneFile scene;
    scene.name_ = path.string();
    scene.mapped_ = mapped;
    scene.bytes_ = {static_cast<const std::byte*>(mapped), static_cast<std::size_t>(size)};
    scene.check();
    return scene;
}

SceneFile SceneFile::from_bytes(std::span<const std::byte> bytes, const std::string& name) {
    SceneFile scene;
    scene.name_ = name;
    scene.bytes_ = bytes;
    scene.check();
    return scene;
}

SceneFile::SceneFile(SceneFile&& other) noexcept
    : name_(std::move(other.name_)),
      bytes_(std::exchange(other.bytes_, {})),
      mapped_(std::exchange(other.mapped_, nullptr)),
      checksum_(other.checksum_),
      rows_(std::move(other.rows_)) {}

SceneFile& SceneFile::operator=(SceneFile&& other) noexcept {
    std::swap(name_, other.name_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
    std::swap(checksum_, other.checksum_);
    std::swap(rows_, other.rows_);
    return *this;
}

SceneFile::~SceneFile() {
    if (mapped_ != nullptr) ::munmap(mapped_, bytes_.size());
}

void SceneFile::check() {
    const auto fail = [&](const std::string& why, const char* fix = kFixBake) {
        throw StartupError("open scene " + name_, why, fix);
    };
    Header header;
    if (bytes_.size() < sizeof header) {
        fail("it has " + std::to_string(bytes_.size()) + " bytes, fewer than the header of a scene (64)");
    }
    std::memcpy(&header, bytes_.data(), sizeof header);
    if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) {
        fail("at byte 0: the file does not begin with TACTSCN1, so it is not a Tact scene",
             "choose a scene written by tact-prep");
    }
    if (header.format_version != kFormatVersion) {
        fail("at byte 8: its format version is " + std::to_string(header.format_version) +
             ", this program reads " + std::to_string(kFormatVersion));
    }
    if (header.total_bytes != bytes_.size()) {
        fail("at byte 16: its header states " + std::to_string(header.total_bytes) +
             " bytes, but its size is " + std::to_string(bytes_.size()) +
             (header.total_bytes > bytes_.size() ? " (truncated)" : " (too long)"));
    }
    if (header.section_count == 0 || header.section_count > kSectionsMax) {
        fail("at byte 12: its header states " + std::to_string(header.section_count) + " sections");
    }
    if (!all_zero(bytes_.data() + offsetof(Header, reserved), sizeof header.reserved)) {
        fail("at byte 28: reserved bytes of the header are not zero");
    }
    const std::size_t table_bytes = std::size_t{header.section_count} * sizeof(TableRow);
    if (table_bytes > bytes_.size() - sizeof header)
        fail("at byte 64: the section table extends beyond the end of the file");
    const std::uint32_t table_crc = crc_of(bytes_.data() + sizeof header, table_bytes);
    if (table_crc != header.table_crc) {
        fail("at byte 64: the checksum of the section table is " + hex(table_crc) + ", recorded is " +
             hex(header.table_crc));
    }
    std::uint64_t end = sizeof header + table_bytes;
    rows_.reserve(header.section_count);
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
        TableRow row;
        std::memcpy(&row, bytes_.data() + sizeof header + std::size_t{i} * sizeof row, sizeof row);
        const std::string where = "section " + shown(row.tag) + " " + std::to_string(row.index) +
                                  " at byte " + std::to_string(row.offset) + ": ";
        const std::uint64_t begin = align_up(end);
        if (row.offset != begin) fail(where + "it should begin at byte " + std::to_string(begin));
        if (begin > bytes_.size() || row.bytes > bytes_.size() - begin)
            fail(where + "it extends beyond the end of the file");
        if (!all_zero(bytes_.data() + end, static_cast<std::size_t>(begin - end))) {
            fail(where + "the bytes before it are not zero");
        }
        if (row.index != count(row.tag)) fail(where + "its index is out of order");
        const std::span<const std::byte> content = bytes_.subspan(begin, row.bytes);
        const std::uint32_t crc = crc_of(content.data(), content.size());
        if (crc != row.crc) fail(where + "its checksum is " + hex(crc) + ", recorded is " + hex(row.crc));
        rows_.push_back({row.tag, row.index, row.version, content});
        end = begin + row.bytes;
    }
    if (end != bytes_.size()) fail("at byte " + std::to_string(end) + ": bytes follow the last section");
    // FNV-1a over the table, which contains the checksum of every section.
    checksum_ = 0xcbf29ce484222325ULL;
    for (const std::byte b : bytes_.subspan(sizeof header, table_bytes)) {
        checksum_ = (checksum_ ^ std::to_integer<std::uint64_t>(b)) * 0x100000001b3ULL;
    }
}

std::uint32_t SceneFile::count(SectionTag tag) const {
    return static_cast<std::uint32_t>(
        std::count_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.tag == tag; }));
}

std::span<const std::byte> SceneFile::section(SectionTag tag, std::uint32_t version,
                                              std::uint32_t index) const {
    for (const Row& row : rows_) {
        if (row.tag != tag || row.index != index) continue;
        if (row.version != version) {
            throw StartupError(
                "read scene " + name_ + ", section " + shown(tag) + " " + std::to_string(index),
                "it has version " + std::to_string(row.version) + ", this program reads " +
                    std::to_string(version),
                "bake the scene again with this version of tact-prep");
        }
        return row.bytes;
    }
    throw StartupError("read scene " + name_, "it has no section " + shown(tag) + " " + std::to_string(index),
                       "bake the scene again with this version of tact-prep");
}

void SceneWriter::add(SectionTag tag, std::uint32_t version, std::uint32_t index,
                      std::vector<std::byte> bytes) {
    sections_.push_back({tag, version, index, std::move(bytes)});
}

std::vector<std::byte> SceneWriter::to_bytes() const {
    std::uint64_t end = sizeof(Header) + sections_.size() * sizeof(TableRow);
    std::vector<TableRow> table;
    for (const Section& section : sections_) {
        const std::uint64_t begin = align_up(end);
        table.push_back({section.tag, section.index, section.version,
                         crc_of(section.bytes.data(), section.bytes.size()), begin, section.bytes.size()});
        end = begin + section.bytes.size();
    }
    std::vector<std::byte> bytes(end);
    const std::size_t table_bytes = table.size() * sizeof(TableRow);
    if (table_bytes > 0) std::memcpy(bytes.data() + sizeof(Header), table.data(), table_bytes);
    Header header{};
    std::memcpy(header.magic, kMagic, sizeof kMagic);
    header.format_version = kFormatVersion;
    header.section_count = static_cast<std::uint32_t>(sections_.size());
    header.total_bytes = end;
    header.table_crc = crc_of(bytes.data() + sizeof(Header), table_bytes);
    std::memcpy(bytes.data(), &header, sizeof header);
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        if (sections_[i].bytes.empty()) continue;
        std::memcpy(bytes.data() + table[i].offset, sections_[i].bytes.data(), sections_[i].bytes.size());
    }
    return bytes;
}

void SceneWriter::write(const std::filesystem::path& path) const {
    const std::string attempt = "write scene " + path.string();
    const std::vector<std::byte> bytes = to_bytes();
    const auto fail = [&](const char* what) {
        throw StartupError(attempt, std::string(what) + ": " + std::strerror(errno),
                           "check that the folder exists, is writable and has space for " +
                               std::to_string(bytes.size()) + " bytes");
    };
    if (std::filesystem::is_directory(path)) {
        throw StartupError(attempt, "the path is a folder", "choose a file name: -o FOLDER/scene.tact");
    }
    std::string temporary = path.string() + ".XXXXXX";
    // Removes a partial file on every return path; after the rename there is nothing to remove.
    struct Remover {
        std::string* name;
        ~Remover() {
            if (!name->empty()) ::unlink(name->c_str());
        }
    };
    const Descriptor file{::mkostemp(temporary.data(), O_CLOEXEC)};
    if (file.fd < 0) fail("creating a temporary file beside it failed");
    const Remover remover{&temporary};
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::write(file.fd, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) fail("writing failed");
        done += static_cast<std::size_t>(n);
    }
    // mkostemp creates a private file; a scene has ordinary permissions.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (::fchmod(file.fd, static_cast<mode_t>(0666) & ~mask) != 0) fail("setting its permissions failed");
    if (::fsync(file.fd) != 0) fail("syncing failed");
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail("renaming failed");
    temporary.clear();
    // The new name is durable after the folder is synced; some file systems cannot do that, but the file is
    // still complete.
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    const Descriptor parent{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    if (parent.fd >= 0) static_cast<void>(::fsync(parent.fd));
}

}  // namespace tact
