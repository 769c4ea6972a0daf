// Wavefront OBJ: lines "v x y z" and "f a b c" with corners a, a/t, a//n or a/t/n, counted from 1, or backwards
// from the last vertex if negative. All other lines (normals, groups, materials, curves) are skipped.
#include <vector>

#include "prep/mesh_file/formats.hpp"
#include "prep/mesh_file/text_scan.hpp"

namespace tact {
namespace {

// Counts the lines of vertices and faces, to announce and reserve the memory once.
void reserve_for_obj(const MeshSource& source, MeshBuilder& builder) {
    const std::string_view text = source.bytes;
    std::size_t vertices = 0, faces = 0;
    for (std::size_t at = 0; at + 1 < text.size();) {
        const bool blank = text[at + 1] == ' ' || text[at + 1] == '\t';
        vertices += blank && text[at] == 'v' ? 1 : 0;
        faces += blank && text[at] == 'f' ? 1 : 0;
        const std::size_t end = text.find('\n', at);
        if (end == std::string_view::npos) break;
        at = end + 1;
    }
    builder.reserve(vertices, faces);
}

}  // namespace

ImportedMesh read_obj(const MeshSource& source) {
    MeshBuilder builder(source);
    reserve_for_obj(source, builder);
    TextScan scan(source.bytes);
    const auto where = [&] { return "line " + std::to_string(scan.line_number()); };
    std::vector<std::int64_t> corner;
    while (scan.next_line()) {
        if (scan.line_number() % 65536 == 0) source.at(scan.place());
        const std::string_view kind = scan.word();
        if (kind == "v") {
            std::array<double, 3> p{};
            for (double& x : p) {
                if (!TextScan::number(scan.word(), x))
                    source.refuse(where() + ": the vertex does not have three numbers");
            }
            builder.vertex(p, where);
        } else if (kind == "f") {
            corner.clear();
            for (std::string_view word = scan.word(); !word.empty(); word = scan.word()) {
                if (word == "\\" && scan.next_line()) continue;  // the face continues on the next line
                std::int64_t v = 0;
                if (!TextScan::number(word.substr(0, word.find('/')), v) || v == 0)
                    source.refuse(where() + ": a corner of the face is not a vertex number of at least 1");
                if (corner.size() == MeshBuilder::kCornersMax)
                    source.refuse(where() + ": the face has more than 255 corners",
                                  "divide the face into triangles");
                const auto known = static_cast<std::int64_t>(builder.vertices());
                if (v < 0 && v < -known)
                    source.refuse(where() +
                                  ": a negative vertex number of the face lies before the first vertex");
                corner.push_back(v > 0 ? v - 1 : known + v);
            }
            builder.face(corner, where);
        }
    }
    return {builder.finish(), "OBJ"};
}

}  // namespace tact
