// The importers on published maps and matching structures. An independent program computed the mean map value at the
// CA (and P) atoms of each pair; it matches only if origin, voxel size, axis order, byte order and coordinates are
// right.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prep/map/import_map.hpp"
#include "prep/map/map_statistics.hpp"
#include "prep/structure/import_structure.hpp"
#include "tests/unit/prep_samples.hpp"

namespace tact::prep_real_files_test {
namespace {

double trilinear(const DensityGrid& g, const Vec3& p_m) {
    const Vec3 index = (p_m - g.origin_m).cwiseQuotient(g.spacing_m);
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        std::uint32_t i[3];
        double w = 1.0;
        for (int a = 0; a < 3; ++a) {
            const double low = std::floor(index[a]), t = index[a] - low;
            const double at = low + (c >> a & 1);
            if (at < 0.0 || at >= g.size[static_cast<std::size_t>(a)]) return 0.0;
            i[a] = static_cast<std::uint32_t>(at);
            w *= (c >> a & 1) != 0 ? t : 1.0 - t;
        }
        sum += w * static_cast<double>(g.at(i[0], i[1], i[2]));
    }
    return sum;
}

struct Pair {
    const char* map;
    std::vector<const char*> structures;
    std::size_t atoms_on_trace;
    double fit;
};

TEST(RealFiles, map_values_at_the_backbone_match_published_ones) {
    const auto folder = sample::em_folder();
    if (folder.empty()) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    const Pair pairs[] = {
        {"emd_1080_groel_11.5A.mrc", {"1kp8A_fitted_in_emd_1080.pdb"}, 525, 1.328},
        {"emd_5168_factin.map", {"3MFP.pdb"}, 369, 12.32},
        {"emd_5168_factin.map", {"1J6Z_fitted_in_emd_5168.pdb"}, 368, 10.13},
        {"emd_5778_monomer.situs.gz", {"emd_5778_native.pdb"}, 311, 14.16},
        {"emd_5925_monomer.situs.gz", {"emd_5925_native.pdb"}, 97, 0.667},
        {"sim_1oel_10A.mrc", {"1oel.pdb.gz"}, 3668, 238.2},
        {"sim_1z5s_20A.mrc", {"sim_1z5s.pdb"}, 455, 0.316},
        {"sim_1gte_A_20A.mrc",
         {"sim_1gte_d1.pdb", "sim_1gte_d2.pdb", "sim_1gte_d3.pdb", "sim_1gte_d4.pdb", "sim_1gte_d5.pdb"},
         1005,
         1306.0},
        {"sim_2dqj_10A.mrc", {"sim_2dqj.pdb"}, 350, 3.249},
        {"sim_1akeA_10A.mrc", {"sim_1akeA.pdb"}, 213, 0.335},
    };
    for (const Pair& pair : pairs) {
        SCOPED_TRACE(pair.map);
        const ImportedMap map = import_map(folder / pair.map);
        const double contour = choose_contour(map.grid, map_statistics(map.grid)).level;
        double sum = 0.0;
        std::size_t count = 0, inside = 0;
        for (const char* name : pair.structures) {
            const Structure s = import_structure(folder / name).structure;
            for (std::size_t i = 0; i < s.size(); ++i) {
                if (s.trace[i] == 0) continue;
                const double value =
                    trilinear(map.grid, s.home_com_model_m + Vec3(s.x_m[i], s.y_m[i], s.z_m[i]));
                sum += value;
                ++count;
                if (value > contour) ++inside;
            }
        }
        EXPECT_EQ(count, pair.atoms_on_trace);
        EXPECT_NEAR(sum / static_cast<double>(count), pair.fit, 0.01 * pair.fit);
        // The chosen contour contains the structure (measured: 0.69 for the foreign actin, otherwise 0.8 to 1.0) and little
        // else (1 to 17 % of the box).
        EXPECT_GT(static_cast<double>(inside), 0.65 * static_cast<double>(count));
        const auto voxels = std::count_if(map.grid.values.begin(), map.grid.values.end(),
                                          [&](float v) { return v > contour; });
        EXPECT_LT(static_cast<double>(voxels), 0.2 * static_cast<double>(map.grid.count()));
    }
}

TEST(RealFiles, sizes_voxels_origins_and_rules_match_the_documentation) {
    const auto folder = sample::em_folder();
    if (folder.empty()) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    struct Row {
        const char* map;
        std::array<std::uint32_t, 3> size;
        Vec3 voxel_a, origin_a;
        const char* rule;
    };
    const Row rows[] = {
        {"emd_1080_groel_11.5A.mrc", {100, 100, 100}, Vec3::Constant(2.7), Vec3::Constant(-135.0), "NSTART"},
        {"emd_5168_factin.map", {100, 100, 100}, Vec3::Constant(1.742), Vec3::Constant(-87.1), "NSTART"},
        {"emd_5778_monomer.situs.gz",
         {70, 97, 97},
         Vec3::Constant(1.2156),
         Vec3(-49.84, -74.15, -71.72),
         "Situs"},
        {"emd_5925_monomer.situs.gz", {71, 68, 68}, Vec3::Constant(1.1), Vec3(30.8, 26.4, 4.4), "Situs"},
        {"sim_1oel_10A.mrc", {116, 114, 69}, Vec3::Constant(1.5), Vec3(-130.5, -84.0, -87.0), "ORIGIN"},
        {"sim_1z5s_20A.mrc", {70, 72, 63}, Vec3::Constant(3.0), Vec3(-17.38, -41.49, -143.59), "is ignored"},
        {"sim_1gte_A_20A.mrc", {50, 45, 53}, Vec3::Constant(3.0), Vec3(0.0, -6.0, -3.0), "ORIGIN"},
        {"sim_2dqj_10A.mrc", {26, 25, 23}, Vec3::Constant(3.5), Vec3(-8.61, -8.08, -23.11), "is ignored"},
        {"sim_1akeA_10A.mrc", {22, 22, 22}, Vec3::Constant(3.0), Vec3(-6.49, 13.38, -5.41), "ORIGIN"},
        {"format_EMD-3197.map", {20, 20, 20}, Vec3::Constant(11.4), Vec3(-22.8, 0.0, 0.0), "NSTART"},
    };
    for (const Row& row : rows) {
        SCOPED_TRACE(row.map);
        const ImportedMap map = import_map(folder / row.map);
        EXPECT_EQ(map.grid.size, row.size);
        EXPECT_LT((map.grid.spacing_m * 1e10 - row.voxel_a).norm(), 1e-3) << map.grid.spacing_m.transpose();
        EXPECT_LT((map.grid.origin_m * 1e10 - row.origin_a).norm(), 0.02) << map.grid.origin_m.transpose();
        EXPECT_NE(map.origin_rule.find(row.rule), std::string::npos) << map.origin_rule;
    }
    // Monoclinic, axis order 3, 1, 2, with symmetry records: resampled to right angles.
    const ImportedMap skew = import_map(folder / "format_EMD-3001.map");
    EXPECT_NE(skew.notes.at(0).find("94.326"), std::string::npos) << skew.notes[0];
    EXPECT_GE(skew.grid.size[0], 43U);
    EXPECT_GE(skew.grid.size[2], 73U);
}

TEST(RealFiles, structures_of_all_kinds_are_read) {
    const auto folder = sample::em_folder();
    if (folder.empty()) GTEST_SKIP() << "the folder of real data is absent (set TACT_SHARED)";
    const Structure ring = import_structure(folder / "1oel.pdb.gz").structure;
    EXPECT_EQ(ring.chain_names, (std::vector<std::string>{"A", "B", "C", "D", "E", "F", "G"}));
    const Structure blank = import_structure(folder / "sim_1akeA.pdb").structure;
    EXPECT_EQ(blank.chain_names, (std::vector<std::string>{""}));
    EXPECT_GT(import_structure(folder / "1a6d_thermosome.pdb.gz").structure.size(), 5000U);
}

}  // namespace
}  // namespace tact::prep_real_files_test
