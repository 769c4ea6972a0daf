#include "prep/mesh_file/write_ply.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include <unistd.h>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

void put(std::string& out, std::uint32_t word) {
    for (unsigned i = 0; i < 4; ++i) out.push_back(static_cast<char>(word >> (8 * i)));
}

}  // namespace

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh) {
    const auto fail = [&](const char* what) {
        throw StartupError("write mesh " + path.string(), std::string(what) + ": " + std::strerror(errno),
                           "check that the folder exists, is writable and has free space");
    };
    const std::string beside = path.string() + ".part" + std::to_string(::getpid());
    struct Remover {
        const std::string& name;
        ~Remover() { ::unlink(name.c_str()); }  // does nothing after the rename
    } const remover{beside};
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(beside.c_str(), "wbx"), &std::fclose);
    if (!file) fail("the temporary file could not be created");
    std::string out =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices()) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(mesh.triangles()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto flush = [&](std::size_t from) {
        if (out.size() < from) return;
        if (std::fwrite(out.data(), 1, out.size(), file.get()) != out.size()) fail("writing failed");
        out.clear();
    };
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    for (const float x : mesh.position_m) {
        std::uint32_t word = 0;
        std::memcpy(&word, &x, 4);
        put(out, word);
        flush(kPiece);
    }
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        out.push_back(3);
        for (std::size_t i = 0; i < 3; ++i) put(out, mesh.triangle[3 * t + i]);
        flush(kPiece);
    }
    flush(0);
    if (std::fflush(file.get()) != 0 || ::fsync(::fileno(file.get())) != 0) fail("writing failed");
    if (std::fclose(file.release()) != 0) fail("closing failed");
    if (std::rename(beside.c_str(), path.c_str()) != 0) fail("renaming failed");
}

}  // namespace tact
