// PLY 1.0 (Turk). The header declares elements and their properties. Only x, y, z of "vertex" and the list
// "vertex_indices" (or "vertex_index") of "face" are kept, or of "tristrips" (Stanford's triangle strips: each vertex makes a
// triangle with the two before it, every other one turned; -1 begins anew).
#include <bit>
#include <limits>
#include <vector>

#include "prep/mesh_file/formats.hpp"
#include "prep/mesh_file/text_scan.hpp"

namespace tact {
namespace {

enum class Type : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };
struct TypeName {
    const char *name, *other;
    Type type;
};
constexpr TypeName kTypes[] = {{"char", "int8", Type::i8},      {"uchar", "uint8", Type::u8},
                               {"short", "int16", Type::i16},   {"ushort", "uint16", Type::u16},
                               {"int", "int32", Type::i32},     {"uint", "uint32", Type::u32},
                               {"float", "float32", Type::f32}, {"double", "float64", Type::f64}};
constexpr std::size_t size_of(Type type) {
    constexpr std::array<std::size_t, 8> kSize{1, 1, 2, 2, 4, 4, 4, 8};
    return kSize[static_cast<std::size_t>(type)];
}

enum class Use : std::uint8_t { none, x, y, z, corners, strip };
struct Property {
    Type type = Type::u8, count = Type::u8;  // count: type of a list's length
    bool list = false;
    Use use = Use::none;
};
struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> property;
};
struct Header {
    enum { ascii, little, big } format = ascii;
    std::vector<Element> element;
    std::size_t bytes = 0;
};

// Limits of the header, so that it cannot request work beyond the size of the file.
constexpr std::size_t kHeaderLinesMax = 4096, kPropertiesMax = 256;

class HeaderReader {
public:
    explicit HeaderReader(const MeshSource& source) : source_(source), scan_(source.bytes) {}

    Header read() {
        if (!scan_.next_line() || scan_.word() != "ply") refuse("the file does not begin with \"ply\"");
        bool formatted = false;
        while (scan_.line_number() < kHeaderLinesMax && scan_.next_line()) {
            const std::string_view key = scan_.word();
            if (key == "format") {
                const std::string_view format = scan_.word();
                header_.format = format == "binary_little_endian" ? Header::little
                                 : format == "binary_big_endian"  ? Header::big
                                                                  : Header::ascii;
                if (header_.format == Header::ascii && format != "ascii") refuse("the format is unknown");
                formatted = true;
            } else if (key == "element") {
                add_element();
            } else if (key == "property") {
                add_property();
            } else if (key == "end_header") {
                if (!formatted) refuse("the header has no format");
                header_.bytes = std::min(scan_.place(), source_.bytes.size());
                return header_;
            } else if (key != "comment" && key != "obj_info" && !key.empty()) {
                refuse("the header has an unknown keyword");
            }
        }
        refuse("the header does not end");
    }

private:
    [[noreturn]] void refuse(const std::string& why) const {
        source_.refuse("line " + std::to_string(scan_.line_number()) + ": " + why);
    }
    void add_element() {
        Element element{std::string(scan_.word()), 0, {}};
        if (!TextScan::number(scan_.word(), element.count)) refuse("the element has no count");
        if (element.count > source_.bytes.size())
            source_.refuse("the header declares " + std::to_string(element.count) + " elements \"" +
                               element.name + "\", but the file has only " +
                               std::to_string(source_.bytes.size()) + " bytes",
                           "fetch the file again");
        header_.element.push_back(std::move(element));
    }
    Type type() {
        const std::string_view word = scan_.word();
        for (const TypeName& t : kTypes) {
            if (word == t.name || word == t.other) return t.type;
        }
        refuse("the type of the property is unknown");
    }
    void add_property() {
        if (header_.element.empty()) refuse("the property stands before the first element");
        Element& element = header_.element.back();
        if (element.property.size() == kPropertiesMax) refuse("the element has more than 256 properties");
        Property property;
        if (scan_.line().find(" list ") != std::string_view::npos) {
            scan_.word();
            property.list = true;
            property.count = type();
            if (property.count >= Type::f32) refuse("the length of a list is not an integer");
        }
        property.type = type();
        const std::string_view name = scan_.word();
        if (element.name == "vertex" && !property.list && name.size() == 1 && name[0] >= 'x' &&
            name[0] <= 'z')
            property.use = static_cast<Use>(1 + name[0] - 'x');
        if (property.list && (name == "vertex_indices" || name == "vertex_index")) {
            if (element.name == "face") property.use = Use::corners;
            if (element.name == "tristrips") property.use = Use::strip;
        }
        element.property.push_back(property);
    }

    const MeshSource& source_;
    TextScan scan_;
    Header header_;
};

class TextBody {
public:
    TextBody(const MeshSource& source, std::size_t from) : scan_(source.bytes.substr(from)) {}
    bool number(Type, double& value) { return TextScan::number(scan_.word_of_any_line(), value); }
    [[nodiscard]] std::size_t place() const { return scan_.place(); }

private:
    TextScan scan_;
};

class BinaryBody {
public:
    BinaryBody(const MeshSource& source, std::size_t from, bool big)
        : bytes_(source.bytes), place_(from), big_(big) {}
    bool number(Type type, double& value) {
        const std::size_t size = size_of(type);
        if (bytes_.size() - place_ < size) return false;
        std::uint64_t raw = 0;
        for (std::size_t i = 0; i < size; ++i)
            raw |= std::uint64_t{static_cast<unsigned char>(bytes_[place_ + (big_ ? size - 1 - i : i)])}
                   << (8 * i);
        place_ += size;
        switch (type) {
            case Type::i8:
                value = static_cast<std::int8_t>(raw);
                break;
            case Type::i16:
                value = static_cast<std::int16_t>(raw);
                break;
            case Type::i32:
                value = static_cast<std::int32_t>(raw);
                break;
            case Type::f32:
                value = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
                break;
            case Type::f64:
                value = std::bit_cast<double>(raw);
                break;
            default:
                value = static_cast<double>(raw);
        }
        return true;
    }
    [[nodiscard]] std::size_t place() const { return place_; }

private:
    std::string_view bytes_;
    std::size_t place_;
    bool big_;
};

// Minimum bytes of a row: lists that are kept have three entries, others may be empty.
std::uint64_t row_bytes_min(const Element& element, bool text) {
    std::uint64_t sum = 0;
    for (const Property& property : element.property) {
        const std::size_t kept = property.use == Use::corners ? 3 : 0;
        if (text)
            sum += 2 * (property.list ? 1 + kept : 1);  // a digit and its separator
        else
            sum += property.list ? size_of(property.count) + kept * size_of(property.type)
                                 : size_of(property.type);
    }
    return std::max<std::uint64_t>(sum, 1);
}

// Rejects counts that exceed the rest of the file; then memory may be reserved.
void reserve_for_ply(const MeshSource& source, const Header& header, MeshBuilder& builder) {
    std::uint64_t left = source.bytes.size() + 1 - header.bytes, vertices = 0, faces = 0;
    for (const Element& element : header.element) {
        if (element.property.empty()) continue;
        const std::uint64_t row = row_bytes_min(element, header.format == Header::ascii);
        if (element.count > left / row)
            source.refuse("the header declares " + std::to_string(element.count) + " elements \"" +
                              element.name + "\", but the file ends early",
                          "fetch the file again");
        left -= element.count * row;
        if (element.name == "vertex") vertices = element.count;
        if (element.name == "face") faces += element.count;
    }
    builder.reserve(vertices, faces);
}

class Strip {
public:
    template <class Where>
    void add(std::int64_t vertex, MeshBuilder& builder, const Where& where) {
        if (vertex < 0) {
            count_ = 0;
            return;
        }
        const bool turned = count_ % 2 != 0;
        if (count_ >= 2 && vertex != last_[0] && vertex != last_[1] && last_[0] != last_[1])
            builder.face(std::array{last_[turned ? 1 : 0], last_[turned ? 0 : 1], vertex}, where);
        last_ = {last_[1], vertex};
        ++count_;
    }

private:
    std::array<std::int64_t, 2> last_{};
    std::uint64_t count_ = 0;  // of vertices since the strip began
};

template <class Body>
TriangleMesh read_body(const MeshSource& source, const Header& header, Body&& body) {
    MeshBuilder builder(source);
    reserve_for_ply(source, header, builder);
    std::vector<std::int64_t> corner;
    for (const Element& element : header.element) {
        if (element.property.empty()) continue;  // the file has no data for it
        const bool vertices = element.name == "vertex";
        for (std::uint64_t n = 0; n < element.count; ++n) {
            if (n % 65536 == 0) source.at(header.bytes + body.place());
            const auto where = [&] { return element.name + " " + std::to_string(n); };
            const auto next = [&](Type type) {
                double value = 0.0;
                if (!body.number(type, value))
                    source.refuse(where() + ": the file ends early, or a value is not a number",
                                  "fetch the file again");
                return value;
            };
            std::array<double, 3> p{};
            for (const Property& property : element.property) {
                if (!property.list) {
                    const double value = next(property.type);
                    if (property.use != Use::none)
                        p[static_cast<std::size_t>(property.use) - static_cast<std::size_t>(Use::x)] = value;
                    continue;
                }
                const double length = next(property.count);
                const bool kept = property.use == Use::corners;
                if (!(length >= 0.0) || (kept && length > static_cast<double>(MeshBuilder::kCornersMax)))
                    source.refuse(where() + ": the length of a list is negative or above 255",
                                  "divide the faces into triangles");
                corner.clear();
                Strip strip;
                for (double i = 0.0; i < length; i += 1.0) {
                    const double value = next(property.type);
                    if (property.use == Use::none) continue;
                    if (!(std::abs(value) < 1e15)) source.refuse(where() + ": a corner is not a number");
                    const auto vertex = static_cast<std::int64_t>(value);
                    if (kept)
                        corner.push_back(vertex);
                    else
                        strip.add(vertex, builder, where);
                }
                if (kept) builder.face(corner, where);
            }
            if (vertices) builder.vertex(p, where);
        }
    }
    return builder.finish();
}

void check_kept(const MeshSource& source, const Header& header) {
    unsigned found = 0;
    std::size_t vertices = 0;
    for (const Element& element : header.element) {
        vertices += element.name == "vertex" ? 1 : 0;
        for (const Property& property : element.property) found |= 1U << static_cast<unsigned>(property.use);
    }
    if (vertices != 1 || (found & 0b1110U) != 0b1110U)
        source.refuse("the header does not declare vertices with x, y and z");
    if ((found & 0b110000U) == 0)
        source.refuse("the file has no faces with vertex_indices", "export triangles, not points");
}

}  // namespace

ImportedMesh read_ply(const MeshSource& source) {
    const Header header = HeaderReader(source).read();
    check_kept(source, header);
    switch (header.format) {
        case Header::ascii:
            return {read_body(source, header, TextBody(source, header.bytes)), "PLY ascii"};
        case Header::little:
            return {read_body(source, header, BinaryBody(source, header.bytes, false)),
                    "PLY binary little endian"};
        default:
            return {read_body(source, header, BinaryBody(source, header.bytes, true)),
                    "PLY binary big endian"};
    }
}

}  // namespace tact
