// Reading only the kind of a scene from a file of arbitrary bytes: it must agree with a complete read of the file.
//
// First byte   odd: fix lengths and checksums of the header, the table and META first, so that the later code is reached
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "ipc/base/error.hpp"
#include "ipc/scene/file/scene_layout.hpp"
#include "ipc/scene/file/scene_peek.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::fuzz {
namespace {

using namespace scene_layout;

constexpr std::size_t kBytesMost = 1 << 18;

void fix(Input& bytes) {
    Header header;
    if (bytes.size() < sizeof header) return;
    std::memcpy(&header, bytes.data(), sizeof header);
    header.total_bytes = bytes.size();
    const std::size_t rows = std::min<std::size_t>(header.section_count, kSectionsMax),
                      table_bytes = rows * sizeof(TableRow);
    if (table_bytes > bytes.size() - sizeof header) return;
    for (std::size_t i = 0; i < rows; ++i) {
        std::byte* const at = bytes.data() + sizeof header + i * sizeof(TableRow);
        TableRow row;
        std::memcpy(&row, at, sizeof row);
        if (row.offset > bytes.size() || row.bytes > bytes.size() - row.offset) continue;
        row.crc = crc_of(bytes.data() + row.offset, row.bytes);
        std::memcpy(at, &row, sizeof row);
    }
    header.table_crc = crc_of(bytes.data() + sizeof header, table_bytes);
    std::memcpy(bytes.data(), &header, sizeof header);
}

template <class Read>
std::optional<SceneMeta> meta_of(Read&& read) {
    try {
        return read();
    } catch (const StartupError& error) {
        require(std::strstr(error.what(), "fix:") != nullptr);
    }
    return std::nullopt;
}

SceneMeta peeked(const Input& bytes) {
    const int fd = memfd_create("fuzz", MFD_CLOEXEC);
    require(fd >= 0 && ::pwrite(fd, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
    struct Closer {
        int fd;
        ~Closer() { ::close(fd); }
    } const closer{fd};
    return peek_scene("/proc/self/fd/" + std::to_string(fd));
}

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.empty() || input.size() > kBytesMost) return false;
    Input bytes(input.begin() + 1, input.end());
    if ((input[0] & std::byte{1}) != std::byte{0}) fix(bytes);
    const auto look = meta_of([&] { return peeked(bytes); });
    const auto whole = meta_of([&] { return read_meta(SceneFile::from_bytes(bytes, "fuzz.tact")); });
    require(!whole || look);
    if (!look) return false;
    require(!whole || std::memcmp(&*look, &*whole, sizeof *look) == 0);
    require(std::memchr(look->title, 0, sizeof look->title) != nullptr);
    require(scene_kind_text(look->kind) != nullptr && look->world_per_model > 0.0);
    require(look->kind != SceneKind::docking || look->body_count > 0);
    return true;
}

std::vector<Input> seeds() {
    SceneMeta surface = sample::meta();
    surface.kind = SceneKind::surface;
    surface.body_count = 0;
    SceneWriter alone;
    write_meta(alone, surface, "");
    alone.add({'S', 'U', 'R', 'F'}, 1, 0, Input(3));  // of the other sections only the count matters
    alone.add(SceneMeta::kTag, 2, 1, Input(3));       // an unknown section of a newer format
    std::vector<Input> all;
    for (const Input& scene : {sample::scene().to_bytes(), alone.to_bytes()})
        for (const std::byte first : {std::byte{0}, std::byte{1}}) {
            all.emplace_back(scene.size() + 1, first);
            std::copy(scene.begin(), scene.end(), all.back().begin() + 1);
        }
    return all;
}

}  // namespace tact::fuzz
