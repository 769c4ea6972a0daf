// Meshes from files: every format gives the same mesh, and all file content is checked.
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <set>

#include "ipc/base/error.hpp"
#include "prep/mesh/mesh_folds.hpp"
#include "prep/mesh/simplify.hpp"
#include "prep/mesh_file/import_mesh.hpp"
#include "prep/mesh_file/write_ply.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::prep_mesh_file_test {
namespace {

namespace fs = std::filesystem;

ImportedMesh read(const std::string& text, const std::string& ending) {
    return import_mesh_bytes(text, "test" + ending, ending);
}

// Returns the error, or "" if the file is accepted.
std::string refusal(const std::string& text, const std::string& ending) {
    try {
        read(text, ending);
    } catch (const StartupError& error) {
        return error.what();
    }
    return {};
}

template <class T>
std::string raw(T value, bool big) {
    std::string out(sizeof(T), '\0');
    std::memcpy(out.data(), &value, sizeof(T));
    if (big) std::reverse(out.begin(), out.end());
    return out;
}

// A tetrahedron.
constexpr float kAt[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr std::int32_t kFace[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

std::string ply_ascii() {
    std::string s =
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nelement face 4\nproperty list uchar int "
        "vertex_indices\nend_header\n";
    for (const auto& p : kAt)
        s += std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + " 255\n";
    for (const auto& f : kFace)
        s += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
    return s;
}

// Contains ignored data: an element before, a list at the vertices, other types and another order.
// A tetrahedron of one strip; then the same triangle twice, in strips that begin anew, with a repeated vertex that makes none.
std::string ply_strips() {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element tristrips 2\nproperty list int int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n0 0 1\n6 0 1 2 3 0 1\n9 0 1 2 -1 1 1 0 2 -1\n";
}

std::string ply_binary(bool big) {
    std::string s =
        std::string("ply\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\nelement camera 1\nproperty list uint16 float shot\nelement vertex 4\n"
        "property double z\nproperty list uchar short marks\nproperty double x\nproperty float32 y\n"
        "element face 4\nproperty uchar group\nproperty list int32 uint32 vertex_index\nend_header\n";
    s += raw<std::uint16_t>(2, big) + raw(1.5F, big) + raw(2.5F, big);
    for (const auto& p : kAt)
        s += raw<double>(p[2], big) + raw<std::uint8_t>(1, big) + raw<std::int16_t>(-7, big) +
             raw<double>(p[0], big) + raw(p[1], big);
    for (const auto& f : kFace) {
        s += raw<std::uint8_t>(9, big) + raw<std::int32_t>(3, big);
        for (const std::int32_t v : f) s += raw<std::uint32_t>(static_cast<std::uint32_t>(v), big);
    }
    return s;
}

std::string stl_binary() {
    std::string s = "solid, as some programs write here";
    s.resize(80, ' ');
    s += raw<std::uint32_t>(4, false);
    for (const auto& f : kFace) {
        s += std::string(12, '\0');
        for (const std::int32_t v : f) {
            for (int i = 0; i < 3; ++i) s += raw(kAt[v][i], false);
        }
        s += std::string(2, '\0');
    }
    return s;
}

std::string stl_ascii() {
    std::string s = "solid made by hand\r\n";
    for (const auto& f : kFace) {
        s += "facet normal 0 0 0\r\n outer loop\r\n";
        for (const std::int32_t v : f)
            s += "  vertex " + std::to_string(kAt[v][0]) + " " + std::to_string(kAt[v][1]) + "  " +
                 std::to_string(kAt[v][2]) + "\r\n";
        s += " endloop\r\nendfacet\r\n";
    }
    return s + "endsolid\r\n";
}

std::string obj() {
    return "# a comment\nmtllib none.mtl\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv +0 1.0e0 0\nv 0 0 1\nvn 0 0 1\n"
           "f 1 3 2\nf 1/1 2/1 4/1\nf 2//1 3//1 4//1\nf -4 -1 \\\n -2\n";
}

std::string off(const std::string& head = "OFF\n") {
    std::string s = head + "# made by hand\n\n4 4 0\n";
    for (const auto& p : kAt)
        s += std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + " 0 0 1\r\n";
    for (const auto& f : kFace)
        s += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
             " 1.0 0.5 0.5 # red\n";
    return s;
}

double volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        std::array<std::array<double, 3>, 3> p{};
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < 3; ++i) p[c][i] = mesh.position_m[3 * mesh.triangle[3 * t + c] + i];
        }
        sum += (p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
                p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
                p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0])) /
               6.0;
    }
    return sum;
}

TEST(MeshFile, every_format_gives_the_same_tetrahedron) {
    const std::pair<std::string, std::string> files[] = {{ply_ascii(), ".ply"},
                                                         {ply_binary(false), ".ply"},
                                                         {ply_binary(true), ".ply"},
                                                         {stl_binary(), ".stl"},
                                                         {stl_ascii(), ".stl"},
                                                         {obj(), ".obj"},
                                                         {off(), ".off"},
                                                         {off("NOFF # with normals\n"), ".off"},
                                                         {off("COFF "), ".off"},
                                                         {off(""), ".off"}};
    for (const auto& [text, ending] : files) {
        const ImportedMesh in = read(text, ending);
        EXPECT_EQ(in.mesh.vertices(), 4U) << in.format;
        EXPECT_EQ(in.mesh.triangles(), 4U) << in.format;
        EXPECT_NEAR(volume(in.mesh), 1.0 / 6.0, 1e-6) << in.format;
    }
    EXPECT_EQ(read(ply_binary(true), ".ply").format, "PLY binary big endian");
    EXPECT_EQ(read(stl_binary(), ".stl").format, "STL binary");
}

TEST(MeshFile, triangle_strips_of_ply_turn_every_other_triangle) {
    const ImportedMesh mesh = read(ply_strips(), ".ply");
    const std::vector<std::uint32_t> expected{0, 1, 2, 2, 1, 3, 2, 3, 0, 0, 3, 1, 0, 1, 2, 1, 0, 2};
    // The last strip is 1 1 0 2: its first triangle has no area, its second is turned: 0 1 2 again.
    std::vector<std::uint32_t> wanted = expected;
    wanted.erase(wanted.end() - 3, wanted.end());
    wanted.insert(wanted.end(), {0, 1, 2});
    EXPECT_EQ(mesh.mesh.triangle, wanted);
    // Each edge of the tetrahedron is crossed once in either direction.
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t t = 0; t < 12; t += 3)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_TRUE(edges.insert({wanted[t + c], wanted[t + (c + 1) % 3]}).second);
    for (const auto& [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));
    std::string wrong = ply_strips();
    wrong.replace(wrong.find("6 0 1 2 3"), 9, "6 0 1 2 9");
    EXPECT_NE(refusal(wrong, ".ply").find("refers to vertex 9"), std::string::npos);
}

TEST(MeshFile, faces_with_more_corners_become_fans) {
    const TriangleMesh mesh = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", ".obj").mesh;
    EXPECT_EQ(mesh.triangle, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(MeshFile, invalid_files_are_refused_with_place_and_fix) {
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        const std::size_t place = text.find(from);
        EXPECT_NE(place, std::string::npos) << from;
        return text.replace(place, from.size(), to);
    };
    struct Case {
        std::string text, ending, says;
    };
    const Case cases[] = {
        {"", ".ply", "does not begin"},
        {"solid", ".ply", "does not begin"},
        {replaced(ply_ascii(), "vertex 4", "vertex 4000000000"), ".ply", "declares 4000000000"},
        {replaced(ply_ascii(), "vertex 4", "vertex -4"), ".ply", "line 4"},
        {replaced(ply_ascii(), "vertex 4", "vertex 5"), ".ply", "ends early"},
        {replaced(ply_ascii(), "float x", "float w"), ".ply", "vertices with x, y and z"},
        {replaced(ply_ascii(), "float x", "quad x"), ".ply", "type of the property is unknown"},
        {replaced(ply_ascii(), "vertex_indices", "strip"), ".ply", "no faces"},
        {replaced(ply_ascii(), "end_header", ""), ".ply", "unknown keyword"},
        {replaced(ply_ascii(), "3 0 2 1", "3 0 2 4"), ".ply", "refers to vertex 4"},
        {replaced(ply_ascii(), "3 0 2 1", "3 0 2 -1"), ".ply", "a vertex that does not exist"},
        {replaced(ply_ascii(), "3 0 2 1", "2 0 2 1"), ".ply", "face 0"},
        {replaced(ply_ascii(), "1.0", "2.0"), ".ply", ""},
        {replaced(ply_ascii(), "1.000000 0", "nan 0"), ".ply", "vertex 1"},
        {ply_binary(false).substr(0, 300), ".ply", "ends early"},
        {stl_binary().substr(0, 200), ".stl", "nor of the size"},
        {stl_ascii().substr(0, 100), ".stl", "line 5"},
        {replaced(stl_ascii(), "vertex 1.000000", "vertex one"), ".stl", "line"},
        {"v 0 0 0\nv 1 0 0\n", ".obj", "no faces"},
        {replaced(obj(), "f 1 3 2", "f 1 3 5"), ".obj", "refers to vertex 4"},
        {replaced(obj(), "f 1 3 2", "f 0 3 2"), ".obj", "line 8"},
        {replaced(obj(), "f 1 3 2", "f -5 3 2"), ".obj", "line 8"},
        {replaced(obj(), "v 1 0 0", "v 1e9 0 0"), ".obj", "line 4"},
        {replaced(obj(), "v 1 0 0", "v 1 0"), ".obj", ""},
        {off("OFF BINARY\n"), ".off", "binary OFF"},
        {off("4OFF\n"), ".off", "three dimensions"},
        {off("BALL\n"), ".off", "neither the keyword OFF"},
        {off("OOFF\n"), ".off", "keyword is unknown"},
        {replaced(off(), "4 4 0", "4 4000000 0"), ".off", "declares"},
        {replaced(off(), "4 4 0", "4 5 0"), ".off", "ends early"},
        {replaced(off(), "4 4 0", "3 4 0"), ".off", "line 8"},
        {replaced(off(), "3 0 2 1", "3 0 2 4"), ".off", "refers to vertex 4"},
        {replaced(off(), "1.000000 0", "inf 0"), ".off", "line 6"},
        {replaced(ply_binary(false), "element face 4", "element face 9"), ".ply", "ends early"},
        {obj(), ".fbx", "none of .ply"},
    };
    for (const Case& c : cases) {
        const std::string why = refusal(c.text, c.ending);
        if (c.says.empty()) continue;  // cannot be distinguished from a valid file
        EXPECT_NE(why.find(c.says), std::string::npos) << c.says << "\n" << why;
        EXPECT_NE(why.find("fix:"), std::string::npos) << why;
    }
}

TEST(MeshFile, a_written_mesh_reads_back_unchanged) {
    const fs::path path = fs::temp_directory_path() / ("tact-mesh-" + std::to_string(::getpid()) + ".ply");
    const TriangleMesh mesh = read(obj(), ".obj").mesh;
    write_ply(path, mesh);
    const ImportedMesh back = import_mesh(path);
    EXPECT_EQ(back.mesh.position_m, mesh.position_m);
    EXPECT_EQ(back.mesh.triangle, mesh.triangle);
    EXPECT_EQ(back.format, "PLY binary little endian");
    fs::remove(path);
    EXPECT_THROW(write_ply(path / "no" / "folder.ply", mesh), StartupError);
}

TEST(MeshFile, memory_is_reported_before_allocation_and_a_packed_file_gives_the_same_mesh) {
    const fs::path path = fs::temp_directory_path() / ("tact-mesh-" + std::to_string(::getpid()) + ".off.gz");
    const gzFile packed = ::gzopen(path.c_str(), "wb");
    const std::string text = off();
    ASSERT_EQ(::gzwrite(packed, text.data(), static_cast<unsigned>(text.size())),
              static_cast<int>(text.size()));
    ::gzclose(packed);
    std::vector<MeshNeeds> told;
    const ImportedMesh in = import_mesh(path, {}, [&](const MeshNeeds& needs) { told.push_back(needs); });
    fs::remove(path);
    EXPECT_EQ(in.mesh.triangle, read(text, ".off").mesh.triangle);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].vertices, 4U);
    EXPECT_EQ(told[0].triangles, 4U);
    EXPECT_EQ(told[0].bytes, 96U);
}

TEST(MeshFile, real_meshes_are_read_and_simplified_without_new_folds) {
    const fs::path em = sample::em_folder();
    const fs::path folder = em.empty() ? fs::path() : em.parent_path() / "meshes";
    if (!fs::is_directory(folder)) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    struct Expected {
        const char* name;
        std::size_t vertices, triangles;
    };
    const Expected all[] = {{"stanford_bunny.obj", 35947, 69451},
                            {"dragon_100k.ply", 50000, 100000},
                            {"molsurf_1crn.ply.gz", 28177, 56350},
                            {"gears_ascii.stl.gz", 9723, 19426},
                            {"fandisk.obj", 6475, 12946},
                            {"rocker_arm.obj", 10044, 20088},
                            {"tooth.obj", 4384, 8768},
                            {"cow.obj", 2903, 5804},
                            {"face_open.obj.gz", 25905, 51712},
                            {"beetle_alt_open.obj.gz", 19887, 38656},
                            {"teapot_open.obj", 3644, 6320},
                            {"beetle_nonmanifold.obj", 1148, 2053},
                            {"terrain_sthelens_92k.ply", 46440, 92020}};
    for (const Expected& e : all) {
        if (!fs::exists(folder / e.name)) continue;
        const TriangleMesh mesh = import_mesh(folder / e.name).mesh;
        EXPECT_EQ(mesh.vertices(), e.vertices) << e.name;
        EXPECT_EQ(mesh.triangles(), e.triangles) << e.name;
        for (const double pairs : {0.0, 0.5}) {
            if (pairs > 0.0 && e.triangles > 10000) continue;  // would take seconds
            const TriangleMesh coarse =
                simplify(cleaned(mesh), {.vertices_min = 400, .pair_distance = pairs}).mesh;
            EXPECT_LE(coarse.vertices(), 400U) << e.name;
            EXPECT_LE(count_folds(coarse), count_folds(mesh)) << e.name << " pairs " << pairs;
        }
    }
}

}  // namespace
}  // namespace tact::prep_mesh_file_test
