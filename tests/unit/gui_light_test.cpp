// Light of triangles by pixel and by vertex: pixels against rays that are met with triangles in double precision.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "gui/render/programs.hpp"
#include "gui/render/sorted_glass.hpp"
#include "gui/render/triangle_buffers.hpp"
#include "tests/unit/gui_draw_canvas.hpp"

namespace tact::gui_light_test {
namespace {

using Point = Eigen::Vector3d;

constexpr double kRadius = 12.0;

// An octahedron whose faces are divided once: a sphere of few vertices, where light by vertex is far off.
TubeMesh coarse_sphere() {
    const std::array<Point, 6> axis{Point::UnitX(),  Point::UnitY(),  Point::UnitZ(),
                                    -Point::UnitX(), -Point::UnitY(), -Point::UnitZ()};
    TubeMesh mesh;
    const auto add = [&mesh](const Point& n) {
        const Eigen::Vector3f p = (kRadius * n).cast<float>(), f = n.cast<float>();
        mesh.index.push_back(static_cast<std::uint32_t>(mesh.vertex.size()));
        mesh.vertex.push_back({{p.x(), p.y(), p.z()}, {f.x(), f.y(), f.z()}, {200, 120, 60, 255}});
    };
    const auto face = [&add](const Point& a, const Point& b, const Point& c) {
        for (const Point& p : {a, b, c}) add(p);
    };
    for (const double sx : {1.0, -1.0})
        for (const double sy : {1.0, -1.0})
            for (const double sz : {1.0, -1.0}) {
                const Point a = sx * axis[0], c = sz * axis[2];
                Point b = sy * axis[1], d = c;
                if (sx * sy * sz < 0.0) std::swap(b, d);  // counter-clockwise seen from outside
                const Point ab = (a + b).normalized(), bd = (b + d).normalized(), da = (d + a).normalized();
                face(a, ab, da);
                face(ab, b, bd);
                face(da, bd, d);
                face(ab, bd, da);
            }
    return mesh;
}

class GuiLight : public DrawCanvas {
protected:
    [[nodiscard]] Eigen::Matrix4d projection() const {
        return camera_.projection(static_cast<float>(kWidth) / static_cast<float>(kHeight)).cast<double>();
    }
    // Interpolated normal of the nearest triangle on a ray of the eye, in eye space.
    struct Hit {
        Point normal, place;
    };
    [[nodiscard]] std::optional<Hit> hit(const TubeMesh& mesh, int x, int y) const {
        const Eigen::Matrix4d p = projection(), eye = camera_.view().cast<double>();
        const Point ray((2.0 * (x + 0.5) / kWidth - 1.0) / p(0, 0),
                        (2.0 * (y + 0.5) / kHeight - 1.0) / p(1, 1), -1.0);
        std::optional<Hit> nearest;
        for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
            std::array<Point, 3> at, n;
            for (std::size_t k = 0; k < 3; ++k) {
                const TubeVertex& v = mesh.vertex[mesh.index[t + k]];
                at[k] =
                    (eye * Eigen::Vector4d(v.position_a[0], v.position_a[1], v.position_a[2], 1.0)).head<3>();
                n[k] = eye.topLeftCorner<3, 3>() * Point(v.normal[0], v.normal[1], v.normal[2]);
            }
            Eigen::Matrix3d m;
            m << at[0], at[1], at[2];
            const Point weight = m.inverse() * ray;  // of the corners, times 1 / depth
            if (weight.minCoeff() < 0.0 || weight.sum() <= 0.0) continue;
            const double depth = 1.0 / weight.sum();
            if (nearest && -nearest->place.z() < depth) continue;
            nearest = Hit{(weight[0] * n[0] + weight[1] * n[1] + weight[2] * n[2]).normalized(), depth * ray};
        }
        return nearest;
    }
    // As the shaders state it (gui/render/shading.cpp).
    [[nodiscard]] static Point lit(const Point& colour, const Point& n, const Point& v) {
        const Point key(0.352, 0.754, 0.553);
        const double diffuse = std::max(n.dot(key), 0.0), fill = 0.5 + 0.5 * n.y(),
                     shine = std::pow(std::max(n.dot((key + v).normalized()), 0.0), 32.0);
        return colour * (0.22 + 0.26 * fill + 0.62 * diffuse) + Point::Constant(0.22 * shine);
    }
    // Greatest and mean difference of a channel from the reference, in steps of 255.
    std::pair<double, double> errors(const TubeMesh& mesh) {
        const Image image = read_pixels(kWidth, kHeight);
        double most = 0.0, sum = 0.0, count = 0.0;
        for (int y = 1; y + 1 < kHeight; ++y)
            for (int x = 1; x + 1 < kWidth; ++x) {
                const auto at = hit(mesh, x, y);
                if (!at || !hit(mesh, x - 1, y) || !hit(mesh, x + 1, y) || !hit(mesh, x, y - 1) ||
                    !hit(mesh, x, y + 1))
                    continue;  // an outline
                const Point seen = lit(Point(200, 120, 60) / 255.0, at->normal, -at->place.normalized());
                for (std::size_t k = 0; k < 3; ++k) {
                    const double drawn =
                        image.rgb[3 * static_cast<std::size_t>((kHeight - 1 - y) * kWidth + x) + k];
                    const double off =
                        std::abs(drawn - 255.0 * std::min(seen[static_cast<Eigen::Index>(k)], 1.0));
                    most = std::max(most, off);
                    sum += off;
                    count += 1.0;
                }
            }
        EXPECT_GT(count, 3000.0);
        return {most, sum / count};
    }
};

TEST_F(GuiLight, by_pixel_is_that_of_the_interpolated_normal_and_by_vertex_is_not) {
    Programs programs;
    const TubeMesh mesh = coarse_sphere();
    TriangleBuffers sphere;
    sphere.fill(mesh, GL_STATIC_DRAW);
    const auto drawn = [&](bool by_pixel) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        programs.light_by_pixel(by_pixel);
        programs.use_lit(camera_.view(), projection().cast<float>(), {}, {});
        sphere.draw();
        return errors(mesh);
    };
    const auto [most, mean] = drawn(true);
    EXPECT_LT(most, 2.5);
    EXPECT_LT(mean, 0.6);
    EXPECT_GT(drawn(false).first, 20.0);
}

TEST_F(GuiLight, by_pixel_lights_both_sides_and_keeps_the_cut_and_glass) {
    Programs programs;
    TubeMesh mesh = coarse_sphere();
    TriangleBuffers sphere;
    const auto drawn = [&](bool by_pixel, const Haze& haze, const Paint& paint) {
        sphere.fill(mesh, GL_STATIC_DRAW);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        programs.light_by_pixel(by_pixel);
        if (haze.cut_a > 0.0F) glEnable(GL_CLIP_DISTANCE0);
        if (paint.glass) glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        programs.use_lit(camera_.view(), projection().cast<float>(), haze, paint);
        sphere.draw();
        glDisable(GL_BLEND);
        glDisable(GL_CLIP_DISTANCE0);
        return read_pixels(kWidth, kHeight);
    };
    const auto middle = [](const Image& image) {
        const std::size_t i = 3 * (std::size_t{kHeight} / 2 * kWidth + kWidth / 2);
        return std::array<int, 3>{image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
    };
    // Cut in the middle and closed: the flat colour of a face, as by vertex. A fog that tells depth is the same.
    Haze haze;
    haze.cut_a = camera_.distance_a();
    const auto face = middle(drawn(true, haze, {.closed = true}));
    constexpr std::array base{200, 120, 60};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(face[k], 0.72 * base[k], 1.5);
    EXPECT_EQ(face, middle(drawn(false, haze, {.closed = true})));
    // Open, its inside is lit towards the eye: as the outside of the sphere turned inside out.
    const auto inside = drawn(true, haze, {});
    for (TubeVertex& v : mesh.vertex)
        for (float& n : v.normal) n = -n;
    for (std::size_t t = 0; t < mesh.index.size(); t += 3) std::swap(mesh.index[t], mesh.index[t + 1]);
    EXPECT_EQ(inside.rgb, drawn(true, haze, {}).rgb);
    EXPECT_NE(middle(inside), face);
    mesh = coarse_sphere();
    // Glass: thin where it faces the eye, dense at the rim.
    const Image glass = drawn(true, {}, {.glass = true}),
                thin = drawn(true, {}, {.glass = true, .opacity = 0.4F});
    EXPECT_LT(middle(glass)[0], 140);
    EXPECT_LT(middle(thin)[0], middle(glass)[0]);
    EXPECT_GT(middle(thin)[0], 5);
    // The depth cue.
    Haze far;
    far.begin_a = camera_.distance_a() - 20.0F;
    far.end_a = camera_.distance_a() + 20.0F;
    far.strength = 1.0F;
    const auto hazed = middle(drawn(true, far, {})), clear = middle(drawn(true, {}, {}));
    EXPECT_LT(hazed[0], clear[0] - 10);
    far.strength = 0.0F;
    EXPECT_EQ(middle(drawn(true, far, {})), clear);
}

// Triangles of glass that overlap and meet, over a solid one, against all fragments of a pixel sorted in double precision.
TEST_F(GuiLight, glass_is_blended_in_the_order_of_depth) {
    Programs programs;
    SortedGlass glass(programs);
    // Slanted layers that cross each other, in an order that is neither that of depth nor its reverse.
    const auto slab = [this](float depth, float tilt, const Rgb8& c) {
        TubeMesh mesh;
        const Eigen::Matrix3f turn = camera_.orientation().conjugate().toRotationMatrix();
        for (const auto& [x, y] : {std::pair{-30.0F, -20.0F}, {30.0F, -20.0F}, {0.0F, 28.0F}}) {
            const Eigen::Vector3f p = turn * Eigen::Vector3f(x, y, depth + tilt * x),
                                  n = turn * Eigen::Vector3f::UnitZ();
            mesh.vertex.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {c[0], c[1], c[2], 255}});
        }
        mesh.index = {0, 1, 2};
        return mesh;
    };
    const std::array<TubeMesh, 4> layer{slab(4.0F, 0.1F, {230, 40, 40}), slab(-3.0F, 0.3F, {40, 220, 60}),
                                        slab(1.0F, -0.4F, {60, 80, 240}), slab(7.0F, 0.0F, {240, 230, 40})};
    const TubeMesh solid = slab(-1.0F, -0.2F, {180, 180, 180});
    std::array<TriangleBuffers, 4> buffers;
    for (std::size_t i = 0; i < 4; ++i) buffers[i].fill(layer[i], GL_STATIC_DRAW);
    TriangleBuffers solid_buffers;
    solid_buffers.fill(solid, GL_STATIC_DRAW);
    programs.light_by_pixel(true);
    const auto triangles = [&] {
        for (TriangleBuffers& b : buffers) {
            programs.use_lit(camera_.view(), projection().cast<float>(), {}, {.glass = true});
            b.draw();
        }
    };
    const auto begin = [&] {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glDisable(GL_BLEND);
        programs.use_lit(camera_.view(), projection().cast<float>(), {}, {});
        solid_buffers.draw();
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    };
    const auto seen_at = [&](int x, int y) {
        struct Fragment {
            double depth, opacity;
            Point colour;
        };
        std::vector<Fragment> all;
        const auto add = [&](const TubeMesh& mesh, bool clear) {
            const auto at = hit(mesh, x, y);
            if (!at) return;
            const auto& c = mesh.vertex[0].rgba;
            const Point n = at->normal, v = -at->place.normalized();
            const double rim = 1.0 - n.dot(v),
                         shine = std::pow(std::max(n.dot((Point(0.352, 0.754, 0.553) + v).normalized()), 0.0),
                                          32.0);
            all.push_back({-at->place.z(), clear ? 0.17 + 0.61 * rim * rim + 0.45 * shine : 1.0,
                           lit(Point(c[0], c[1], c[2]) / 255.0, n, v)});
        };
        for (const TubeMesh& mesh : layer) add(mesh, true);
        add(solid, false);
        std::sort(all.begin(), all.end(),
                  [](const Fragment& a, const Fragment& b) { return a.depth > b.depth; });
        Point sum = Point::Zero();
        for (const Fragment& f : all) sum = f.opacity * f.colour.cwiseMin(1.0) + (1.0 - f.opacity) * sum;
        // Places where two fragments are as deep are left out.
        bool meet = false;
        for (std::size_t i = 1; i < all.size(); ++i) meet = meet || all[i - 1].depth - all[i].depth < 0.2;
        return std::pair{sum, meet || all.size() < 2};
    };
    const auto error = [&] {
        const Image image = read_pixels(kWidth, kHeight);
        double most = 0.0;
        std::size_t count = 0;
        for (int y = 20; y < 90; ++y)
            for (int x = 40; x < 120; ++x) {
                const auto [seen, leave_out] = seen_at(x, y);
                const auto beside = seen_at(x + 1, y).first, above = seen_at(x, y + 1).first;
                if (leave_out || (beside - seen).norm() > 0.05 || (above - seen).norm() > 0.05) continue;
                ++count;
                for (std::size_t k = 0; k < 3; ++k)
                    most = std::max(
                        most,
                        std::abs(image.rgb[3 * static_cast<std::size_t>((kHeight - 1 - y) * kWidth + x) + k] -
                                 255.0 * seen[static_cast<Eigen::Index>(k)]));
            }
        EXPECT_GT(count, 1500U);
        return most;
    };
    begin();
    glDepthMask(GL_FALSE);
    triangles();
    glDepthMask(GL_TRUE);
    EXPECT_GT(error(), 8.0);  // in the order of drawing
    begin();
    glass.draw(0, 0, kWidth, kHeight, 8, triangles);
    const double sorted = error();
    EXPECT_LT(sorted, 2.0);
    EXPECT_EQ(glass.layers_drawn(), 4);
    // In fewer layers the front ones are right, and what is behind still shines through.
    begin();
    glass.draw(0, 0, kWidth, kHeight, 2, triangles);
    const double two = error();
    EXPECT_EQ(glass.layers_drawn(), 2);
    EXPECT_LT(two, 8.0);
    begin();
    glass.draw(0, 0, kWidth, kHeight, 8, [] {});
    EXPECT_EQ(glass.layers_drawn(), 0);
    const Image alone = read_pixels(kWidth, kHeight);
    begin();
    EXPECT_EQ(read_pixels(kWidth, kHeight).rgb, alone.rgb);
    // In a part of the framebuffer.
    begin();
    glViewport(30, 20, 80, 60);
    glass.draw(30, 20, 80, 60, 8, triangles);
    const Image part = read_pixels(kWidth, kHeight);
    EXPECT_NE(part.rgb, alone.rgb);
    for (int x = 0; x < kWidth; ++x) {
        const std::size_t i = 3 * static_cast<std::size_t>((kHeight - 1 - 10) * kWidth + x);  // below it
        EXPECT_EQ(part.rgb[i], alone.rgb[i]);
    }
    glViewport(0, 0, kWidth, kHeight);
    glDisable(GL_BLEND);
}

}  // namespace
}  // namespace tact::gui_light_test
