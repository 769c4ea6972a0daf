// Saving a body that is bent along its normal modes: its places, its bonds, and what is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include "ipc/base/units.hpp"
#include "ipc/scene/file/bake_record.hpp"
#include "prep/export/bent_places.hpp"
#include "prep/export/export_bodies.hpp"
#include "prep/modes/elastic_network.hpp"
#include "prep/structure/import_structure.hpp"
#include "prep/synthetic/ring.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::prep_bent_test {
namespace {

namespace fs = std::filesystem;
using sample::error_of;

constexpr double kA = kAngstromM;

// The subunit of the ring as a PDB file, with a water far from it.
std::string subunit_pdb() {
    const Structure s = make_ring().subunits.front();
    std::string text;
    char line[128];
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p =
            (s.home_com_model_m + Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>()) / kA;
        const char* const element = s.element[i] == 7 ? "N" : s.element[i] == 8 ? "O" : "C";
        std::snprintf(line, sizeof line,
                      "ATOM  %5zu  %-3s ALA A%4d    %8.3f%8.3f%8.3f  1.00 10.00          %2s  \n", i + 1,
                      s.trace[i] != 0 ? "CA" : element, s.residue[i], p.x(), p.y(), p.z(), element);
        text += line;
    }
    return text + "HETATM 9999  O   HOH A 999       1.000   2.000   3.000  1.00 25.00           O  \nEND\n";
}

class Bent : public testing::Test {
protected:
    Bent() {
        std::string name = (fs::temp_directory_path() / "tact-bent-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
        std::ofstream(folder_ / "unit.pdb") << text_;
        structure_ = import_structure(folder_ / "unit.pdb").structure;
        modes_ = elastic_modes(structure_, 8);
        // 4 Å along the three softest modes.
        amplitude_m_ = {static_cast<float>(3.0 * kA), static_cast<float>(-2.0 * kA),
                        static_cast<float>(std::sqrt(3.0) * kA)};
    }
    ~Bent() override { fs::remove_all(folder_); }

    [[nodiscard]] SceneFile scene(bool with_modes) const {
        SceneMeta meta = sample::meta();
        meta.body_count = 1;
        DensityGrid grid;
        grid.size = {24, 24, 24};
        grid.origin_m = Vec3::Constant(-36.0 * kA);
        grid.spacing_m = Vec3::Constant(3.0 * kA);
        for (std::size_t i = 0; i < grid.count(); ++i)
            grid.values.push_back(std::sin(0.01F * static_cast<float>(i)));
        const fs::path file = folder_ / "unit.pdb";
        SceneWriter out;
        write_structure(out, 0, structure_);
        write_codebook(out, 0, {});
        if (with_modes) write_modes(out, 0, modes_);
        write_meta(
            out, meta,
            "map: sample\nstructure: " + file.string() + "\nstructure check: " + file_mark(file) + "\n");
        write_grid(out, grid);
        out.write(folder_ / "scene.tact");
        return SceneFile::open(folder_ / "scene.tact");
    }

    std::string text_ = subunit_pdb();
    fs::path folder_;
    Structure structure_;
    NormalModes modes_;
    std::vector<float> amplitude_m_;
};

TEST_F(Bent, atoms_follow_the_modes_and_keep_the_bonds_of_the_file) {
    const std::vector<FileAtom> atoms = pdb_atoms(text_, "unit.pdb");
    const BentPlaces bent = bent_places(atoms, structure_, modes_, amplitude_m_);
    ASSERT_EQ(bent.at_a.size(), atoms.size());
    // Every pair of heavy atoms at bonding distance, found here pair by pair.
    std::size_t bonds = 0;
    double most = 0.0, from_modes_2 = 0.0, from_file_2 = 0.0;
    for (std::size_t i = 0; i + 1 < atoms.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double length = (atoms[i].place_a - atoms[j].place_a).norm();
            if (length < 0.4 || length > 1.75 || std::abs(structure_.residue[i] - structure_.residue[j]) > 1)
                continue;
            ++bonds;
            most = std::max(most, std::abs((bent.at_a[i] - bent.at_a[j]).norm() / length - 1.0));
        }
        const Vec3 by_modes = atoms[i].place_a + modes_.shift_m(modes_.node[i], amplitude_m_) / kA;
        from_modes_2 += (bent.at_a[i] - by_modes).squaredNorm() / static_cast<double>(atoms.size() - 1);
        from_file_2 +=
            (bent.at_a[i] - atoms[i].place_a).squaredNorm() / static_cast<double>(atoms.size() - 1);
    }
    EXPECT_GT(bonds, 400U);
    EXPECT_LT(most, 0.02);
    EXPECT_GT(bent.bond_most_modes, 0.02);  // or nothing had to be brought back
    EXPECT_LT(bent.bond_most, 0.02);
    EXPECT_LT(std::sqrt(from_modes_2), 1.0);
    EXPECT_NEAR(std::sqrt(from_file_2), 4.0, 0.6);
    EXPECT_NEAR(bent.rmsd_a, std::sqrt(from_file_2), 0.1);
    // The water moves with the nearest residue.
    EXPECT_GT((bent.at_a.back() - atoms.back().place_a).norm(), 0.0);
}

TEST_F(Bent, a_saved_body_is_bent_and_says_how_far) {
    const Pose place{Vec3(1.0, -2.0, 3.0) * kA, quat_from_rotation_vector(Vec3(0.2, 0.3, -0.5))};
    const SceneFile file = scene(true);
    const auto saved = export_bodies(file, {{.id = 1, .T_model_body = place, .amplitude_m = amplitude_m_}},
                                     {.folder = folder_ / "out", .combined = true});
    std::ostringstream all;
    all << std::ifstream(saved.front()).rdbuf();
    EXPECT_NE(all.str().find("bent: along 3 normal modes, RMSD to the file"), std::string::npos);
    const BentPlaces bent = bent_places(pdb_atoms(text_, "unit.pdb"), structure_, modes_, amplitude_m_);
    for (const fs::path& path : {saved.front(), folder_ / "out/combined.pdb"}) {
        std::ostringstream text;
        text << std::ifstream(path).rdbuf();
        const std::vector<FileAtom> atoms = pdb_atoms(text.str(), path.string());
        ASSERT_EQ(atoms.size(), bent.at_a.size());
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            const Vec3 at_a = place.q * (bent.at_a[i] - structure_.home_com_model_m / kA) + place.p_m / kA;
            EXPECT_LT((atoms[i].place_a - at_a).norm(), 0.002) << path << ", atom " << i;
        }
    }
    // The fit in the remarks is that of the bent body.
    const auto straight =
        export_bodies(file, {{.id = 1, .T_model_body = place}}, {.folder = folder_ / "straight"});
    const auto row = [](const fs::path& folder) {
        std::ifstream in(folder / "bodies.csv");
        std::string line;
        std::getline(in, line);
        std::getline(in, line);
        return line;
    };
    EXPECT_NE(row(folder_ / "out"), row(folder_ / "straight"));
}

TEST_F(Bent, a_scene_without_the_modes_is_refused) {
    const std::string error = error_of([&] {
        export_bodies(scene(false), {{.id = 7, .T_model_body = {}, .amplitude_m = amplitude_m_}},
                      {.folder = folder_ / "out"});
    });
    EXPECT_NE(error.find("body 7 is bent along 3 modes, and its structure has 0"), std::string::npos)
        << error;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST(PosesFile, amplitudes_are_read_and_checked) {
    const auto read = [](const std::string& amplitudes) {
        return read_poses(
            R"({"bodies": [{"id": 1, "structure": 0, "pos_model_a": [0, 0, 0], "quat_model_body_xyzw": [0, 0, 0, 1],
                "mode_amplitudes_a": )" +
                amplitudes + "}]}",
            "test", 1);
    };
    const auto bodies = read("[1.5, -2]");
    ASSERT_EQ(bodies.front().amplitude_m.size(), 2U);
    EXPECT_FLOAT_EQ(bodies.front().amplitude_m[1], -2e-10F);
    EXPECT_TRUE(read("[]").front().amplitude_m.empty());
    std::string many = "[0";
    for (int i = 0; i < 20; ++i) many += ",0";
    for (const std::string& bad :
         {std::string("3"), std::string("[\"a\"]"), std::string("[1e4]"), many + "]"})
        EXPECT_FALSE(error_of([&] { static_cast<void>(read(bad)); }).empty()) << bad;
}

}  // namespace
}  // namespace tact::prep_bent_test
