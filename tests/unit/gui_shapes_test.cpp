// Geometry that needs no window: bonds, colours and shapes of atoms, touch marks, the detail of a surface.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "gui/docking/atom_shapes.hpp"
#include "gui/render/tube.hpp"
#include "gui/render/viridis.hpp"
#include "gui/surface/detail_mesh.hpp"
#include "gui/surface/surface_content.hpp"
#include "gui/surface/touch_marks.hpp"
#include "ipc/base/units.hpp"
#include "prep/surface/bake_surface.hpp"
#include "prep/synthetic/rough_sphere.hpp"

namespace tact::gui_shapes_test {
namespace {

void add(Structure& s, std::uint8_t element, std::array<double, 3> a, std::int32_t residue = 1,
         std::uint16_t chain = 0) {
    s.x_m.push_back(static_cast<float>(a[0] * kAngstromM));
    s.y_m.push_back(static_cast<float>(a[1] * kAngstromM));
    s.z_m.push_back(static_cast<float>(a[2] * kAngstromM));
    s.element.push_back(element);
    s.residue.push_back(residue);
    s.chain.push_back(chain);
    s.trace.push_back(0);
}

// Denser than a protein, over several cells of the search grid on both sides of zero.
Structure crowd(std::size_t atoms, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-14.0, 14.0);
    const std::array<std::uint8_t, 7> elements{6, 6, 7, 8, 16, 30, 12};
    Structure s;
    for (std::size_t i = 0; i < atoms; ++i)
        add(s, elements[random() % elements.size()], {place(random), place(random), place(random)},
            static_cast<std::int32_t>(random() % 4), static_cast<std::uint16_t>(random() % 2));
    return s;
}

TEST(Bonds, equal_those_found_by_testing_every_pair) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const Structure s = crowd(1200, seed);
        std::vector<Bond> expected;
        for (std::uint32_t i = 0; i < s.size(); ++i)
            for (std::uint32_t j = i + 1; j < s.size(); ++j)
                if (bonded(s, i, j)) expected.push_back({i, j});
        ASSERT_GT(expected.size(), 50U);
        EXPECT_EQ(find_bonds(s), expected);
    }
}

TEST(Bonds, of_a_peptide_are_the_known_ones) {
    // Glycine and the nitrogen of the next residue; a lone oxygen and an ion beside them.
    Structure s;
    add(s, 7, {0.0, 0.0, 0.0});
    add(s, 6, {1.46, 0.0, 0.0});
    add(s, 6, {2.0, 1.43, 0.0});
    add(s, 8, {1.25, 2.4, 0.0});
    add(s, 7, {3.33, 1.55, 0.0}, 2);
    add(s, 12, {4.9, 2.6, 0.0}, 3);      // magnesium, 1.9 Å from the nitrogen
    add(s, 6, {3.33, 1.55, 1.4}, 2, 1);  // within bond length, but in another chain
    EXPECT_EQ(find_bonds(s), (std::vector<Bond>{{0, 1}, {1, 2}, {2, 3}, {2, 4}}));
}

TEST(Bonds, join_sulphurs_of_different_residues_and_chains) {
    Structure s;
    add(s, 16, {0.0, 0.0, 0.0}, 5, 0);
    add(s, 16, {2.05, 0.0, 0.0}, 90, 1);
    add(s, 16, {6.0, 0.0, 0.0}, 91, 1);
    EXPECT_EQ(find_bonds(s), (std::vector<Bond>{{0, 1}}));
}

TEST(Bonds, of_overlapping_atoms_stay_linear_in_number) {
    // All in a cube of 1.5 Å: almost every pair would be a bond, two hundred million of them.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0.0, 1.5);
    Structure s;
    for (int i = 0; i < 20000; ++i) add(s, 6, {place(random), place(random), place(random)});
    const std::vector<Bond> bonds = find_bonds(s);
    EXPECT_LE(bonds.size(), kBondsOfAtomMax * s.size());
    // At the largest coordinates allowed, nothing overflows.
    Structure far;
    for (int i = 0; i < 3; ++i) add(far, 6, {9.9e6, 1.4 * i, -9.9e6});
    (void)find_bonds(far);
}

TEST(Elements, have_the_jmol_colours) {
    EXPECT_EQ(element_colour(7), (Rgb8{0x30, 0x50, 0xF8}));
    EXPECT_EQ(element_colour(8), (Rgb8{0xFF, 0x0D, 0x0D}));
    EXPECT_EQ(element_colour(26), (Rgb8{0xE0, 0x66, 0x33}));
    EXPECT_EQ(element_colour(79), (Rgb8{0xFF, 0xD1, 0x23}));
    EXPECT_EQ(element_colour(118), element_colour(0));
    EXPECT_FLOAT_EQ(covalent_radius_a(6), 0.76F);
    EXPECT_FLOAT_EQ(covalent_radius_a(30), 1.22F);
    EXPECT_FLOAT_EQ(covalent_radius_a(255), 0.0F);
    // Longer bonds would reach beyond the cells that find_bonds() searches.
    for (unsigned z = 0; z < 256; ++z)
        EXPECT_LT(2.0 * static_cast<double>(covalent_radius_a(static_cast<std::uint8_t>(z))) + kBondSlackA,
                  4.8);
}

TEST(Shapes, carbon_has_the_colour_of_its_chain_other_elements_their_own) {
    Structure s;
    add(s, 6, {0.0, 0.0, 0.0}, 1, 0);
    add(s, 6, {1.5, 0.0, 0.0}, 1, 1);
    add(s, 8, {3.0, 0.0, 0.0}, 1, 1);
    const auto spheres = spheres_of(s);
    EXPECT_NE(spheres[0].colours.element, spheres[1].colours.element);
    EXPECT_EQ(spheres[1].colours.element, spheres[1].colours.chain);
    EXPECT_EQ(spheres[2].colours.element, (Rgba8{0xFF, 0x0D, 0x0D, 255}));
    EXPECT_EQ(spheres[2].colours.chain, spheres[1].colours.chain);
    EXPECT_FLOAT_EQ(spheres[2].radius_a, 1.52F);
    EXPECT_NEAR(spheres[1].centre_a[0], 1.5F, 1e-6F);
}

TEST(Shapes, an_atom_without_bonds_is_visible_among_sticks) {
    Structure s;
    add(s, 6, {0.0, 0.0, 0.0});
    add(s, 6, {1.5, 0.0, 0.0});
    add(s, 30, {20.0, 0.0, 0.0});
    const auto sticks = sticks_of(s, find_bonds(s));
    ASSERT_EQ(sticks.size(), 2U);
    EXPECT_EQ(sticks[1].from_a, sticks[1].to_a);
    EXPECT_GT(sticks[1].radius_a, 2.0F * kStickRadiusA);
}

TEST(Shapes, the_trace_and_the_tube_break_at_the_same_places) {
    Structure s;
    for (int i = 0; i < 10; ++i) add(s, 6, {3.8 * i + (i > 4 ? 30.0 : 0.0), 0.0, 0.0}, i, i > 7 ? 1 : 0);
    s.trace.assign(s.size(), 1);
    EXPECT_EQ(strands_of(s).size(), 3U);  // five, three and two atoms
    EXPECT_EQ(trace_of(s).size(), 4U + 2U + 1U);
    EXPECT_EQ(build_tubes(s, 10000).strands, 3U);
}

// The lowest and the highest coordinate of the marks along a direction, from a point; ångström.
std::pair<float, float> extent(const TubeMesh& mesh, const Eigen::Vector3f& from,
                               const Eigen::Vector3f& along) {
    std::pair<float, float> found{1e9F, -1e9F};
    for (const TubeVertex& v : mesh.vertex) {
        const float at = along.dot(Eigen::Vector3f(v.position_a[0], v.position_a[1], v.position_a[2]) - from);
        found = {std::min(found.first, at), std::max(found.second, at)};
    }
    return found;
}

TEST(TouchMarks, extend_from_the_probe_to_the_proxy_and_along_the_push_of_a_plane) {
    DrawnTouch touch;
    touch.probe_model_m = kAngstromM * Vec3(10.0, -4.0, 0.0);
    touch.proxy_model_m = kAngstromM * Vec3(10.0, 6.0, 0.0);
    const Eigen::Vector3f centre(0.0F, 0.0F, 0.0F), up(0.0F, 1.0F, 0.0F);
    const auto [low, high] = extent(build_touch_marks(touch, Vec3::Zero(), 100.0F, 20.0F), centre, up);
    EXPECT_NEAR(low, -4.0F - 1.4F, 1e-3F);  // the ball has a least radius, so that it stays visible
    EXPECT_NEAR(high, 6.0F, 1e-3F);
    touch.planes = 1;
    touch.normal[0] = Vec3::UnitY();
    touch.push_n[0] = 2.0;
    EXPECT_NEAR(extent(build_touch_marks(touch, Vec3::Zero(), 100.0F, 20.0F), centre, up).second, 46.0F,
                0.1F);
    touch.radius_model_m = 5.0 * kAngstromM;  // a ball touches below its centre
    EXPECT_NEAR(extent(build_touch_marks(touch, Vec3::Zero(), 100.0F, 20.0F), centre, up).second, 41.0F,
                0.1F);
    touch.probe_model_m.x() = std::nan("");
    EXPECT_TRUE(build_touch_marks(touch, Vec3::Zero(), 100.0F, 20.0F).index.empty());
}

TEST(Detail, viridis_goes_from_dark_violet_to_yellow_with_rising_lightness) {
    EXPECT_EQ(viridis(-3.0F), viridis(0.0F));
    EXPECT_EQ(viridis(std::nanf("")), viridis(0.0F));
    EXPECT_NEAR(viridis(0.0F)[0], 68, 6);
    EXPECT_NEAR(viridis(0.0F)[2], 84, 6);
    EXPECT_NEAR(viridis(1.0F)[0], 253, 6);
    EXPECT_NEAR(viridis(1.0F)[1], 231, 6);
    double before = 0.0;
    for (int i = 0; i <= 20; ++i) {
        const auto c = viridis(static_cast<float>(i) / 20.0F);
        const double light = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        EXPECT_GT(light, before);
        before = light;
    }
}

TEST(Detail, the_drawn_surface_is_fine_around_the_probe_and_its_colour_shows_it) {
    SceneWriter out;
    SurfaceInput input;
    input.mesh = smooth_sphere(20);
    input.picture = false;
    static_cast<void>(bake_surface(std::move(input), out));
    const std::vector<std::byte> bytes = out.to_bytes();
    SceneFile file = SceneFile::from_bytes(bytes, "sphere.tact");
    const SurfaceMesh surface = read_surface(file);
    const VertexForest forest = read_forest(file, surface.all_positions_m(), surface.all_corners());
    SceneContent content;
    auto own = std::make_unique<SurfaceContent>();
    own->detail.reset(new SurfaceDetail{std::move(file), surface, forest});
    content.system = std::move(own);

    DetailCut cut(content);
    const auto settled = [&](const DetailRequest& request) {
        DetailMesh made = cut.step(request);
        for (int i = 0; i < 100 && !made.settled; ++i) made = cut.step(request);
        EXPECT_TRUE(made.settled);
        return made;
    };
    DetailRequest request{Vec3(0.0, 0.0, 0.05), 0.01, {}};
    const DetailMesh seen = settled(request);
    EXPECT_LT(seen.triangles, 6000U);  // of the 8000 of the full mesh
    EXPECT_EQ(seen.mesh.index.size(), std::size_t{3} * seen.triangles);
    EXPECT_EQ(seen.mesh.vertex.size(), seen.vertices);
    EXPECT_GT(seen.deviation_m, 0.0);
    // An edge of the full mesh is about 2.6 mm long.
    EXPECT_GT(seen.finest_m, 0.5e-3);
    EXPECT_LT(seen.finest_m, 2.7e-3);
    EXPECT_GE(seen.coarsest_m, 2.0 * seen.finest_m);
    double near = 0.0, nears = 0.0, far = 0.0, fars = 0.0;
    for (const TubeVertex& v : seen.mesh.vertex) {
        const Eigen::Vector3f at = Eigen::Vector3f(v.position_a) * static_cast<float>(kAngstromM),
                              normal(v.normal);
        EXPECT_NEAR(normal.norm(), 1.0F, 1e-4F);
        EXPECT_GT(normal.dot(at.normalized()), 0.7F);
        const bool around = (at - request.probe_m.cast<float>()).norm() < 0.008F;
        if (around) {
            near += v.rgba[1];
            nears += 1.0;
        } else if (at.z() < -0.03F) {
            far += v.rgba[1];
            fars += 1.0;
        }
    }
    ASSERT_GT(nears, 0.0);
    ASSERT_GT(fars, 0.0);
    EXPECT_GT(near / nears, far / fars + 40.0);
    request.form = {FilterForm::Shape::multiple_frustum, 6.0F, 0.05F};
    EXPECT_GT(settled(request).triangles, seen.triangles);
    // The same request gives the same cut, whatever the request before.
    request.form = {};
    EXPECT_EQ(settled(request).triangles, seen.triangles);
}

}  // namespace
}  // namespace tact::gui_shapes_test
