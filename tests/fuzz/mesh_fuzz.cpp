// Meshes from anywhere. The first byte selects the format. An accepted mesh has its indices in range and finite
// numbers, and can be simplified.
#include <cmath>
#include <string>

#include "prep/mesh/relax.hpp"
#include "prep/mesh_file/import_mesh.hpp"
#include "tests/fuzz/format_fuzz.hpp"

namespace tact::fuzz {
namespace {

constexpr const char* kEnding[] = {".ply", ".obj", ".stl", ".off"};

void use(const TriangleMesh& mesh) {
    require(mesh.triangles() > 0 && mesh.position_m.size() % 3 == 0 && mesh.triangle.size() % 3 == 0);
    for (const float x : mesh.position_m) require(std::isfinite(x));
    for (const std::uint32_t v : mesh.triangle) require(v < mesh.vertices());
    if (mesh.triangles() > 2000) return;
    Simplified coarse = simplify(mesh, {.vertices_min = 3, .pair_distance = 1.0});
    relax(mesh, coarse, 1);
    for (const float x : coarse.mesh.position_m) require(std::isfinite(x));
}

template <class T>
void put(std::string& to, T value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

bool run(std::span<const std::byte> input) {
    return run_formats(input, std::size(kEnding), [](unsigned ending, std::string_view text) {
        use(import_mesh_bytes(text, "fuzz", kEnding[ending]).mesh);
    });
}

std::vector<Input> seeds() {
    const std::string head =
        "element vertex 9\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
        "property list uchar int vertex_indices\nend_header\n";
    std::string ascii = "ply\nformat ascii 1.0\n" + head, obj, stl = "solid s\n",
                off = "COFF # made by hand\n9 4 12\n";
    std::string little = "ply\nformat binary_little_endian 1.0\n" + head, binary(80, ' ');
    const auto z = [](int x, int y) { return static_cast<float>(x * y) * 0.25F; };
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            const std::string p =
                std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z(x, y)) + "\n";
            ascii += p;
            obj += "v " + p;
            off += p;
            for (const float c : {static_cast<float>(x), static_cast<float>(y), z(x, y)}) put(little, c);
        }
    }
    put(binary, std::uint32_t{4});
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
            const int corner[4] = {3 * y + x, 3 * y + x + 1, 3 * y + x + 4, 3 * y + x + 3};
            ascii += "4";
            off += "4";
            obj += "f";
            put(little, std::uint8_t{4});
            for (const int c : corner) {
                ascii += " " + std::to_string(c);
                off += " " + std::to_string(c);
                obj += " " + std::to_string(c + 1) + "//1";
                put(little, c);
            }
            ascii += "\n";
            off += " 255 0 0\n";
            obj += "\n";
            stl += "facet normal 0 0 1\nouter loop\n";
            binary.append(12, '\0');
            for (int i = 0; i < 3; ++i) {
                const int cx = corner[i] % 3, cy = corner[i] / 3;
                stl += "vertex " + std::to_string(cx) + " " + std::to_string(cy) + " " +
                       std::to_string(z(cx, cy)) + "\n";
                for (const float c : {static_cast<float>(cx), static_cast<float>(cy), z(cx, cy)})
                    put(binary, c);
            }
            binary.append(2, '\0');
            stl += "endloop\nendfacet\n";
        }
    }
    return {seed(0, ascii),  seed(0, little), seed(1, obj), seed(2, stl + "endsolid\n"),
            seed(2, binary), seed(3, off)};
}

}  // namespace tact::fuzz
