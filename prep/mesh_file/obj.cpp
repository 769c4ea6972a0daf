// Wavefront OBJ: lines "v x y z" and "f a b c" with corners a, a/t, a//n or a/t/n, counted from 1, or back
// from the last vertex where negative. All else (normals, groups, materials, curves) is passed over.
#include <vector>

#include "prep/mesh_file/formats.hpp"
#include "prep/mesh_file/text_scan.hpp"

namespace tact {
namespace {

// Counts the lines of vertices and faces, so that memory is taken once and can be told.
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
                    source.refuse(where() + ": a vertex without three numbers");
            }
            builder.vertex(p, where);
        } else if (kind == "f") {
            corner.clear();
            for (std::string_view word = scan.word(); !word.empty(); word = scan.word()) {
                if (word == "\\" && scan.next_line()) continue;  // the face goes on in the next line
                std::int64_t v = 0;
                if (!TextScan::number(word.substr(0, word.find('/')), v) || v == 0)
                    source.refuse(where() + ": a face with a corner that is no number from 1");
                if (corner.size() == MeshBuilder::kCornersMax)
                    source.refuse(where() + ": a face has more than 255 corners", "divide it into triangles");
                const auto known = static_cast<std::int64_t>(builder.vertices());
                if (v < 0 && v < -known)
                    source.refuse(where() + ": a face counts back before the first vertex");
                corner.push_back(v > 0 ? v - 1 : known + v);
            }
            builder.face(corner, where);
        }
    }
    return {builder.finish(), "OBJ"};
}

}  // namespace tact
