// Structure files and body poses from anywhere, as saving reads them. The first byte selects the format. An accepted
// structure is written with every atom transformed by the motion, and can be read again.
#include <cmath>
#include <string>

#include "prep/export/poses_file.hpp"
#include "prep/export/write_structure_file.hpp"
#include "tests/fuzz/format_fuzz.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::fuzz {
namespace {

enum Kind : unsigned char { kPdb, kCif, kPoses, kKinds };

AtomMove motion() {
    return AtomMove::of({Vec3(1e-9, -2e-9, 3e-9), quat_from_rotation_vector(Vec3(0.3, -0.5, 0.7))},
                        Vec3(0.5e-9, 0.0, 0.0));
}

void same_places(const std::vector<FileAtom>& before, const std::vector<FileAtom>& after) {
    require(before.size() == after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 apart = after[i].place_a - motion() * before[i].place_a;
        require(apart.cwiseAbs().maxCoeff() < 0.00051);
        require(before[i].adp_u.has_value() == after[i].adp_u.has_value());
    }
}

void save_pdb(std::string_view text) {
    const auto moved = moved_pdb(text, "fuzz.pdb", motion(), {{"key", "value"}});
    if (moved) same_places(pdb_atoms(text, "fuzz.pdb"), pdb_atoms(*moved, "moved.pdb"));
    std::vector<FileAtom> atoms = pdb_atoms(text, "fuzz.pdb");
    static_cast<void>(new_pdb(atoms, {}));
    static_cast<void>(new_mmcif(atoms, "fuzz", {}));
}

void save_mmcif(std::string_view text) {
    const std::string moved = moved_mmcif(text, "fuzz.cif", motion(), {{"key", "value"}});
    same_places(mmcif_atoms(text, "fuzz.cif"), mmcif_atoms(moved, "moved.cif"));
}

}  // namespace

bool run(std::span<const std::byte> input) {
    return run_formats(input, kKinds, [](unsigned kind, std::string_view text) {
        if (kind == kPdb) return save_pdb(text);
        if (kind == kCif) return save_mmcif(text);
        for (const PlacedBody& b : read_poses(text, "fuzz.json", 3)) {
            require(b.structure < 3 && b.T_model_body.finite());
            require(std::abs(b.T_model_body.q.norm() - 1.0) < 1e-9);
        }
    });
}

std::vector<Input> seeds() {
    return {
        seed(kPdb, "HEADER    X\n" + sample::pdb_atom(" CA ", "ALA", 'A', 1, 1.0, 2.0, 3.0) +
                       "ANISOU    1  CA  ALA A   1     2406   1892   1614    198    519   -328       C\n" +
                       sample::pdb_atom(" P  ", " DA", 'B', -2, 10.0, 10.0, 10.0) + "TER\nEND\n"),
        seed(kCif,
             "data_x\n_cell.length_a 5\nloop_\n_atom_site.group_PDB\n_atom_site.id\n"
             "_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_asym_id\n"
             "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
             "ATOM 1 C CA A 1.0 2.0 3.0\nATOM 2 N N A 4.0 5.0 6.0\n"
             "loop_\n_atom_site_anisotrop.id\n_atom_site_anisotrop.U[1][1]\n"
             "_atom_site_anisotrop.U[2][2]\n_atom_site_anisotrop.U[3][3]\n_atom_site_anisotrop.U[1][2]\n"
             "_atom_site_anisotrop.U[1][3]\n_atom_site_anisotrop.U[2][3]\n2 0.2 0.1 0.1 0.01 0.05 -0.03\n"),
        seed(kPoses,
             "{\"bodies\":[{\"id\":1,\"structure\":2,\"pos_model_a\":[1,2,3],"
             "\"quat_model_body_xyzw\":[0,0,0,1]}]}")};
}

}  // namespace tact::fuzz
