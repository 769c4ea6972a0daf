// Molecular surfaces against slow references in double precision that share nothing with them: sums over all atoms, surfaces of revolution,
// volumes counted in small cubes, winding numbers.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "gui/docking/docking_content.hpp"
#include "gui/docking/gaussian_atoms.hpp"
#include "gui/docking/molecular_surface.hpp"
#include "gui/docking/surface_choice.hpp"
#include "ipc/base/units.hpp"
#include "tests/unit/gui_fake.hpp"
#include "tests/unit/gui_wait.hpp"

namespace tact::gui_molecular_surface_test {
namespace {

using Point = Eigen::Vector3d;

void put(Structure& s, std::uint8_t element, const Point& a, std::uint16_t chain = 0) {
    s.x_m.push_back(static_cast<float>(a.x() * kAngstromM));
    s.y_m.push_back(static_cast<float>(a.y() * kAngstromM));
    s.z_m.push_back(static_cast<float>(a.z() * kAngstromM));
    s.element.push_back(element);
    s.residue.push_back(1);
    s.chain.push_back(chain);
    s.trace.push_back(0);
}

Structure of_atoms(std::initializer_list<std::pair<int, Point>> atoms) {
    Structure s;
    for (const auto& [element, at] : atoms) put(s, static_cast<std::uint8_t>(element), at);
    return s;
}

// Backbone and side chains of an ideal helix: N, CA, C, O and CB of each residue on their cylinders.
Structure synthetic_helix(std::size_t residues) {
    struct Kind {
        std::uint8_t element;
        double radius, degrees, rise;
    };
    constexpr std::array<Kind, 5> kinds{{{7, 1.55, -27.7, -0.9},
                                         {6, 2.3, 0.0, 0.0},
                                         {6, 1.65, 26.4, 1.1},
                                         {8, 2.0, 23.0, 2.3},
                                         {6, 3.3, -18.0, -0.3}}};
    Structure s;
    for (std::size_t r = 0; r < residues; ++r)
        for (const Kind& k : kinds) {
            const double turn = (100.0 * static_cast<double>(r) + k.degrees) * kDegreeRad;
            put(s, k.element,
                {k.radius * std::cos(turn), k.radius * std::sin(turn), 1.5 * static_cast<double>(r) + k.rise},
                static_cast<std::uint16_t>(r % 2));
        }
    return s;
}

Structure crowd_of(std::size_t atoms, unsigned seed, double half_a) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-half_a, half_a);
    const std::array<std::uint8_t, 6> elements{1, 6, 7, 8, 16, 19};
    Structure s;
    for (std::size_t i = 0; i < atoms; ++i)
        put(s, elements[random() % elements.size()], {place(random), place(random), place(random)},
            static_cast<std::uint16_t>(random() % 5));
    return s;
}

Point place_of(const Structure& s, std::size_t i) {
    return Point(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                 static_cast<double>(s.z_m[i])) /
           kAngstromM;
}

// The definition in the header, over all atoms and without a cut-off.
double whole_sum(const Structure& s, const Point& at) {
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const double r = static_cast<double>(vdw_radius_a(s.element[i]));
        sum += std::exp(kSurfaceDecay * (1.0 - (at - place_of(s, i)).squaredNorm() / (r * r)));
    }
    return sum;
}

Point at_vertex(const MolecularSurface& m, std::size_t v) {
    return Eigen::Map<const Eigen::Vector3f>(m.vertex[v].position_a.data()).cast<double>();
}
Point normal_at(const MolecularSurface& m, std::size_t v) {
    return Point(m.vertex[v].normal[0], m.vertex[v].normal[1], m.vertex[v].normal[2]) / 32767.0;
}

double area_of(const MolecularSurface& m) {
    double sum = 0.0;
    for (std::size_t t = 0; t < m.index.size(); t += 3) {
        const Point a = at_vertex(m, m.index[t]);
        sum += 0.5 * (at_vertex(m, m.index[t + 1]) - a).cross(at_vertex(m, m.index[t + 2]) - a).norm();
    }
    return sum;
}
double volume_of(const MolecularSurface& m) {
    double sum = 0.0;
    for (std::size_t t = 0; t < m.index.size(); t += 3)
        sum +=
            at_vertex(m, m.index[t]).dot(at_vertex(m, m.index[t + 1]).cross(at_vertex(m, m.index[t + 2]))) /
            6.0;
    return sum;
}
// Volume where the sum exceeds 1, in cubes of this side.
double counted_volume(const Structure& s, const Point& low, const Point& high, double side) {
    std::size_t inside = 0;
    for (double z = low.z(); z < high.z(); z += side)
        for (double y = low.y(); y < high.y(); y += side)
            for (double x = low.x(); x < high.x(); x += side)
                inside += whole_sum(s, {x, y, z}) > 1.0 ? 1U : 0U;
    return static_cast<double>(inside) * side * side * side;
}
// How often the surface encloses a point: the sum of the solid angles of its triangles (van Oosterom, Strackee 1983).
double winding(const MolecularSurface& m, const Point& p) {
    double sum = 0.0;
    for (std::size_t t = 0; t < m.index.size(); t += 3) {
        const Point a = at_vertex(m, m.index[t]) - p, b = at_vertex(m, m.index[t + 1]) - p,
                    c = at_vertex(m, m.index[t + 2]) - p;
        sum += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                       b.dot(c) * a.norm() + c.dot(a) * b.norm());
    }
    return sum / (4.0 * std::numbers::pi);
}
void expect_closed(const MolecularSurface& m) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t t = 0; t < m.index.size(); t += 3)
        for (std::size_t k = 0; k < 3; ++k) ++edges[{m.index[t + k], m.index[t + (k + 1) % 3]}];
    for (const auto& [edge, times] : edges) {
        ASSERT_EQ(times, 1) << edge.first << " to " << edge.second;
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << edge.first << " to " << edge.second;
    }
    ASSERT_FALSE(edges.empty());
}

TEST(MolecularSurface, of_one_atom_is_the_sphere_of_its_radius) {
    for (const int element : {1, 6, 7, 8, 16, 19})
        for (const double spacing : {0.6, 0.2}) {
            SCOPED_TRACE(testing::Message() << "element " << element << ", " << spacing << " A");
            const double r = static_cast<double>(vdw_radius_a(static_cast<std::uint8_t>(element)));
            const Point centre(3.3, -1.7, 40.1);
            const MolecularSurface m = build_surface(of_atoms({{element, centre}}), spacing);
            ASSERT_GT(m.vertex.size(), 50U);
            for (std::size_t v = 0; v < m.vertex.size(); ++v) {
                const Point from = at_vertex(m, v) - centre;
                EXPECT_NEAR(from.norm(), r, 2e-3);
                EXPECT_GT(normal_at(m, v).dot(from.normalized()), 0.9999);
            }
            // Its vertices lie on the sphere, so the triangles lie in it by a quarter and a half of this.
            const double part = spacing * spacing / (r * r);
            EXPECT_NEAR(area_of(m) / (4.0 * std::numbers::pi * r * r), 1.0 - 0.14 * part, 0.14 * part);
            EXPECT_NEAR(volume_of(m) / (4.0 / 3.0 * std::numbers::pi * r * r * r), 1.0 - 0.26 * part,
                        0.26 * part);
        }
}

TEST(MolecularSurface, of_two_atoms_has_area_and_volume_of_the_surface_of_revolution) {
    for (const double apart : {1.5, 3.0, 4.0}) {
        const Structure s = of_atoms({{6, {0, 0, 0}}, {8, {0, 0, apart}}});
        // Radius of the outline at a height, by bisection; outside of the ends 0.
        const auto outline = [&](double z) {
            if (whole_sum(s, {0, 0, z}) <= 1.0) return 0.0;
            double in = 0.0, out = 5.0;
            for (int i = 0; i < 60; ++i) {
                const double mid = 0.5 * (in + out);
                (whole_sum(s, {mid, 0, z}) > 1.0 ? in : out) = mid;
            }
            return in;
        };
        double area = 0.0, volume = 0.0, before = 0.0;
        constexpr double kStep = 1e-3;
        for (double z = -4.0; z < apart + 4.0; z += kStep) {
            const double r = outline(z + kStep);
            area += std::numbers::pi * (before + r) * std::hypot(r - before, kStep);
            volume += std::numbers::pi * (before * before + before * r + r * r) * kStep / 3.0;
            before = r;
        }
        const MolecularSurface m = build_surface(s, 0.2);
        expect_closed(m);
        EXPECT_NEAR(area_of(m) / area, 1.0, 0.006) << apart;
        EXPECT_NEAR(volume_of(m) / volume, 1.0, 0.01) << apart;
    }
}

TEST(MolecularSurface, of_a_helix_lies_where_the_sum_is_one_with_normals_of_its_slope) {
    const Structure s = synthetic_helix(12);
    const MolecularSurface m = build_surface(s, kFinestSpacingA);
    expect_closed(m);
    double worst_a = 0.0, worst_turn = 0.0;
    for (std::size_t v = 0; v < m.vertex.size(); v += 3) {
        const Point at = at_vertex(m, v);
        constexpr double kD = 1e-4;
        Point slope;
        for (int k = 0; k < 3; ++k)
            slope[k] = (whole_sum(s, at + kD * Point::Unit(k)) - whole_sum(s, at - kD * Point::Unit(k))) /
                       (2.0 * kD);
        worst_a = std::max(worst_a, std::abs(whole_sum(s, at) - 1.0) / slope.norm());
        worst_turn = std::max(worst_turn, std::acos(std::min(1.0, normal_at(m, v).dot(-slope.normalized()))));
    }
    EXPECT_LT(worst_a, 0.03);
    EXPECT_LT(worst_turn, 2.0 * kDegreeRad);
    const double counted = counted_volume(s, {-7, -7, -5}, {7, 7, 24}, 0.2);
    EXPECT_NEAR(volume_of(m) / counted, 1.0, 0.01);
}

TEST(MolecularSurface, is_closed_and_contains_every_atom_at_any_spacing) {
    for (const double spacing : {0.6, 1.0, 1.7, 2.5, 4.0, 7.0})
        for (const unsigned seed : {1U, 2U}) {
            // Some crowded, some alone.
            Structure s = crowd_of(60, seed, seed == 1 ? 6.0 : 25.0);
            const MolecularSurface m = build_surface(s, spacing);
            SCOPED_TRACE(testing::Message() << spacing << " A, seed " << seed);
            expect_closed(m);
            EXPECT_GT(volume_of(m), 0.0);
            for (std::size_t i = 0; i < s.size(); ++i) EXPECT_GT(winding(m, place_of(s, i)), 0.5) << i;
            EXPECT_NEAR(winding(m, {90.0, 0.0, 0.0}), 0.0, 1e-6);
        }
}

TEST(MolecularSurface, has_at_each_vertex_the_colour_of_the_nearest_atom) {
    const Structure s = crowd_of(200, 5, 9.0);
    std::vector<Rgb8> paint(s.size());
    for (std::size_t i = 0; i < s.size(); ++i)
        paint[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i), 7};
    for (const double spacing : {0.8, 2.0}) {
        const MolecularSurface m = build_surface(s, spacing);
        const auto chain = surface_colours(m, s, false), element = surface_colours(m, s, true),
                   painted = surface_colours(m, s, true, paint);
        for (std::size_t v = 0; v < m.vertex.size(); ++v) {
            double least = 1e9;
            for (std::size_t i = 0; i < s.size(); ++i)
                least = std::min(least, (at_vertex(m, v) - place_of(s, i)).norm());
            const std::uint32_t i = m.atom[v];
            ASSERT_NEAR((at_vertex(m, v) - place_of(s, i)).norm(), least, 1e-4);
            ASSERT_EQ(chain[v], colours_of(s, i).chain);
            ASSERT_EQ(element[v], colours_of(s, i).element);
            ASSERT_EQ(painted[v], (Rgba8{paint[i][0], paint[i][1], paint[i][2], 255}));
        }
    }
}

TEST(MolecularSurface, moves_with_the_atoms_of_a_bent_body) {
    const Structure straight = synthetic_helix(8);
    const MolecularSurface m = build_surface(straight, 0.8);
    Structure shifted = straight;
    for (float& x : shifted.x_m) x += 5e-10F;
    const auto moved = bent_surface(m, straight, shifted);
    double along = 0.0;
    for (std::size_t v = 0; v < moved.size(); ++v) {
        EXPECT_NEAR(moved[v].position_a[0], m.vertex[v].position_a[0] + 5.0F, 1e-3F);
        EXPECT_EQ(moved[v].position_a[1], m.vertex[v].position_a[1]);
        const Point n = Point(moved[v].normal[0], moved[v].normal[1], moved[v].normal[2]) / 32767.0;
        along += n.dot(normal_at(m, v)) / static_cast<double>(moved.size());
    }
    EXPECT_GT(along, 0.98);     // means of triangles instead of exact slopes
    Structure half = straight;  // only the second half moves
    for (std::size_t i = half.size() / 2; i < half.size(); ++i) half.y_m[i] += 2e-10F;
    const auto bent = bent_surface(m, straight, half);
    for (std::size_t v = 0; v < bent.size(); ++v)
        EXPECT_NEAR(bent[v].position_a[1] - m.vertex[v].position_a[1],
                    m.atom[v] < half.size() / 2 ? 0.0F : 2.0F, 1e-3F);
}

TEST(MolecularSurface, of_atoms_far_apart_has_a_grid_of_bounded_size) {
    const Structure s = of_atoms({{6, {-4000, -4000, -4000}}, {6, {4000, 4000, 4000}}});
    const double spacing = allowed_spacing_a(s, kFinestSpacingA, kSurfaceVoxelsMax);
    EXPECT_GT(spacing, 10.0);
    EXPECT_LE(gaussian_grid(gaussian_atoms(s, spacing), spacing).count(), kSurfaceVoxelsMax);
    EXPECT_EQ(allowed_spacing_a(synthetic_helix(9), kFinestSpacingA, kSurfaceVoxelsMax), kFinestSpacingA);
    EXPECT_TRUE(build_surface({}, 1.0).index.empty());
    EXPECT_THROW(
        static_cast<void>(build_surface(synthetic_helix(9), 1.0, [](double, const char*) { return false; })),
        Cancelled);
}

std::shared_ptr<SceneContent> content_of(std::vector<Structure> structures) {
    auto content = std::make_shared<SceneContent>();
    auto docking = std::make_unique<DockingContent>();
    docking->bodies = std::move(structures);
    content->system = std::move(docking);
    return content;
}

TEST(SurfaceChoices, have_the_vertices_asked_for_and_fewer_at_each_step) {
    const auto content = content_of({crowd_of(4000, 3, 22.0), synthetic_helix(6)});
    constexpr std::size_t kMost = 40000;  // of both
    SurfaceChoices choices(content, kMost);
    const auto choose = [&](float level, std::size_t most) { return choices.choose(0, level, most); };
    EXPECT_TRUE(choose(1.0F, SIZE_MAX).awaited);
    EXPECT_EQ(choose(1.0F, SIZE_MAX).surface, nullptr);
    ASSERT_TRUE(test::wait_for([&] {
        choices.follow();
        for (const float level : kSurfaceShares)
            if (choose(level, SIZE_MAX).awaited) return false;
        // The first one, a coarse one of any spacing, is replaced last.
        return std::abs(choose(kSurfaceShares.back(), SIZE_MAX).surface->spacing_a -
                        spacing_of_step_a(choose(1.0F, SIZE_MAX).surface->spacing_a, kSurfaceSteps - 1)) <
               1e-6;
    }));
    const SurfaceChoice finest = choose(1.0F, SIZE_MAX);
    EXPECT_LT(static_cast<double>(finest.surface->vertex.size()), 1.25 * kMost / 2);
    EXPECT_GT(static_cast<double>(finest.surface->vertex.size()), 0.5 * kMost / 2);
    double before = static_cast<double>(finest.surface->vertex.size());
    for (std::size_t step = 1; step < kSurfaceSteps; ++step) {
        const SurfaceChoice at = choose(kSurfaceShares[step], SIZE_MAX);
        EXPECT_EQ(at.step, step);
        EXPECT_FALSE(at.too_large);
        EXPECT_EQ(at.triangles_most, finest.surface->index.size() / 3);
        EXPECT_LT(static_cast<double>(at.surface->vertex.size()), before);
        before = static_cast<double>(at.surface->vertex.size());
    }
    EXPECT_LT(before, 0.3 * static_cast<double>(finest.surface->vertex.size()));
    // Between two steps, the coarser one.
    EXPECT_EQ(choose(0.9F, SIZE_MAX).step, 1U);
    EXPECT_EQ(choose(0.01F, SIZE_MAX).step, kSurfaceSteps - 1);
    // A limit takes the finest step within it, and says so; below the coarsest there is none.
    const std::size_t least = choose(0.01F, SIZE_MAX).surface->vertex.size();
    EXPECT_EQ(choose(1.0F, least).step, kSurfaceSteps - 1);
    EXPECT_TRUE(choose(1.0F, least).too_large);
    EXPECT_EQ(choose(1.0F, least - 1).surface, nullptr);
    EXPECT_TRUE(choose(1.0F, least - 1).too_large);
    EXPECT_FALSE(choose(1.0F, least - 1).awaited);
}

TEST(SurfaceWorker, says_why_a_surface_cannot_be_computed_and_ends_while_it_computes) {
    Structure broken = synthetic_helix(4);
    broken.x_m[3] = std::nanf("");
    SurfaceChoices choices(content_of({broken}), 1000);
    EXPECT_TRUE(choices.choose(0, 1.0F, SIZE_MAX).awaited);
    ASSERT_TRUE(test::wait_for([&] {
        choices.follow();
        return !choices.error().empty();
    }));
    EXPECT_FALSE(choices.choose(0, 1.0F, SIZE_MAX).awaited);
    const Instant begun = Monotonic::now();
    {
        SurfaceWorker worker(content_of({crowd_of(200000, 4, 80.0)}), 5'000'000);
        worker.request(0);
        worker.request(0);
        worker.request(77);  // not in the scene
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
    EXPECT_LT(to_s(Monotonic::now() - begun), 20.0);
}

}  // namespace
}  // namespace tact::gui_molecular_surface_test
