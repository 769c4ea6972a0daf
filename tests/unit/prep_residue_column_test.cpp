// The table of residues with a map of local resolutions.
#include <gtest/gtest.h>

#include "prep/export/residue_column.hpp"

namespace tact::prep_residue_column_test {
namespace {

// A map that rises by 1 per angstrom along x: the mean at the atoms is their mean position.
TEST(LocalResolution, of_a_residue_is_the_mean_at_its_atoms_inside_the_map) {
    DensityGrid map;
    map.size = {9, 5, 5};
    map.spacing_m = Vec3(2e-10, 3e-10, 3e-10);
    map.origin_m = Vec3(-4e-10, -6e-10, -6e-10);
    for (std::size_t i = 0; i < 9 * 25; ++i) map.values.push_back(static_cast<float>(2 * (i % 9)) - 4.0F);
    Structure s;
    s.chain_names = {"A"};
    s.x_m = {1e-10F, 4e-10F, 0.0F, 90e-10F, 95e-10F};
    s.y_m = s.z_m = {0.0F, 1e-10F, 0.0F, 0.0F, 0.0F};
    const std::vector<ResidueFit> fit{{0, 1, 0, 2, 0.5, 0.9}, {0, 2, 2, 2, 0.0, {}}, {0, 3, 4, 1, 0.0, {}}};
    const PlacedStructure placed{&s, {Vec3(3e-10, 0.0, 0.0), Quat::Identity()}};
    const auto local = local_resolutions(map, placed, fit);
    ASSERT_EQ(local.size(), 3U);
    EXPECT_NEAR(*local[0], 5.5, 1e-5);  // atoms at 4 and 7 angstrom
    EXPECT_NEAR(*local[1], 3.0, 1e-5);  // the other one is outside
    EXPECT_FALSE(local[2]);
    EXPECT_EQ(residue_csv(s, fit, local),
              "chain,residue,atoms,density_sigma,correlation,local_resolution_a\nA,1,2,0.5000,0.9000,5.500\n"
              "A,2,2,0.0000,,3.000\nA,3,1,0.0000,,\n");
    EXPECT_EQ(residue_csv(s, fit).find("local"), std::string::npos);
}

}  // namespace
}  // namespace tact::prep_residue_column_test
