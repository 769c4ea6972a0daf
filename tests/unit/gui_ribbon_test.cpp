// Secondary structure from C-alpha atoms, and the ribbons drawn of it.
//
// Independent: HELIX and SHEET records that depositors wrote into files of ../shared/data, read here.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>

#include "gui/render/ribbon.hpp"

namespace tact::gui_ribbon_test {
namespace {

using Eigen::Vector3f;
using Chain = std::vector<Vector3f>;

// n residues with rise and turn per residue on a cylinder.
Chain screw(int n, float radius_a, float rise_a, float turn_deg) {
    Chain c;
    for (int i = 0; i < n; ++i) {
        const float a = turn_deg * static_cast<float>(i) * std::numbers::pi_v<float> / 180.0F;
        c.emplace_back(radius_a * std::cos(a), radius_a * std::sin(a), rise_a * static_cast<float>(i));
    }
    return c;
}
Chain alpha(int n) { return screw(n, 2.3F, 1.5F, 100.0F); }
Chain beta(int n) { return screw(n, 0.9F, 3.35F, 180.0F); }

std::size_t count(const std::vector<Fold>& folds, Fold of) {
    return static_cast<std::size_t>(std::count(folds.begin(), folds.end(), of));
}

TEST(SecondaryStructure, an_ideal_helix_and_an_ideal_strand_are_found) {
    EXPECT_GE(count(folds_of({alpha(20)})[0], Fold::helix), 17U);
    EXPECT_EQ(count(folds_of({alpha(20)})[0], Fold::strand), 0U);
    EXPECT_GE(count(folds_of({beta(10)})[0], Fold::strand), 7U);
    EXPECT_EQ(count(folds_of({beta(10)})[0], Fold::helix), 0U);
    EXPECT_EQ(count(folds_of({screw(20, 8.0F, 1.0F, 27.0F)})[0], Fold::coil), 20U);  // a wide coil
}

TEST(SecondaryStructure, a_left_handed_helix_is_none) {
    EXPECT_EQ(count(folds_of({screw(20, 2.3F, 1.5F, -100.0F)})[0], Fold::helix), 0U);
    Chain mirrored = alpha(4);
    EXPECT_EQ(count(folds_of({mirrored})[0], Fold::helix), 0U);  // shorter than a turn and a half
}

TEST(SecondaryStructure, a_short_strand_needs_a_neighbour) {
    Chain one = beta(7), other = beta(7);
    for (Vector3f& at : other) at.y() += 4.8F;
    const std::size_t alone = count(folds_of({one})[0], Fold::strand),
                      paired = count(folds_of({one, other})[0], Fold::strand);
    EXPECT_EQ(alone, 0U);
    EXPECT_GE(paired, 3U);
}

TEST(SecondaryStructure, fits_any_input) {
    EXPECT_TRUE(folds_of(std::vector<Chain>{}).empty());
    EXPECT_EQ(folds_of({Chain{}, Chain{Vector3f::Zero()}, Chain(50, Vector3f::Zero())})[2],
              std::vector<Fold>(50, Fold::coil));
    EXPECT_EQ(folds_of({Chain(50, Vector3f::Constant(NAN))})[0].size(), 50U);
}

struct Deposited {
    std::vector<Chain> chains;
    std::vector<std::vector<Fold>> folds;
};

Deposited read_pdb(const std::filesystem::path& path) {
    Deposited all;
    std::map<std::pair<char, int>, Fold> record;
    std::vector<std::pair<char, int>> residue;
    gzFile in = gzopen(path.c_str(), "rb");  // reads plain files too
    char line[256];
    const auto number = [](const std::string& s, std::size_t at, std::size_t n) {
        return std::atoi(s.substr(at, n).c_str());
    };
    while (in != nullptr && gzgets(in, line, sizeof line) != nullptr) {
        std::string s = line;
        if (s.size() < 54) s.resize(54, ' ');
        const auto range = [&](char chain, int from, int to, Fold fold) {
            for (int r = from; r <= to; ++r) record[{chain, r}] = fold;
        };
        if (s.rfind("HELIX", 0) == 0) range(s[19], number(s, 21, 4), number(s, 33, 4), Fold::helix);
        if (s.rfind("SHEET", 0) == 0) range(s[21], number(s, 22, 4), number(s, 33, 4), Fold::strand);
        if (s.rfind("ENDMDL", 0) == 0) break;
        if (s.rfind("ATOM", 0) != 0 || s.substr(12, 4) != " CA " || (s[16] != ' ' && s[16] != 'A')) continue;
        const Vector3f at(std::stof(s.substr(30, 8)), std::stof(s.substr(38, 8)), std::stof(s.substr(46, 8)));
        const std::pair key{s[21], number(s, 22, 4)};
        const bool follows = !residue.empty() && residue.back().first == key.first &&
                             (at - all.chains.back().back()).norm() < 4.5F;
        if (!follows) {
            all.chains.emplace_back();
            all.folds.emplace_back();
        }
        all.chains.back().push_back(at);
        residue.push_back(key);
        const auto found = record.find(key);
        all.folds.back().push_back(found != record.end() ? found->second : Fold::coil);
    }
    if (in != nullptr) gzclose(in);
    return all;
}

// Depositors used hydrogen bonds, which C-alpha atoms alone do not show: the authors of P-SEA found 78 to 80 % of residues equal.
TEST(SecondaryStructure, agrees_with_the_records_of_deposited_files) {
    const char* const shared = std::getenv("TACT_SHARED");
    const std::filesystem::path data =
        std::filesystem::path(shared != nullptr ? shared : "../shared") / "data";
    if (!std::filesystem::exists(data / "em")) GTEST_SKIP() << data << " is absent";
    for (const char* name :
         {"em/1oel.pdb.gz", "em/1J6Z_fitted_in_emd_5168.pdb", "em/sim_1akeA.pdb", "em/sim_2dqj.pdb"}) {
        const Deposited all = read_pdb(data / name);
        const auto folds = folds_of(all.chains);
        std::size_t residues = 0, same = 0, swapped = 0;
        for (std::size_t c = 0; c < folds.size(); ++c)
            for (std::size_t i = 0; i < folds[c].size(); ++i) {
                const Fold was = all.folds[c][i], is = folds[c][i];
                ++residues;
                same += is == was ? 1 : 0;
                swapped += is != was && is != Fold::coil && was != Fold::coil ? 1 : 0;
            }
        std::printf("%s: %zu residues, %.1f %% as deposited, %.1f %% helix for strand or the reverse\n", name,
                    residues, 100.0 * static_cast<double>(same) / static_cast<double>(residues),
                    100.0 * static_cast<double>(swapped) / static_cast<double>(residues));
        EXPECT_GT(residues, 150U) << name;
        EXPECT_GT(static_cast<double>(same), 0.72 * static_cast<double>(residues)) << name;
        EXPECT_LT(swapped, residues / 50) << name;
    }
}

Structure structure_of(const Chain& chain, std::uint8_t element = 6) {
    Structure s;
    s.chain_names = {"A"};
    for (std::size_t i = 0; i < chain.size(); ++i) {
        s.x_m.push_back(1e-10F * chain[i].x());
        s.y_m.push_back(1e-10F * chain[i].y());
        s.z_m.push_back(1e-10F * chain[i].z());
        s.mass_fraction.push_back(1.0F / static_cast<float>(chain.size()));
        s.element.push_back(element);
        s.chain.push_back(0);
        s.residue.push_back(static_cast<std::int32_t>(i));
        s.trace.push_back(1);
    }
    return s;
}

// Extent of the mesh about the curve: the largest distance of a vertex from the nearest trace atom's axis is the half width.
float widest_a(const TubeMesh& mesh, const Vector3f& from, const Vector3f& along) {
    float most = 0.0F;
    for (const TubeVertex& v : mesh.vertex) {
        const Vector3f d = Vector3f(v.position_a[0], v.position_a[1], v.position_a[2]) - from;
        most = std::max(most, (d - along * along.dot(d)).norm());
    }
    return most;
}

TEST(Ribbon, a_strand_is_flat_and_wide_with_an_arrow_and_a_coil_is_thin) {
    const Structure strand = structure_of(beta(12));
    const TubeMesh flat = build_ribbons(strand, folds_of(strand), 100'000);
    EXPECT_GT(widest_a(flat, Vector3f::Zero(), Vector3f::UnitZ()), 1.7F);  // the arrow
    EXPECT_LT(widest_a(flat, Vector3f::Zero(), Vector3f::UnitZ()), 2.6F);
    const std::vector<std::vector<Fold>> coil{std::vector<Fold>(12, Fold::coil)};
    EXPECT_LT(widest_a(build_ribbons(strand, coil, 100'000), Vector3f::Zero(), Vector3f::UnitZ()), 1.5F);
    // Phosphates are no protein, whatever their places.
    const Structure nucleic = structure_of(beta(12), 15);
    EXPECT_EQ(folds_of(nucleic)[0], std::vector<Fold>(12, Fold::coil));
}

// Every edge belongs to two triangles, and all normals are of length one and outward.
TEST(Ribbon, is_a_closed_surface_with_outward_normals) {
    for (const Chain& chain : {alpha(15), beta(15), screw(15, 8.0F, 1.0F, 27.0F), alpha(2), alpha(3)}) {
        const Structure s = structure_of(chain);
        for (const std::size_t most : {100'000U, 200U, 70U}) {
            const TubeMesh mesh = build_ribbons(s, folds_of(s), most);
            std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
            std::size_t outward = 0;
            for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
                Vector3f p[3], n = Vector3f::Zero();
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::uint32_t a = mesh.index[t + k], b = mesh.index[t + (k + 1) % 3];
                    ASSERT_LT(a, mesh.vertex.size());
                    edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
                    const TubeVertex& v = mesh.vertex[a];
                    p[k] = Vector3f(v.position_a[0], v.position_a[1], v.position_a[2]);
                    const Vector3f of(v.normal[0], v.normal[1], v.normal[2]);
                    EXPECT_NEAR(of.norm(), 1.0F, 1e-4F);
                    n += of;
                }
                outward += (p[1] - p[0]).cross(p[2] - p[0]).dot(n) > 0.0F ? 1 : 0;
            }
            for (const auto& [edge, sum] : edges) EXPECT_EQ(sum, 0);
            EXPECT_GT(outward, mesh.index.size() / 3 * 9 / 10);
        }
    }
}

TEST(Ribbon, fewer_vertices_are_allowed_and_kept) {
    const Structure s = structure_of(alpha(200));
    const auto folds = folds_of(s);
    std::size_t before = 1'000'000;
    for (const std::size_t most : {14'000U, 9'000U, 5'000U, 3'000U, 1'000U, 300U}) {
        const TubeMesh mesh = build_ribbons(s, folds, most);
        EXPECT_LE(mesh.vertex.size(), most + 20) << most;
        EXPECT_LT(mesh.vertex.size(), before);
        before = mesh.vertex.size();
    }
}

}  // namespace
}  // namespace tact::gui_ribbon_test
