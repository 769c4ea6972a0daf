// tact-prep as a program: exit codes and messages; a scene is complete or absent.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ipc/scene/density/contour_mesh.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::prep_cli_test {
namespace {

namespace fs = std::filesystem;

struct Ended {
    int code = -1;
    std::string out, err;
};

class Program : public ::testing::Test {
protected:
    Program() {
        std::string name = (fs::temp_directory_path() / "tact-cli-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
    }
    ~Program() override { fs::remove_all(folder_); }

    // With `interrupt`, sends SIGINT at the program's first output.
    Ended run(const std::vector<std::string>& arguments, bool interrupt = false) const {
        std::vector<char*> argv{const_cast<char*>(TACT_PREP)};
        for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
        argv.push_back(nullptr);
        const fs::path out = folder_ / "stdout";
        int err[2];
        if (::pipe(err) != 0) return {};
        const pid_t child = ::fork();
        if (child == 0) {
            const int file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            ::dup2(file, 1);
            ::dup2(err[1], 2);
            ::close(err[0]);
            ::close(err[1]);
            ::execv(TACT_PREP, argv.data());
            ::_exit(127);
        }
        ::close(err[1]);
        Ended ended;
        char text[4096];
        for (ssize_t n = 0; (n = ::read(err[0], text, sizeof text)) > 0;) {
            ended.err.append(text, static_cast<std::size_t>(n));
            if (interrupt) ::kill(child, SIGINT);
            interrupt = false;
        }
        ::close(err[0]);
        int status = 0;
        ::waitpid(child, &status, 0);
        ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        std::ostringstream all;
        all << std::ifstream(out).rdbuf();
        ended.out = all.str();
        fs::remove(out);
        return ended;
    }
    fs::path write(const char* name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    fs::path write(const char* name, const std::vector<char>& bytes) const {
        return write(name, std::string(bytes.begin(), bytes.end()));
    }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
    }

    void expect_refused(const std::vector<std::string>& arguments,
                        const std::vector<const char*>& words) const {
        const Ended e = run(arguments);
        EXPECT_EQ(e.code, 1) << e.err;
        for (const char* word : words)
            EXPECT_NE(e.err.find(word), std::string::npos) << word << " is not in: " << e.err;
        EXPECT_NE(e.err.find("fix: "), std::string::npos) << e.err;
        EXPECT_FALSE(fs::exists(folder_ / "s.tact"));
    }
    fs::path folder_;
};

TEST_F(Program, bakes_the_demo_and_describes_it) {
    const std::string scene = folder_ / "ring.tact";
    const Ended baked = run({"demo", "dock", "-o", scene, "--json"});
    ASSERT_EQ(baked.code, 0) << baked.err;
    EXPECT_EQ(baked.err.find('\r'), std::string::npos) << "no progress line without a terminal";
    const auto json = nlohmann::json::parse(baked.out);
    EXPECT_GT(json["mesh"]["vertices"].get<int>(), 1000);
    EXPECT_GT(json["bodies"][0]["inside_home"].get<double>(), 0.95);
    const Ended info = run({"info", scene, "--json"});
    ASSERT_EQ(info.code, 0) << info.err;
    EXPECT_EQ(nlohmann::json::parse(info.out)["checksum"], json["checksum"]);
    EXPECT_NE(run({"info", scene}).out.find("world per model: "), std::string::npos);
    EXPECT_EQ(entries(), 1U);
}

TEST_F(Program, bakes_another_contour_of_a_scene) {
    const std::string scene = folder_ / "ring.tact", out = folder_ / "c.tact";
    ASSERT_EQ(run({"demo", "dock", "-o", scene}).code, 0);
    const SceneFile file = SceneFile::open(scene);
    const double level = 1.25 * read_meta(file).contour;
    char text[40];
    std::snprintf(text, sizeof text, "--level=%.17g", level);
    const Ended e = run({"contour", scene, text, "-o", out, "--vertices-max", "500"});
    ASSERT_EQ(e.code, 0) << e.err;
    EXPECT_EQ(read_contour(SceneFile::open(out), {file.checksum(), level})->vertices(), 500U);
    // A parent process that has ended cancels the program.
    const fs::path late = folder_ / "late.tact";
    EXPECT_EQ(run({"contour", scene, text, "-o", late, "--ends-with", std::to_string(getpid() + 1)}).code,
              130);
    EXPECT_FALSE(fs::exists(late));
    EXPECT_EQ(run({"contour", scene, text, "-o", late, "--ends-with", std::to_string(getpid())}).code, 0);
    expect_refused({"contour", scene, "--level", "1e9", "-o", folder_ / "s.tact"}, {"no surface", "1e+09"});
    expect_refused({"contour", out, "--level", "1", "-o", folder_ / "s.tact"}, {"GRID"});
    expect_refused({"contour", scene, "--level", "1", "-o", scene}, {"input"});
}

TEST_F(Program, bakes_a_map_and_a_structure_from_files) {
    sample::Mrc mrc;
    mrc.start = {-3, 2, 0};
    const std::string map = write("m.mrc", mrc.bytes()),
                      model = write("a.pdb", sample::pdb_atom(" CA ", "ALA", 'A', 1, 2.0, 15.0, 10.0) +
                                                 sample::pdb_atom(" CB ", "ALA", 'A', 1, 3.0, 15.0, 11.0));
    const Ended e =
        run({"dock", map, model, "-o", folder_ / "s.tact", "--contour", "10", "--resolution-a", "8.5"});
    ASSERT_EQ(e.code, 0) << e.err;
    EXPECT_NE(e.out.find("map origin: NSTART words 5-7 (-3, 2, 0) x voxel"), std::string::npos) << e.out;
    const SceneFile file = SceneFile::open(folder_ / "s.tact");
    EXPECT_NEAR(read_meta(file).resolution_m, 8.5e-10, 1e-18);
    EXPECT_EQ(read_meta(file).contour, 10.0);
}

TEST_F(Program, bad_input_is_refused_with_name_place_reason_and_fix) {
    const std::vector<char> good = sample::Mrc().bytes();
    const std::string map = write("good.mrc", good),
                      model = write("good.pdb", sample::pdb_atom(" CA ", "ALA", 'A', 1, 5.0, 5.0, 5.0)),
                      out = folder_ / "s.tact";
    const auto dock = [&](const std::string& m, const std::string& s) {
        return std::vector<std::string>{"dock", m, s, "-o", out, "--resolution-a", "8"};
    };
    expect_refused(dock(folder_ / "absent.mrc", model), {"absent.mrc", "No such file"});
    expect_refused(dock(map, folder_ / "absent.pdb"), {"absent.pdb", "No such file"});
    expect_refused(dock(write("cut.mrc", std::vector<char>(good.begin(), good.end() - 9)), model),
                   {"cut.mrc", "6 x 5 x 4", "(truncated)"});
    std::vector<char> longer = good;
    longer.resize(longer.size() + 100);
    expect_refused(dock(write("long.mrc", longer), model), {"long.mrc", "(oversized)"});
    std::vector<char> huge = good;
    const std::int32_t n = 16000;
    for (int w = 0; w < 3; ++w) std::memcpy(huge.data() + 4 * w, &n, 4);
    expect_refused(dock(write("huge.mrc", huge), model), {"huge.mrc", "words 1-3", "16000 x 16000 x 16000"});
    std::vector<char> mixed = good;  // header in one byte order, sizes valid in neither
    std::memcpy(mixed.data() + 64, "\0\2\0\0", 4);
    expect_refused(dock(write("mixed.mrc", mixed), model), {"mixed.mrc", "invalid in both byte orders"});
    std::vector<char> nan = good;
    std::memset(nan.data() + 1024, 0xff, nan.size() - 1024);
    expect_refused(dock(write("nan.mrc", nan), model),
                   {"nan.mrc", "120 of 120 voxels are not finite", "voxel (0, 0, 0)"});
    expect_refused(dock(map, write("empty.pdb", "REMARK nothing\nEND\n")), {"empty.pdb", "no atoms"});
    expect_refused(
        dock(map, write("bad.pdb",
                        sample::pdb_atom(" CA ", "ALA", 'A', 1, 5.0, 5.0, 5.0).replace(30, 8, "   x.xxx"))),
        {"bad.pdb", "line 1", "x 'x.xxx'"});
    expect_refused({"dock", map, model, "--resolution-a", "8", "-o", folder_ / "absent" / "s.tact"},
                   {"absent", "does not exist"});
    expect_refused({"dock", map, model, "--resolution-a", "8", "-o", map},
                   {"good.mrc", "one of the input files"});
    expect_refused({"dock", map, model, "-o", out},
                   {"good.mrc", "resolution is unknown", "--resolution-a", "--half-map"});
    expect_refused({"dock", map, model, "-o", out, "--half-map", map}, {"half-maps", "1 given"});
    expect_refused({"dock", map, model, "-o", out, "--resolution-a", "8", "--contour", "1e9"},
                   {"contour", "outside the map's values"});
    std::vector<char> flipped;
    {
        ASSERT_EQ(run({"demo", "dock", "-o", folder_ / "ring.tact"}).code, 0);
        std::ifstream in(folder_ / "ring.tact", std::ios::binary);
        flipped.assign(std::istreambuf_iterator<char>(in), {});
        flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
    }
    expect_refused({"info", write("flipped.tact", flipped)},
                   {"flipped.tact", "section ", "at byte ", "checksum"});
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{},
                                                  {"dock", map},
                                                  {"dock", map, model},
                                                  {"demo", "dock", "-o", out, "--unknown"}}) {
        EXPECT_EQ(run(wrong).code, 2);
    }
    EXPECT_EQ(run({"--help"}).code, 0);
}

TEST_F(Program, simplifies_a_mesh_and_reports_the_result) {
    // A wavy sheet of 30 x 30 squares as OBJ, with faces of four corners.
    std::string obj;
    for (int y = 0; y <= 30; ++y) {
        for (int x = 0; x <= 30; ++x)
            obj += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
                   std::to_string(2.0 * std::sin(0.2 * x) * std::cos(0.3 * y)) + "\n";
    }
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 30; ++x) {
            const int a = 31 * y + x + 1;
            obj += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + 32) +
                   " " + std::to_string(a + 31) + "\n";
        }
    }
    const std::string in = write("sheet.obj", obj), out = folder_ / "coarse.ply",
                      again = folder_ / "again.ply";
    const Ended e = run({"simplify", in, "--vertices", "100", "-o", out, "--json"});
    ASSERT_EQ(e.code, 0) << e.err;
    const auto json = nlohmann::json::parse(e.out);
    EXPECT_EQ(json["vertices_in"].get<int>(), 961);
    EXPECT_EQ(json["vertices"].get<int>(), 100);
    EXPECT_EQ(json["folds"].get<int>(), 0);
    EXPECT_GT(json["error"].get<double>(), 0.0);
    EXPECT_LT(json["error"].get<double>(), 0.2);
    // The output reads back, and the options are accepted.
    const Ended second = run({"simplify", out, "--vertices", "20", "-o", again, "--boundary-weight", "1000",
                              "--pair-distance", "0.5", "--relax", "0"});
    ASSERT_EQ(second.code, 0) << second.err;
    EXPECT_NE(second.out.find("20 vertices"), std::string::npos) << second.out;
    EXPECT_EQ(entries(), 3U);
    expect_refused({"simplify", in, "--vertices", "100", "-o", in}, {"input files"});
    expect_refused({"simplify", write("bad.stl", std::string(200, 'x')), "--vertices", "9", "-o", out},
                   {"bad.stl", "nor of the size"});
    EXPECT_EQ(run({"simplify", in, "--vertices", "0", "-o", out}).code, 2);
}

TEST_F(Program, bakes_bone_from_a_scan_or_synthetic) {
    const std::string scene = folder_ / "bone.tact";
    const Ended made = run({"drill", "--synthetic", "--voxels", "24", "-o", scene, "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("MB of memory needed"), std::string::npos) << made.err;
    EXPECT_EQ(nlohmann::json::parse(made.out)["structures"], 9);
    auto info = nlohmann::json::parse(run({"info", scene, "--json"}).out);
    EXPECT_EQ(info["kind"], "drilling");
    EXPECT_EQ(info["bone"]["size"][2], 24);
    EXPECT_EQ(info["structures"][0]["name"], "facial nerve");
    EXPECT_TRUE(info["structures"][0].contains("distance"));

    std::string mha =
        "NDims = 3\nDimSize = 4 4 4\nElementSpacing = 0.5 0.5 1\nElementType = MET_UCHAR\n"
        "ElementDataFile = LOCAL\n";
    mha.append(64, 'z');
    const std::string scan = write("scan.mha", mha);
    const Ended baked = run({"drill", scan, "-o", scene, "--crop", "0:4,1:3,0:4", "--unit", "cm", "--face",
                             "top", "--threshold-hu", "0", "--solid-hu", "255"});
    ASSERT_EQ(baked.code, 0) << baked.err;
    EXPECT_NE(baked.err.find("does not state the patient's left side"), std::string::npos) << baked.err;
    info = nlohmann::json::parse(run({"info", scene, "--json"}).out);
    EXPECT_EQ(info["bone"]["size"], (std::vector<int>{4, 2, 7}));
    EXPECT_DOUBLE_EQ(info["bone"]["voxel_m"].get<double>(), 5e-3);
    expect_refused({"drill", scan, "-o", scene, "--crop", "0:4,1:3"}, {"--crop", "first:end"});
    expect_refused({"drill", "-o", scene}, {"--synthetic"});
    expect_refused({"drill", scan, "-o", scan}, {"input files"});
    expect_refused({"drill", scan, "--labels", scan, "-o", scene, "--threshold-hu", "200"}, {"no voxel"});
}

TEST_F(Program, logs_progress_in_percent) {
    const std::string dock = folder_ / "dock.tact", mesh = write("tetra.obj",
                                                                 "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\n"
                                                                 "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"demo", "dock", "-o", dock},
          {"contour", dock, "--level", "50", "-o", folder_ / "contour.tact"},
          {"touch", mesh, "--tool", mesh, "-o", folder_ / "touch.tact"},
          {"demo", "touch", "--parts", "40", "--vertices-max", "2000", "-o", folder_ / "made.tact"},
          {"drill", "--synthetic", "--voxels", "32", "-o", folder_ / "bone.tact"}}) {
        const Ended e = run(words);
        ASSERT_EQ(e.code, 0) << e.err;
        std::istringstream lines(e.err);
        int before = 0, seen = 0;
        for (std::string line; std::getline(lines, line);) {
            int percent = 0;
            if (std::sscanf(line.c_str(), "[%3d %%] ", &percent) != 1) continue;
            EXPECT_GE(percent, before) << words[0] << ' ' << words[1] << ":\n" << e.err;
            before = percent;
            ++seen;
        }
        EXPECT_GE(before, 50) << e.err;
        EXPECT_TRUE(seen >= 3 && seen < 60) << seen << " lines:\n" << e.err;
    }
}

TEST_F(Program, ctrl_c_leaves_no_partial_file) {
    // The demo takes a fraction of a second; on a busy machine the signal may come too late, so the test tries again.
    bool cancelled = false;
    for (int attempt = 0; attempt < 20 && !cancelled; ++attempt) {
        const Ended e = run({"demo", "dock", "-o", folder_ / "ring.tact"}, true);
        cancelled = e.code == 130;
        if (!cancelled) {
            ASSERT_EQ(e.code, 0) << e.err;
            ASSERT_NO_THROW((void)SceneFile::open(folder_ / "ring.tact"));
            fs::remove(folder_ / "ring.tact");
        } else {
            EXPECT_NE(e.err.find("cancelled; nothing was written"), std::string::npos) << e.err;
        }
        EXPECT_EQ(entries(), 0U);
    }
    EXPECT_TRUE(cancelled);
}

}  // namespace
}  // namespace tact::prep_cli_test
