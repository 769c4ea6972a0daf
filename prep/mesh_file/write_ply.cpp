#include "prep/mesh_file/write_ply.hpp"

#include <string>

#include "ipc/base/part_file.hpp"
#include "prep/mesh_file/little_endian.hpp"

namespace tact {

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const PlyColours& colours) {
    PartFile file(path, "mesh");
    const bool coloured = !colours.rgb.empty();
    std::string out = "ply\nformat binary_little_endian 1.0\n";
    if (!colours.comment.empty()) out += "comment " + colours.comment + "\n";
    out += "element vertex " + std::to_string(mesh.vertices()) +
           "\nproperty float x\nproperty float y\nproperty float z\n";
    if (coloured)
        out += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float quality\n";
    out += "element face " + std::to_string(mesh.triangles()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto flush = [&](std::size_t from) {
        if (out.size() < from) return;
        file.write(out);
        out.clear();
    };
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    for (std::size_t v = 0; v < mesh.vertices(); ++v) {
        for (std::size_t i = 0; i < 3; ++i) put_float(out, mesh.position_m[3 * v + i]);
        if (coloured) {
            for (const std::uint8_t part : colours.rgb[v]) out.push_back(static_cast<char>(part));
            put_float(out, colours.quality[v]);
        }
        flush(kPiece);
    }
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        out.push_back(3);
        for (std::size_t i = 0; i < 3; ++i) put_word(out, mesh.triangle[3 * t + i]);
        flush(kPiece);
    }
    flush(0);
    file.finish();
}

}  // namespace tact
