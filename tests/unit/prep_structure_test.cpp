// Structures: data kept from PDB and mmCIF files, and refused files.
#include <gtest/gtest.h>

#include <cmath>

#include "prep/structure/import_structure.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::prep_structure_test {
namespace {

using sample::pdb_atom;

Structure pdb(const std::string& text) {
    return import_structure_bytes(text, "folder/a.pdb", ".pdb").structure;
}
Structure cif(const std::string& text) { return import_structure_bytes(text, "a.cif", ".cif").structure; }

Vec3 place_a(const Structure& s, std::size_t i) {
    return (s.home_com_model_m + Vec3(s.x_m[i], s.y_m[i], s.z_m[i])) * 1e10;
}

TEST(PdbStructure, coordinates_masses_chains_and_backbone_are_read) {
    const Structure s =
        pdb(pdb_atom(" N  ", "ALA", 'B', 5, 1.0, 2.0, 3.0) + pdb_atom(" CA ", "ALA", 'B', 5, 4.0, -5.0, 6.5) +
            pdb_atom(" P  ", " DA", 'A', -2, 10.0, 10.0, 10.0) +
            pdb_atom("CA  ", " CA", 'A', 9, 0.0, 0.0, 1.0, 1.0, ' ', "CA", "HETATM"));
    ASSERT_EQ(s.size(), 4U);
    EXPECT_EQ(s.name, "a.pdb");
    EXPECT_NEAR((place_a(s, 0) - Vec3(1, 2, 3)).norm(), 0.0, 1e-4);
    EXPECT_NEAR((place_a(s, 1) - Vec3(4, -5, 6.5)).norm(), 0.0, 1e-4);
    EXPECT_EQ(s.element, (std::vector<std::uint8_t>{7, 6, 15, 20}));
    EXPECT_EQ(s.trace, (std::vector<std::uint8_t>{0, 1, 1, 0})) << "calcium is not a backbone atom";
    EXPECT_EQ(s.residue, (std::vector<std::int32_t>{5, 5, -2, 9}));
    EXPECT_EQ(s.chain_names, (std::vector<std::string>{"B", "A"}));
    EXPECT_EQ(s.chain, (std::vector<std::uint16_t>{0, 0, 1, 1}));
    const double mass = 14.0067 + 12.0107 + 30.973761 + 40.078;
    EXPECT_NEAR(s.mass_u, mass, 1e-3);
    EXPECT_NEAR(s.mass_fraction[2], 30.973761 / mass, 1e-6);
    Vec3 com = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) com += s.mass_fraction[i] * Vec3(s.x_m[i], s.y_m[i], s.z_m[i]);
    EXPECT_LT(com.norm(), 1e-16) << "the body's origin is its centre of mass";
}

TEST(PdbStructure, hydrogens_waters_alternates_and_later_models_are_dropped) {
    const std::string text =
        "MODEL        1\n" + pdb_atom(" CA ", "SER", 'A', 1, 1, 0, 0, 0.4, 'A') +
        pdb_atom(" CA ", "SER", 'A', 1, 2, 0, 0, 0.6, 'B') +
        pdb_atom(" CB ", "SER", 'A', 1, 3, 0, 0, 0.5, 'A') +
        pdb_atom(" CB ", "SER", 'A', 1, 4, 0, 0, 0.5, 'B') + pdb_atom(" HA ", "SER", 'A', 1, 5, 0, 0) +
        pdb_atom(" D1 ", "SER", 'A', 1, 5, 0, 0, 1.0, ' ', " D") +
        pdb_atom(" O  ", "HOH", 'A', 2, 6, 0, 0, 1.0, ' ', " O", "HETATM") + "ENDMDL\nMODEL        2\n" +
        pdb_atom(" CA ", "SER", 'A', 1, 9, 9, 9) + "ENDMDL\nEND\n";
    const ImportedStructure in = import_structure_bytes(text, "a.pdb", ".pdb");
    ASSERT_EQ(in.structure.size(), 2U);
    EXPECT_NEAR(place_a(in.structure, 0).x(), 2.0, 1e-4) << "higher occupancy";
    EXPECT_NEAR(place_a(in.structure, 1).x(), 3.0, 1e-4) << "first of equal occupancies";
    EXPECT_EQ(in.summary,
              "2 atoms in 1 chain (A), 1 on the backbone; dropped 2 hydrogens, 1 water atoms, 2 alternate "
              "locations");
}

TEST(PdbStructure, one_residue_of_a_point_mutation_is_kept) {
    const Structure s = pdb(pdb_atom(" CA ", "SER", 'A', 1, 1, 0, 0, 0.4, 'A') +
                            pdb_atom(" OG ", "SER", 'A', 1, 2, 0, 0, 0.4, 'A') +
                            pdb_atom(" CA ", "THR", 'A', 1, 3, 0, 0, 0.6, 'B') +
                            pdb_atom(" OG1", "THR", 'A', 1, 4, 0, 0, 0.6, 'B'));
    ASSERT_EQ(s.size(), 2U);
    EXPECT_NEAR(place_a(s, 0).x(), 3.0, 1e-4);
}

TEST(PdbStructure, blank_chains_and_missing_elements_are_accepted) {
    const Structure s =
        pdb(pdb_atom(" CA ", "ALA", ' ', 1, 1, 2, 3) + pdb_atom(" OXT", "ALA", ' ', 1, 2, 2, 3));
    EXPECT_EQ(s.chain_names, (std::vector<std::string>{""}));
    EXPECT_EQ(s.element, (std::vector<std::uint8_t>{6, 8}));
}

TEST(PdbStructure, an_unknown_element_counts_as_carbon_and_is_reported) {
    const ImportedStructure in =
        import_structure_bytes(pdb_atom(" QQ ", "UNK", 'A', 1, 1, 2, 3, 1.0, ' ', " X"), "a.pdb", ".pdb");
    EXPECT_EQ(in.structure.element[0], 0);
    EXPECT_EQ(in.structure.mass_u, 12.0);
    EXPECT_NE(in.summary.find("1 atoms of unknown element count as carbon"), std::string::npos) << in.summary;
}

constexpr char kLoop[] =
    "data_x\nloop_\n_atom_site.group_PDB\n_atom_site.type_symbol\n_atom_site.auth_atom_id\n_atom_site.label_"
    "alt_id\n"
    "_atom_site.auth_comp_id\n_atom_site.auth_asym_id\n_atom_site.auth_seq_id\n_atom_site.pdbx_PDB_ins_code\n"
    "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.occupancy\n_atom_site.pdbx_PDB_"
    "model_num\n";

TEST(MmcifStructure, is_read_like_pdb) {
    const Structure s = cif(std::string(kLoop) +
                            "ATOM C CA . ALA AAA 1 ? 1.5 2.5 -3.5 1.0 1\nATOM C CB A ALA AAA 1 ? 2 0 0 0.3 "
                            "1\nATOM C CB B ALA AAA 1 ? 3 0 0 0.7 1\n"
                            "ATOM P P . DA B -4 ? 4 0 0 1 1\nHETATM O O . HOH C 1 ? 4 0 0 1 1\nATOM H HA . "
                            "ALA AAA 1 ? 4 0 0 1 1\n"
                            "HETATM Zn ZN . ZN B 2 ? 5 0 0 1 1\nATOM C CA . ALA AAA 1 ? 9 9 9 1.0 2\n");
    ASSERT_EQ(s.size(), 4U);
    EXPECT_EQ(s.chain_names, (std::vector<std::string>{"AAA", "B"}));
    EXPECT_EQ(s.element, (std::vector<std::uint8_t>{6, 6, 15, 30}));
    EXPECT_EQ(s.trace, (std::vector<std::uint8_t>{1, 0, 1, 0}));
    EXPECT_EQ(s.residue, (std::vector<std::int32_t>{1, 1, -4, 2}));
    EXPECT_NEAR((place_a(s, 0) - Vec3(1.5, 2.5, -3.5)).norm(), 0.0, 1e-4);
    EXPECT_NEAR(place_a(s, 1).x(), 3.0, 1e-4);
}

void expect_refused(const std::string& text, const char* ending, const char* place, const char* reason) {
    const std::string name = std::string("bad") + ending;
    const std::string error = sample::error_of([&] { (void)import_structure_bytes(text, name, ending); });
    EXPECT_NE(error.find("read structure " + name), std::string::npos) << reason << ": " << error;
    EXPECT_NE(error.find(place), std::string::npos) << error;
    EXPECT_NE(error.find(reason), std::string::npos) << error;
    EXPECT_NE(error.find("\n  fix: "), std::string::npos) << error;
}

TEST(PdbStructure, bad_files_are_refused_with_the_line) {
    const std::string good = pdb_atom(" CA ", "ALA", 'A', 1, 1, 2, 3);
    expect_refused("", ".pdb", "no atoms", "no atoms");
    expect_refused("REMARK nothing\nEND\n", ".pdb", "no atoms", "no atoms");
    expect_refused(std::string(3000, '\0'), ".pdb", "no atoms", "no atoms");
    expect_refused(pdb_atom(" O  ", "HOH", 'A', 1, 1, 2, 3), ".pdb", "1 water atoms", "no atoms besides");
    expect_refused(good + good.substr(0, 40) + "\n", ".pdb", "line 2", "ends before column 54");
    std::string bad = good;
    bad.replace(38, 8, "********");
    expect_refused("REMARK\n" + good + bad, ".pdb", "line 3", "y '********' is not a number");
    bad.replace(38, 8, "     nan");
    expect_refused(bad, ".pdb", "line 1", "y 'nan' is not a number");
    bad.replace(38, 8, "        ");
    expect_refused(bad, ".pdb", "line 1", "y '' is not a number");
    bad.replace(38, 8, "   1e300");
    expect_refused(bad, ".pdb", "line 1", "more than 100000");
    bad.replace(38, 8, " 99000.0");
    expect_refused(good + bad, ".pdb", "residue 1", "from the centre of mass");
    expect_refused("x", ".xyz", "'.xyz'", "not that of a structure");
}

TEST(MmcifStructure, invalid_files_are_refused_with_the_row) {
    expect_refused("", ".cif", "no atoms", "no atoms");
    expect_refused("data_x\n_cell.length_a 5\n", ".cif", "no atoms", "no atoms");
    expect_refused("loop_ _a _b 1 2 3\n", ".cif", "bad.cif", "read structure");
    const std::string good = "ATOM C CA . ALA A 1 ? 1.5 2.5 -3.5 1.0 1\n";
    expect_refused(kLoop + good + "ATOM C CA . ALA A 2 ? 1.5 ? -3.5 1.0 1\n", ".cif", "atom_site row 2",
                   "Cartn_y '?' is not a number");
    expect_refused(kLoop + good + "ATOM C CA . ALA A 2 ? 1.5 2 inf 1.0 1\n", ".cif", "atom_site row 2",
                   "Cartn_z 'inf' is not a number");
    expect_refused(kLoop + good + "ATOM C CA . ALA A two ? 1.5 2 3 1.0 1\n", ".cif", "atom_site row 2",
                   "residue number 'two'");
    expect_refused(kLoop + good + "ATOM C CA .\n", ".cif", "bad.cif", "read structure");
}

}  // namespace
}  // namespace tact::prep_structure_test
