// Saving placed structures: round trip through a scene, values from theory, and refused exports.
#include "ipc/scene/file/bake_record.hpp"
#include "prep/cif/cif_document.hpp"
#include "prep/export/export_bodies.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <gemmi/pdb.hpp>
#include <map>
#include <set>
#include <sstream>

#include "ipc/base/random.hpp"
#include "ipc/base/units.hpp"
#include "prep/export/write_structure_file.hpp"
#include "prep/structure/import_structure.hpp"
#include "tests/unit/scene_samples.hpp"

namespace tact::prep_export_test {
namespace {

namespace fs = std::filesystem;
using sample::error_of;

constexpr double kA = kAngstromM;

// Hydrogen, water, alternate locations, ADPs, a ligand, crystal-only records, and two models.
const std::string kPdb =
    "HEADER    TEST                                    01-JAN-00   1ABC              \n"
    "TITLE     A SMALL FILE                                                          \n"
    "REMARK 290 SMTRY1   1  1.000000  0.000000  0.000000        0.00000              \n"
    "REMARK 350 BIOMT1   1  1.000000  0.000000  0.000000        0.00000              \n"
    "HELIX    1   1 GLY A    1  ALA A    2  1                                   2    \n"
    "CRYST1   50.000   60.000   70.000  90.00  95.00  90.00 P 1 21 1      2          \n"
    "SCALE1      0.020000  0.000000  0.001750        0.00000                         \n"
    "MODEL        1                                                                  \n"
    "ATOM      1  N   GLY A   1      11.104   6.134  -6.504  1.00 12.50           N  \n"
    "ANISOU    1  N   GLY A   1     2406   1892   1614    198    519   -328       N  \n"
    "ATOM      2  CA  GLY A   1      11.639   6.071  -5.147  1.00 11.00           C  \n"
    "ATOM      3  HA  GLY A   1      12.000   7.000  -5.000  1.00 11.00           H  \n"
    "ATOM      4  CB AALA A   2A     14.100   8.200  -3.100  0.60 10.00           C  \n"
    "ATOM      5  CB BALA A   2A     14.900   8.900  -3.300  0.40 10.00           C  \n"
    "TER       6      ALA A   2A                                                     \n"
    "ATOM      7  P     G B  -3      20.000 -10.000   4.000  1.00 30.00           P  \n"
    "HETATM    8 ZN    ZN B 301       5.500   4.500   3.500  1.00 20.00          ZN2+\n"
    "HETATM    9  O   HOH B 401       1.000   2.000   3.000  1.00 25.00           O  \n"
    "ENDMDL                                                                          \n"
    "MODEL        2                                                                  \n"
    "ATOM      1  N   GLY A   1      12.104   7.134  -7.504  1.00 12.50           N  \n"
    "ENDMDL                                                                          \n"
    "CONECT    1    2                                                                \n"
    "MASTER        0    0    0    0    0    0    0    0    9    0    0    0          \n"
    "END                                                                             \n";

const std::string kCif =
    "data_TEST\n_entry.id TEST\n_cell.length_a 50.0\n_struct.title 'a small file'\n"
    "loop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
    "_atom_site.label_alt_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.auth_asym_id\n"
    "_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
    "_atom_site.occupancy\n_atom_site.B_iso_or_equiv\n_atom_site.fract_x\n"
    "ATOM 1 N N . GLY A LONG 1 11.104 6.134 -6.504 1.00 12.5 0.2\n"
    "ATOM 2 C CA . GLY A LONG 1 11.639 6.071 -5.147 1.00 11.0 0.2\n"
    "HETATM 3 O \"O5'\" . G B B . -20.5 14.25 9.125 1.00 11.0 0.2\n"
    "loop_\n_atom_site_anisotrop.id\n_atom_site_anisotrop.U[1][1]\n_atom_site_anisotrop.U[2][2]\n"
    "_atom_site_anisotrop.U[3][3]\n_atom_site_anisotrop.U[1][2]\n_atom_site_anisotrop.U[1][3]\n"
    "_atom_site_anisotrop.U[2][3]\n2 0.2406 0.1892 0.1614 0.0198 0.0519 -0.0328\n"
    "loop_\n_atom_type.symbol\nC\nN\nO\n";

class Export : public ::testing::Test {
protected:
    Export() {
        std::string name = (fs::temp_directory_path() / "tact-export-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
    }
    ~Export() override { fs::remove_all(folder_); }

    fs::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    static std::string read(const fs::path& path) {
        std::ostringstream all;
        all << std::ifstream(path, std::ios::binary).rdbuf();
        return all.str();
    }
    // A scene of these files in a non-empty map.
    SceneFile scene(const std::vector<fs::path>& files) const {
        SceneMeta meta = sample::meta();
        meta.body_count = static_cast<std::uint32_t>(files.size());
        DensityGrid grid;
        grid.size = {24, 24, 24};
        grid.origin_m = Vec3::Constant(-36.0 * kA);
        grid.spacing_m = Vec3::Constant(3.0 * kA);
        for (std::size_t i = 0; i < grid.count(); ++i)
            grid.values.push_back(std::sin(0.01F * static_cast<float>(i)));
        std::string note = "map: sample\n";
        SceneWriter out;
        for (std::uint32_t i = 0; i < files.size(); ++i) {
            write_structure(out, i, import_structure(files[i]).structure);
            write_codebook(out, i, {});
            note += "structure: " + files[i].string() + "\nstructure check: " + file_mark(files[i]) + "\n";
        }
        write_meta(out, meta, note);
        write_grid(out, grid);
        out.write(folder_ / "scene.tact");
        return SceneFile::open(folder_ / "scene.tact");
    }
    [[nodiscard]] fs::path out() const { return folder_ / "out"; }

    fs::path folder_;
};

Pose tilted() { return {Vec3(3.0, -4.0, 5.0) * kA, quat_from_rotation_vector(Vec3(0.7, -0.4, 1.1))}; }

void expect_same_place(const Structure& saved, const Structure& original, const Pose& pose) {
    ASSERT_EQ(saved.size(), original.size());
    for (std::size_t i = 0; i < saved.size(); ++i) {
        const auto point = [i](const Structure& s) {
            return Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                        static_cast<double>(s.z_m[i]));
        };
        const Vec3 apart = saved.home() * point(saved) - pose * point(original);
        EXPECT_LT(apart.cwiseAbs().maxCoeff(), 0.001 * kA);
        EXPECT_EQ(saved.element[i], original.element[i]);
        EXPECT_EQ(saved.residue[i], original.residue[i]);
        EXPECT_EQ(saved.chain_names[saved.chain[i]], original.chain_names[original.chain[i]]);
    }
}

TEST(AtomMove, rotates_adps_as_in_theory) {
    // A rotation by 90 degrees about z maps x to y and y to -x.
    AtomMove quarter;
    quarter.turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    const Adp u{0.1, 0.2, 0.3, 0.01, 0.02, 0.03};
    const Adp expected{0.2, 0.1, 0.3, -0.01, -0.03, 0.02};
    const Adp turned = quarter.turned(u);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(turned[k], expected[k], 1e-12);
    // The mean square displacement along a direction that rotates with the body is invariant: n^T U n.
    SeededRandom random(5);
    for (int trial = 0; trial < 20; ++trial) {
        AtomMove move;
        move.turn = random.rotation().toRotationMatrix();
        const Adp v = move.turned(u);
        const auto along = [](const Adp& a, const Vec3& n) {
            return a[0] * n.x() * n.x() + a[1] * n.y() * n.y() + a[2] * n.z() * n.z() +
                   2.0 * (a[3] * n.x() * n.y() + a[4] * n.x() * n.z() + a[5] * n.y() * n.z());
        };
        for (int i = 0; i < 5; ++i) {
            const Vec3 n = random.direction();
            EXPECT_NEAR(along(v, move.turn * n), along(u, n), 1e-12);
        }
    }
}

TEST_F(Export, a_saved_pdb_has_the_pose_of_the_body) {
    const fs::path file = write("small.pdb", kPdb);
    const SceneFile scene = this->scene({file});
    const auto written = export_bodies(scene, {{7, 0, tilted()}}, {.folder = out()});
    EXPECT_EQ(written, (std::vector<fs::path>{out() / "small-body7.pdb", out() / "small-body7.matrix.txt",
                                              out() / "bodies.csv"}));
    expect_same_place(import_structure(written[0]).structure, import_structure(file).structure, tilted());
    EXPECT_EQ(read(file), kPdb);

    // gemmi reads the file and finds every atom at the position given by the matrix.
    const gemmi::Structure before = gemmi::read_pdb_string(kPdb, "before");
    const gemmi::Structure after = gemmi::read_pdb_string(read(written[0]), "after");
    const AtomMove move = AtomMove::of(tilted(), import_structure(file).structure.home_com_model_m);
    ASSERT_EQ(after.models.size(), 2U);
    std::size_t atoms = 0;
    for (std::size_t m = 0; m < 2; ++m) {
        ASSERT_EQ(after.models[m].chains.size(), before.models[m].chains.size());
        for (std::size_t c = 0; c < after.models[m].chains.size(); ++c) {
            const gemmi::Chain &a = after.models[m].chains[c], &b = before.models[m].chains[c];
            ASSERT_EQ(a.residues.size(), b.residues.size());
            for (std::size_t r = 0; r < a.residues.size(); ++r) {
                EXPECT_EQ(a.residues[r].name, b.residues[r].name);
                for (std::size_t i = 0; i < a.residues[r].atoms.size(); ++i, ++atoms) {
                    const gemmi::Atom &x = a.residues[r].atoms[i], &y = b.residues[r].atoms[i];
                    EXPECT_EQ(x.name, y.name);
                    EXPECT_EQ(x.altloc, y.altloc);
                    EXPECT_EQ(x.charge, y.charge);
                    EXPECT_EQ(x.b_iso, y.b_iso);
                    const Vec3 there = move * Vec3(y.pos.x, y.pos.y, y.pos.z);
                    EXPECT_LT((Vec3(x.pos.x, x.pos.y, x.pos.z) - there).cwiseAbs().maxCoeff(), 0.00051);
                    EXPECT_EQ(x.aniso.nonzero(), y.aniso.nonzero());
                    const Adp u = move.turned(
                        {y.aniso.u11, y.aniso.u22, y.aniso.u33, y.aniso.u12, y.aniso.u13, y.aniso.u23});
                    EXPECT_NEAR(x.aniso.u11, u[0], 6e-5);
                    EXPECT_NEAR(x.aniso.u13, u[4], 6e-5);
                    EXPECT_NEAR(x.aniso.u23, u[5], 6e-5);
                }
            }
        }
    }
    EXPECT_EQ(atoms, 9U);

    const std::string text = read(written[0]);
    for (const char* gone : {"BIOMT1", "SMTRY1", "SCALE1", "MASTER", "50.000   60.000"})
        EXPECT_EQ(text.find(gone), std::string::npos) << gone;
    for (const char* kept : {"HELIX ", "CONECT", "A SMALL FILE", "HOH B 401", "correlation_about_zero",
                             "CRYST1    1.000", "angle_deg"})
        EXPECT_NE(text.find(kept), std::string::npos) << kept;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U);
}

TEST_F(Export, the_fraction_inside_refers_to_the_contour_that_was_asked_for) {
    const fs::path file = write("small.pdb", kPdb);
    const SceneFile scene = this->scene({file});
    const auto saved = [&](std::optional<double> contour) {
        ExportOptions options{.folder = out()};
        options.force = true;
        options.contour = contour;
        return read(export_bodies(scene, {{7, 0, tilted()}}, options)[0]);
    };
    char line[64];
    std::snprintf(line, sizeof line, "contour: %.6g", read_meta(scene).contour);
    EXPECT_NE(saved({}).find(line), std::string::npos);
    const std::string above = saved(1e6), below = saved(-1e6);
    EXPECT_NE(above.find("contour: 1e+06"), std::string::npos);
    EXPECT_NE(above.find("fraction_inside_contour: 0.0000"), std::string::npos);
    EXPECT_NE(below.find("fraction_inside_contour: 1.0000"), std::string::npos);
}

// Atoms of a residue have its correlation, with the digits of the table; waters none.
TEST_F(Export, the_fit_of_residues_is_a_table_and_fills_the_b_column_if_asked) {
    for (const bool mmcif : {false, true}) {
        const fs::path file = mmcif ? write("small.cif", kCif) : write("small.pdb", kPdb);
        const SceneFile scene = this->scene({file});
        ExportOptions options{.folder = out()};
        options.force = true;
        options.residues = 1;
        const auto kept = export_bodies(scene, {{7, 0, tilted()}}, options);
        const auto atoms_of = [&](const fs::path& path) {
            return mmcif ? mmcif_atoms(read(path), "saved") : pdb_atoms(read(path), "saved");
        };
        EXPECT_NEAR(atoms_of(kept[0])[1].b_iso, 11.0, 1e-9);
        ASSERT_EQ(kept[2].filename(), "small-body7.residues.csv");
        std::map<std::string, double> table;  // "chain,residue"
        std::istringstream lines(read(kept[2]));
        std::string line;
        std::getline(lines, line);
        EXPECT_EQ(line, "chain,residue,atoms,density_sigma,correlation");
        while (std::getline(lines, line)) {
            const std::size_t second = line.find(',', line.find(',') + 1), last = line.rfind(',');
            if (last + 1 < line.size()) table[line.substr(0, second)] = std::stod(line.substr(last + 1));
        }
        ASSERT_FALSE(table.empty());
        options.b_column = true;
        const auto filled = export_bodies(scene, {{7, 0, tilted()}}, options);
        std::size_t with = 0;
        for (const FileAtom& a : atoms_of(filled[0])) {
            if (a.model != 1) continue;
            const auto found = table.find(a.chain + "," + a.residue);
            const bool has = found != table.end();
            EXPECT_NEAR(a.b_iso, has ? found->second : 0.0, 0.0051) << a.name;
            with += has ? 1 : 0;
        }
        EXPECT_GE(with, 2U);
        EXPECT_NE(read(filled[0]).find("b_column"), std::string::npos);
        expect_same_place(import_structure(filled[0]).structure, import_structure(file).structure, tilted());
    }
    const std::string tag = "_atom_site.B_iso_or_equiv";
    std::string none = kCif;
    none.replace(none.find(tag), tag.size(), "_atom_site.other");
    const SceneFile scene = this->scene({write("none.cif", none)});
    ExportOptions options{.folder = out()};
    options.force = true, options.residues = 3, options.b_column = true;
    EXPECT_NE(error_of([&] {
                  export_bodies(scene, {{1, 0, tilted()}}, options);
              }).find("--b-column"),
              std::string::npos);
}

TEST_F(Export, a_saved_mmcif_has_the_pose_of_the_body) {
    const fs::path file = write("small.cif", kCif);
    const SceneFile scene = this->scene({file});
    const auto written = export_bodies(scene, {{1, 0, tilted()}}, {.folder = out()});
    ASSERT_EQ(written[0].filename(), "small-body1.cif");
    expect_same_place(import_structure(written[0]).structure, import_structure(file).structure, tilted());
    const std::string text = read(written[0]);
    CifDocument document = CifDocument::read(text, "written");
    ASSERT_EQ(document.blocks(), 1U);
    const auto rows = [&](const char* tag) { return document.table(0, tag, {""}).rows(); };
    EXPECT_EQ(rows("_cell.length_a"), 0U);
    EXPECT_EQ(rows("_struct.title"), 1U);
    EXPECT_EQ(rows("_tact_fit.correlation_about_mean"), 1U);
    ASSERT_GT(rows("_atom_site.fract_x"), 0U);
    EXPECT_EQ(document.table(0, "_atom_site.fract_x", {""}).raw(0, 0), "?");
    const std::vector<FileAtom> before = mmcif_atoms(kCif, "before"), after = mmcif_atoms(text, "after");
    const AtomMove move = AtomMove::of(tilted(), import_structure(file).structure.home_com_model_m);
    ASSERT_TRUE(after[1].adp_u);
    const Adp u = move.turned(*before[1].adp_u);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR((*after[1].adp_u)[k], u[k], 6e-5);
    EXPECT_FALSE(after[0].adp_u);
    // A second save contains one fit, not two.
    const auto again = export_bodies(this->scene({written[0]}), {{1, 0, tilted()}}, {.folder = out() / "b"});
    const std::string second = read(again[0]);
    EXPECT_EQ(second.find("_tact_fit.body"), second.rfind("_tact_fit.body"));
}

TEST_F(Export, saved_files_bake_to_a_scene_with_the_same_poses) {
    const SceneFile scene = this->scene({write("small.pdb", kPdb), write("other.cif", kCif)});
    std::vector<PlacedBody> bodies{{1, 0, tilted()}, {2, 1, tilted().inverse()}, {5, 0, Pose{}}};
    const auto written = export_bodies(scene, bodies, {.folder = out()});
    ASSERT_EQ(written.size(), 7U);
    const SceneFile fresh = this->scene({written[0], written[2], written[4]});
    for (std::uint32_t i = 0; i < 3; ++i) {
        const Structure before = read_structure(scene, bodies[i].structure), after = read_structure(fresh, i);
        expect_same_place(after, before, bodies[i].T_model_body);
        EXPECT_LT((after.home_com_model_m - bodies[i].T_model_body.p_m).norm(), 0.001 * kA);
    }
}

TEST_F(Export, matrix_axis_and_angle_match_the_pose) {
    const fs::path file = write("small.pdb", kPdb);
    const auto written = export_bodies(scene({file}), {{3, 0, tilted()}}, {.folder = out()});
    std::istringstream text(read(written[1]));
    std::vector<double> m;
    Vec3 axis = Vec3::Zero();
    double angle_deg = 0.0;
    for (std::string line; std::getline(text, line);) {
        std::istringstream words(line);
        std::string first;
        if (line.starts_with("# axis")) words >> first >> first >> axis[0] >> axis[1] >> axis[2];
        if (line.starts_with("# angle_deg")) words >> first >> first >> angle_deg;
        if (line.starts_with("#")) continue;
        for (double v = 0.0; words >> v;) m.push_back(v);
    }
    ASSERT_EQ(m.size(), 12U);
    const Vec3 r(0.7, -0.4, 1.1);
    EXPECT_NEAR(angle_deg, r.norm() / kDegreeRad, 1e-5);
    EXPECT_LT((axis - r.normalized()).norm(), 1e-8);
    const Vec3 atom(11.104, 6.134, -6.504);
    const Structure s = import_structure(file).structure;
    const Vec3 there_a = (tilted() * (atom * kA - s.home_com_model_m)) / kA;
    for (std::size_t row = 0; row < 3; ++row)
        EXPECT_NEAR(
            m[4 * row] * atom.x() + m[4 * row + 1] * atom.y() + m[4 * row + 2] * atom.z() + m[4 * row + 3],
            there_a[static_cast<int>(row)], 1e-5);
    const std::string csv = read(written[2]);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
    const std::string row = csv.substr(csv.find('\n') + 1);
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), std::count(csv.begin(), csv.end(), ',') / 2);
    EXPECT_TRUE(row.starts_with("3,0,\"small.pdb\",\"small-body3.pdb\","));
}

TEST_F(Export, structures_too_large_for_pdb_are_saved_as_mmcif) {
    const fs::path file = write("small.pdb", kPdb);
    const Pose far{Vec3(-5000.0, 0.0, 0.0) * kA, tilted().q};
    const auto written = export_bodies(scene({file}), {{1, 0, far}}, {.folder = out()});
    ASSERT_EQ(written[0].filename(), "small-body1.cif");
    expect_same_place(import_structure(written[0]).structure, import_structure(file).structure, far);
    const std::vector<FileAtom> atoms = mmcif_atoms(read(written[0]), "far");
    ASSERT_EQ(atoms.size(), 9U);
    EXPECT_TRUE(atoms[0].adp_u);
    EXPECT_EQ(atoms[8].model, 2);
}

TEST_F(Export, combined_copies_get_separate_chain_ids) {
    const SceneFile scene = this->scene({write("small.pdb", kPdb)});
    std::vector<PlacedBody> bodies;
    for (std::uint32_t i = 0; i < 6; ++i)
        bodies.push_back({10 + i, 0, {Vec3(20.0 * i, 0.0, 0.0) * kA, tilted().q}});
    auto written = export_bodies(scene, bodies, {.folder = out(), .combined = true});
    ASSERT_EQ(written.size(), 14U);
    EXPECT_EQ(std::set<fs::path>(written.begin(), written.end()).size(), 14U);
    ASSERT_EQ(written.back().filename(), "combined.pdb");
    const Structure all = import_structure(written.back()).structure;
    EXPECT_EQ(all.chain_names.size(), 12U);
    EXPECT_EQ(all.size(), 6 * import_structure(folder_ / "small.pdb").structure.size());
    // Sixty-two letters are too few for 40 copies of two chains.
    while (bodies.size() < 40)
        bodies.push_back({static_cast<std::uint32_t>(100 + bodies.size()), 0, tilted()});
    written = export_bodies(scene, bodies, {.folder = out() / "many", .combined = true});
    ASSERT_EQ(written.back().filename(), "combined.cif");
    const Structure many = import_structure(written.back()).structure;
    EXPECT_EQ(many.chain_names.size(), 80U);
}

TEST_F(Export, files_are_not_overwritten_and_inputs_never) {
    const fs::path file = write("small.pdb", kPdb);
    const SceneFile scene = this->scene({file});
    const std::vector<PlacedBody> bodies{{1, 0, tilted()}};
    const auto written = export_bodies(scene, bodies, {.folder = out()});
    const std::string first = read(written[0]);
    EXPECT_NE(error_of([&] {
                  export_bodies(scene, {{1, 0, Pose{}}}, {.folder = out()});
              }).find("--force"),
              std::string::npos);
    EXPECT_EQ(read(written[0]), first);
    export_bodies(scene, {{1, 0, Pose{}}}, {.folder = out(), .force = true});
    EXPECT_NE(read(written[0]), first);
    // A target that is an alias of the input.
    fs::create_directory(folder_ / "trap");
    fs::create_symlink(file, folder_ / "trap" / "small-body1.pdb");
    EXPECT_NE(error_of([&] {
                  export_bodies(scene, bodies, {.folder = folder_ / "trap", .force = true});
              }).find("from which the scene was baked"),
              std::string::npos);
    EXPECT_EQ(read(file), kPdb);
    EXPECT_NE(error_of([&] { export_bodies(scene, bodies, {.folder = file / "x"}); }), "");
}

TEST_F(Export, a_missing_or_changed_source_is_reported) {
    const fs::path file = write("small.pdb", kPdb);
    const SceneFile scene = this->scene({file});
    const std::vector<PlacedBody> bodies{{1, 0, tilted()}};
    std::string other = kPdb;
    other[other.find("11.104")] = '2';
    write("small.pdb", other);
    EXPECT_NE(error_of([&] { export_bodies(scene, bodies, {.folder = out()}); }).find("has changed"),
              std::string::npos);
    fs::remove(file);
    EXPECT_NE(error_of([&] { export_bodies(scene, bodies, {.folder = out()}); }).find("does not exist"),
              std::string::npos);
    EXPECT_FALSE(fs::exists(out()));
    sample::scene().write(folder_ / "made.tact");
    EXPECT_NE(error_of([&] {
                  export_bodies(SceneFile::open(folder_ / "made.tact"), bodies, {.folder = out()});
              }).find("is synthetic"),
              std::string::npos);
}

TEST_F(Export, damaged_files_are_refused) {
    for (const char* bad : {"ATOM      1  N   GLY A   1      11.1x4   6.134  -6.504\n",
                            "ATOM      1  N   GLY A   1      11.104   6.134\n",
                            "ATOM      1  N   GLY A   1         nan   6.134  -6.504\n"})
        EXPECT_FALSE(error_of([&] { (void)moved_pdb(bad, "bad.pdb", {}, {}); }).empty()) << bad;
    EXPECT_FALSE(error_of([&] { (void)moved_mmcif("loop_ _a", "bad.cif", {}, {}); }).empty());
}

}  // namespace
}  // namespace tact::prep_export_test
