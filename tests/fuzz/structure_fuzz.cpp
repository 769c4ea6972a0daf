// Structures from anywhere. The first byte selects the format. An accepted structure is consistent and has finite
// numbers.
#include <cmath>
#include <string>

#include "prep/structure/import_structure.hpp"
#include "tests/fuzz/format_fuzz.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::fuzz {
namespace {

enum Kind : unsigned char { kPdb, kCif, kKinds };

void use(const Structure& s) {
    require(s.size() > 0 && s.y_m.size() == s.size() && s.mass_fraction.size() == s.size());
    require(s.mass_u > 0.0 && s.home_com_model_m.allFinite());
    for (std::size_t i = 0; i < s.size(); ++i) {
        require(std::isfinite(s.x_m[i]) && std::isfinite(s.y_m[i]) && std::isfinite(s.z_m[i]));
        require(s.chain[i] < s.chain_names.size());
    }
}

}  // namespace

bool run(std::span<const std::byte> input) {
    return run_formats(input, kKinds, [](unsigned kind, std::string_view text) {
        const bool pdb = kind == kPdb;
        use(import_structure_bytes({text.data(), text.size()}, pdb ? "fuzz.pdb" : "fuzz.cif",
                                   pdb ? ".pdb" : ".cif")
                .structure);
    });
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    all.push_back(seed(kPdb, sample::pdb_atom(" CA ", "ALA", 'A', 1, 1.0, 2.0, 3.0) +
                                 sample::pdb_atom(" P  ", " DA", 'B', -2, 10.0, 10.0, 10.0) + "TER\nEND\n"));
    all.push_back(
        seed(kCif,
             "data_x\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n"
             "_atom_site.label_atom_id\n_atom_site.label_alt_id\n_atom_site.label_comp_id\n"
             "_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n"
             "_atom_site.Cartn_z\n_atom_site.occupancy\n_atom_site.B_iso_or_equiv\n"
             "_atom_site.auth_seq_id\n_atom_site.auth_asym_id\n_atom_site.pdbx_PDB_model_num\n"
             "ATOM 1 C CA . ALA A 1 1.0 2.0 3.0 1.0 10.0 1 A 1\n"
             "ATOM 2 N N . GLY A 2 4.0 5.0 6.0 1.0 10.0 2 A 1\n"));
    return all;
}

}  // namespace tact::fuzz
