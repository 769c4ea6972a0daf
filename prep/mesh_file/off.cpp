// OFF (Geomview): an optional keyword, the counts of vertices, faces and edges, then one line per vertex and one per
// face. Of COFF, NOFF, CNOFF, STOFF and similar the position is kept: the first three numbers of the line. Face colours
// are skipped. Empty lines and text after # are ignored.
#include "prep/mesh_file/formats.hpp"
#include "prep/mesh_file/text_scan.hpp"

namespace tact {
namespace {

class OffReader {
public:
    explicit OffReader(const MeshSource& source) : source_(source), scan_(source.bytes), builder_(source) {}

    ImportedMesh read() {
        std::uint64_t vertices = 0, faces = 0;
        read_head(vertices, faces);
        // "0 0 0\n" and "3 0 1 2\n" are the shortest lines.
        const std::uint64_t left = source_.bytes.size();
        if (vertices > left / 6 || faces > left / 8)
            source_.refuse("the file declares " + std::to_string(vertices) + " vertices and " +
                               std::to_string(faces) + " faces, too many for its " + std::to_string(left) +
                               " bytes",
                           "fetch the file again");
        builder_.reserve(vertices, faces);
        for (std::uint64_t i = 0; i < vertices; ++i) {
            step(i);
            std::array<double, 3> p{};
            std::string_view word = first_word();
            for (double& x : p) {
                if (!TextScan::number(word, x)) refuse("the vertex does not have three numbers");
                word = scan_.word();
            }
            builder_.vertex(p, where_);
        }
        for (std::uint64_t i = 0; i < faces; ++i) {
            step(i);
            read_face();
        }
        return {builder_.finish(), "OFF"};
    }

private:
    [[noreturn]] void refuse(const std::string& why) const { source_.refuse(where_() + ": " + why); }
    void step(std::uint64_t i) const {
        if (i % 65536 == 0) source_.at(scan_.place());
    }
    // The first word of the next line that is neither empty nor a comment.
    std::string_view first_word() {
        while (scan_.next_line()) {
            const std::string_view word = scan_.word();
            if (!word.empty() && word[0] != '#') return word;
        }
        source_.refuse("the file ends early", "fetch the file again");
    }
    void read_head(std::uint64_t& vertices, std::uint64_t& faces) {
        std::string_view word = first_word();
        if (word.ends_with("OFF")) {
            const std::string_view kind = word.substr(0, word.size() - 3);
            if (kind.find_first_of("4n") != std::string_view::npos)
                source_.refuse("the vertices do not have three dimensions", "export the mesh as OFF");
            if (kind.find_first_not_of("CNST") != std::string_view::npos) refuse("the keyword is unknown");
            word = scan_.word();
            if (word == "BINARY")
                source_.refuse("binary OFF is not supported", "export the mesh as text, or as PLY");
            if (word.empty() || word[0] == '#') word = first_word();
        }
        if (!TextScan::number(word, vertices) || !TextScan::number(scan_.word(), faces))
            refuse("neither the keyword OFF nor the counts of vertices and faces are found");
    }
    void read_face() {
        std::size_t count = 0;
        if (!TextScan::number(first_word(), count) || count > MeshBuilder::kCornersMax)
            refuse("the number of corners of the face is missing or more than 255");
        std::array<std::int64_t, MeshBuilder::kCornersMax> corner{};
        for (std::size_t k = 0; k < count; ++k) {
            if (!TextScan::number(scan_.word(), corner[k])) refuse("a corner of the face is not a number");
        }
        builder_.face(std::span(corner).first(count), where_);
    }

    const MeshSource& source_;
    TextScan scan_;
    MeshBuilder builder_;
    struct Where {
        const TextScan& scan;
        std::string operator()() const { return "line " + std::to_string(scan.line_number()); }
    } const where_{scan_};
};

}  // namespace

ImportedMesh read_off(const MeshSource& source) { return OffReader(source).read(); }

}  // namespace tact
