// STL: separate triangles without shared vertices. A file is binary if its size is 84 + 50 n bytes for the declared n,
// whatever its first word, because some binary files begin with "solid".
#include <bit>
#include <cstring>

#include "prep/mesh_file/formats.hpp"
#include "prep/mesh_file/text_scan.hpp"
#include "prep/mesh_file/vertex_table.hpp"

namespace tact {
namespace {

// Merges equal corners into one vertex.
class Welder {
public:
    Welder(const MeshSource& source, std::size_t triangles)
        : source_(source), builder_(source), number_(triangles / 2) {
        builder_.reserve(triangles / 2, triangles);
    }
    template <class Where>
    std::int64_t vertex(const std::array<double, 3>& p, Where&& where) {
        const auto fresh = static_cast<std::int64_t>(builder_.vertices());
        MeshBuilder::check(source_, p, where);  // the table must not hold NaN
        const std::uint32_t known =
            number_.find({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])},
                         builder_.position_m());
        if (known != VertexTable::kNone) return known;
        builder_.vertex(p, where);
        return fresh;
    }
    MeshBuilder& builder() { return builder_; }

private:
    const MeshSource& source_;
    MeshBuilder builder_;
    VertexTable number_;
};

std::uint32_t little_endian(const char* bytes) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return value;
}

constexpr std::size_t kHead = 84, kStride = 50;

ImportedMesh read_binary(const MeshSource& source, std::uint32_t count) {
    Welder welder(source, count);
    for (std::uint32_t t = 0; t < count; ++t) {
        if (t % 65536 == 0) source.at(kHead + kStride * std::size_t{t});
        const auto where = [&] { return "triangle " + std::to_string(t); };
        std::array<std::int64_t, 3> corner{};
        for (std::size_t c = 0; c < 3; ++c) {
            std::array<double, 3> p{};
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t place = kHead + kStride * std::size_t{t} + 12 * (c + 1) + 4 * i;
                p[i] = static_cast<double>(std::bit_cast<float>(little_endian(&source.bytes[place])));
            }
            corner[c] = welder.vertex(p, where);
        }
        welder.builder().face(corner, where);
    }
    return {welder.builder().finish(), "STL binary"};
}

ImportedMesh read_text(const MeshSource& source) {
    constexpr std::size_t kFacetBytes = 240;  // with six digits per number
    Welder welder(source, source.bytes.size() / kFacetBytes);
    TextScan scan(source.bytes);
    const auto where = [&] { return "line " + std::to_string(scan.line_number()); };
    std::vector<std::int64_t> corner;
    std::uint64_t words = 0;
    for (std::string_view word = scan.word_of_any_line(); !word.empty(); word = scan.word_of_any_line()) {
        if (++words % 65536 == 0) source.at(scan.place());
        if (word == "loop") {
            corner.clear();
        } else if (word == "vertex") {
            std::array<double, 3> p{};
            for (double& x : p) {
                if (!TextScan::number(scan.word_of_any_line(), x))
                    source.refuse(where() + ": the vertex does not have three numbers");
            }
            if (corner.size() == 3) source.refuse(where() + ": the facet has more than three vertices");
            corner.push_back(welder.vertex(p, where));
        } else if (word == "endloop") {
            if (corner.size() != 3) source.refuse(where() + ": the facet does not have three vertices");
            welder.builder().face(corner, where);
            corner.clear();
        }
    }
    if (!corner.empty()) source.refuse("the file ends within a facet", "fetch the file again");
    return {welder.builder().finish(), "STL ascii"};
}

}  // namespace

ImportedMesh read_stl(const MeshSource& source) {
    if (source.bytes.size() >= kHead) {
        const std::uint32_t count = little_endian(&source.bytes[80]);
        if (source.bytes.size() == kHead + kStride * std::uint64_t{count}) return read_binary(source, count);
    }
    const bool text = source.bytes.substr(0, 512).find('\0') == std::string_view::npos;
    if (text && source.bytes.starts_with("solid")) return read_text(source);
    source.refuse(
        "the file is neither text that begins with \"solid\" nor of the size of the triangles that it "
        "declares",
        "fetch the file again");
}

}  // namespace tact
