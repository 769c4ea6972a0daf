#include "tests/reproduce/ply.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "deploy/tact/files.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
    throw StartupError("reading " + path.string(), why, "write it again with tact-prep");
}

constexpr std::size_t kCountMax = 50'000'000;

std::size_t size_of(const std::string& type) {
    static constexpr std::array<std::pair<std::string_view, std::size_t>, 16> kTypes{{{"char", 1},
                                                                                      {"uchar", 1},
                                                                                      {"int8", 1},
                                                                                      {"uint8", 1},
                                                                                      {"short", 2},
                                                                                      {"ushort", 2},
                                                                                      {"int16", 2},
                                                                                      {"uint16", 2},
                                                                                      {"int", 4},
                                                                                      {"uint", 4},
                                                                                      {"int32", 4},
                                                                                      {"uint32", 4},
                                                                                      {"float", 4},
                                                                                      {"float32", 4},
                                                                                      {"double", 8},
                                                                                      {"float64", 8}}};
    for (const auto& [name, size] : kTypes)
        if (name == type) return size;
    return 0;
}

struct Property {
    std::string name, type, count_type;  // count_type empty: a scalar
};

// Values one after the other, from letters or from bytes.
class Values {
public:
    Values(std::istream& in, bool ascii, const std::filesystem::path& path)
        : in_(in), ascii_(ascii), path_(path) {}
    double next(const std::string& type) {
        if (ascii_) {
            double v = 0.0;
            if (!(in_ >> v)) refuse(path_, "it ends before its last value, or one is no number");
            return v;
        }
        std::array<char, 8> b{};
        const std::size_t n = size_of(type);
        if (!in_.read(b.data(), static_cast<std::streamsize>(n)))
            refuse(path_, "it ends before its last value");
        if (type == "float" || type == "float32") return as<float>(b);
        if (type == "double" || type == "float64") return as<double>(b);
        const bool sign = type[0] != 'u';
        if (n == 1) return sign ? as<std::int8_t>(b) : as<std::uint8_t>(b);
        if (n == 2) return sign ? as<std::int16_t>(b) : as<std::uint16_t>(b);
        return sign ? as<std::int32_t>(b) : as<std::uint32_t>(b);
    }

private:
    template <class T>
    static double as(const std::array<char, 8>& b) {
        T v;
        std::memcpy(&v, b.data(), sizeof v);
        return static_cast<double>(v);
    }
    std::istream& in_;
    bool ascii_;
    const std::filesystem::path& path_;
};

struct Header {
    bool ascii = true;
    std::size_t vertices = 0, faces = 0;
    std::vector<Property> vertex{}, face{};
};

Header read_header(std::istream& in, const std::filesystem::path& path) {
    Header h;
    std::string line, element;
    if (!std::getline(in, line) || line.substr(0, 3) != "ply") refuse(path, "this is no PLY file");
    for (int i = 0; i < 200 && std::getline(in, line); ++i) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "end_header") return h;
        if (word == "format") {
            words >> word;
            h.ascii = word == "ascii";
            if (!h.ascii && word != "binary_little_endian") refuse(path, "its format is " + word);
        } else if (word == "element") {
            std::size_t count = 0;
            words >> element >> count;
            if (count > kCountMax) refuse(path, "it declares " + std::to_string(count) + " of " + element);
            if (element == "vertex")
                h.vertices = count;
            else if (element == "face")
                h.faces = count;
            else if (count > 0)
                refuse(path, "it has elements of another kind: " + element);
        } else if (word == "property") {
            Property p;
            words >> p.type;
            if (p.type == "list") words >> p.count_type >> p.type;
            words >> p.name;
            if (size_of(p.type) == 0 || (!p.count_type.empty() && size_of(p.count_type) == 0))
                refuse(path, "unknown type in: " + line);
            (element == "vertex" ? h.vertex : h.face).push_back(p);
        }
    }
    refuse(path, "its header has no end");
}

}  // namespace

void write_ply(const TriangleMesh& mesh, double scale, const std::filesystem::path& path) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                       std::to_string(mesh.triangles()) +
                       "\nproperty list uchar int vertex_indices\nend_header\n";
    std::array<char, 96> line{};
    for (std::size_t v = 0; v + 2 < mesh.position_m.size(); v += 3) {
        const auto at = [&](std::size_t i) { return static_cast<double>(mesh.position_m[v + i]) * scale; };
        std::snprintf(line.data(), line.size(), "%.9g %.9g %.9g\n", at(0), at(1), at(2));
        text += line.data();
    }
    for (std::size_t t = 0; t + 2 < mesh.triangle.size(); t += 3) {
        std::snprintf(line.data(), line.size(), "3 %u %u %u\n", mesh.triangle[t], mesh.triangle[t + 1],
                      mesh.triangle[t + 2]);
        text += line.data();
    }
    write_whole(path, text);
}

TriangleMesh read_ply(const std::filesystem::path& path, double scale) {
    std::ifstream in(path, std::ios::binary);
    if (!in) refuse(path, "it cannot be opened");
    const Header h = read_header(in, path);
    Values values(in, h.ascii, path);
    TriangleMesh mesh;
    for (std::size_t v = 0; v < h.vertices; ++v) {
        std::array<double, 3> at{};
        for (const Property& p : h.vertex) {
            if (!p.count_type.empty()) refuse(path, "a vertex has a list");
            const double x = values.next(p.type);
            if (p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
                at[static_cast<std::size_t>(p.name[0] - 'x')] = x;
        }
        for (const double x : at) mesh.position_m.push_back(static_cast<float>(x / scale));
    }
    for (std::size_t f = 0; f < h.faces; ++f)
        for (const Property& p : h.face) {
            if (p.count_type.empty()) {
                values.next(p.type);
                continue;
            }
            if (values.next(p.count_type) != 3.0) refuse(path, "a face is no triangle");
            for (int i = 0; i < 3; ++i) {
                const double index = values.next(p.type);
                if (!(index >= 0.0 && index < static_cast<double>(h.vertices)))
                    refuse(path, "a face names a vertex that is not there");
                mesh.triangle.push_back(static_cast<std::uint32_t>(index));
            }
        }
    return mesh;
}

}  // namespace tact::launch
