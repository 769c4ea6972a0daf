// The cut through the 3D view, shading by depth, and transparent pictures: pixels against slow references that share nothing with the shaders.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "gui/docking/impostors.hpp"
#include "gui/render/arrow.hpp"
#include "gui/render/density_slice.hpp"
#include "gui/render/programs.hpp"
#include "gui/render/rest_shading.hpp"
#include "gui/render/still_picture.hpp"
#include "gui/render/triangle_buffers.hpp"
#include "tests/unit/gui_draw_canvas.hpp"

namespace tact::gui_cut_test {
namespace {

class GuiCut : public DrawCanvas {
protected:
    [[nodiscard]] Eigen::Matrix4f projection() const {
        return camera_.projection(static_cast<float>(kWidth) / static_cast<float>(kHeight));
    }
    [[nodiscard]] Haze cut_at(float depth_a) const {
        Haze haze;
        haze.cut_a = depth_a;
        return haze;
    }
    // Distance along the view of each pixel; 0: nothing there.
    [[nodiscard]] std::vector<double> distances() const {
        std::vector<float> depth(std::size_t{kWidth} * kHeight);
        glReadPixels(0, 0, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
        const Eigen::Matrix4d p = projection().cast<double>();
        std::vector<double> out;
        for (const float d : depth)
            out.push_back(d < 1.0F ? p(2, 3) / (2.0 * static_cast<double>(d) - 1.0 + p(2, 2)) : 0.0);
        return out;
    }
    [[nodiscard]] Eigen::Vector3d ray(int x, int y) const {
        const Eigen::Matrix4d p = projection().cast<double>();
        return {(2.0 * (x + 0.5) / kWidth - 1.0) / p(0, 0), (2.0 * (y + 0.5) / kHeight - 1.0) / p(1, 1),
                -1.0};
    }
    [[nodiscard]] static Image picture() { return read_pixels(kWidth, kHeight); }
    [[nodiscard]] static std::array<int, 3> pixel(const Image& image, int x, int y) {  // y from below
        const std::size_t i =
            3 * (static_cast<std::size_t>(kHeight - 1 - y) * kWidth + static_cast<std::size_t>(x));
        return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
    }
};

// Marches in small steps from the plane, with the distance to the shape alone.
std::optional<double> first_hit(const Eigen::Vector3d& ray, double from, double to,
                                const std::function<double(const Eigen::Vector3d&)>& distance) {
    for (double t = from; t < to;) {
        const double d = distance(t * ray);
        if (d <= 1e-4) return t;
        t += d / ray.norm();
    }
    return std::nullopt;
}

TEST_F(GuiCut, spheres_and_sticks_are_cut_by_the_plane_and_closed_by_its_face) {
    ImpostorPrograms programs;
    const Eigen::Matrix4f eye = camera_.view();
    const auto in_eye = [&](const std::array<float, 3>& a) -> Eigen::Vector3d {
        return (eye * Eigen::Vector4f(a[0], a[1], a[2], 1.0F)).head<3>().cast<double>();
    };
    const Sphere sphere{{0.0F, 0.0F, 0.0F}, 8.0F, {}};
    const Stick stick{{-8.0F, 2.0F, -5.0F}, 2.5F, {9.0F, -2.0F, 6.0F}, {}, {}};
    for (const float beside : {-9.0F, -4.0F, 0.0F, 1.5F, 6.0F, 9.0F}) {
        const double plane = static_cast<double>(camera_.distance_a() - beside);
        for (const bool ball : {true, false}) {
            SCOPED_TRACE(testing::Message() << (ball ? "sphere" : "stick") << ", plane " << beside);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            ImpostorShapes shapes;
            const Haze haze = cut_at(static_cast<float>(plane));
            const ImpostorView view{eye, projection(), haze};
            if (ball) {
                shapes.fill(std::array{sphere});
                programs.use_spheres(view);
            } else {
                shapes.fill(std::array{stick});
                programs.use_sticks(view);
            }
            shapes.draw();
            const Eigen::Vector3d a = ball ? in_eye(sphere.centre_a) : in_eye(stick.from_a),
                                  b = ball ? a : in_eye(stick.to_a);
            const double radius = static_cast<double>(ball ? sphere.radius_a : stick.radius_a);
            const auto distance = [&](const Eigen::Vector3d& p) {
                const double length2 = (b - a).squaredNorm();
                const double part = length2 > 0.0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
                return (p - a - part * (b - a)).norm() - radius;
            };
            const std::vector<double> seen = distances();
            int hits = 0, faces = 0, wrong = 0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    const auto hit = first_hit(ray(x, y), plane, 200.0, distance);
                    const double d = seen[static_cast<std::size_t>(y * kWidth + x)];
                    hits += hit ? 1 : 0;
                    if (hit.has_value() != (d > 0.0)) {
                        ++wrong;  // pixels that the outline barely touches
                        continue;
                    }
                    if (!hit) continue;
                    faces += *hit == plane ? 1 : 0;
                    // At a grazing ray the depth is steep, so the distance to the shape is compared.
                    const double off = *hit == plane ? d - plane : distance(d * ray(x, y));
                    EXPECT_NEAR(off, 0.0, 0.03) << x << ", " << y;
                }
            EXPECT_LE(wrong, 3 + hits / 40);
            if (ball) {
                EXPECT_EQ(faces > 20, std::abs(beside) < 8.0F) << faces << " of " << hits;
            } else if (beside == 0.0F) {
                EXPECT_GT(faces, 20) << "of " << hits;
            }
        }
    }
}

TEST_F(GuiCut, the_face_has_one_colour_and_no_highlight) {
    ImpostorPrograms programs;
    ImpostorShapes shapes;
    shapes.fill(std::array{Sphere{{0.0F, 0.0F, 0.0F}, 8.0F, {{200, 100, 50, 255}, {200, 100, 50, 255}}}});
    const Haze haze = cut_at(camera_.distance_a());
    programs.use_spheres({camera_.view(), projection(), haze});
    shapes.draw();
    const Image image = picture();
    const auto middle = pixel(image, kWidth / 2, kHeight / 2);
    for (int dx = -12; dx <= 12; dx += 4) EXPECT_EQ(pixel(image, kWidth / 2 + dx, kHeight / 2), middle);
    EXPECT_NEAR(middle[0], 0.72 * 200, 2);
    EXPECT_NEAR(middle[1], 0.72 * 100, 2);
    EXPECT_NEAR(middle[2], 0.72 * 50, 2);
}

TEST_F(GuiCut, triangles_end_at_the_plane_and_what_holds_the_hand_does_not) {
    Programs programs;
    TriangleBuffers arrow;
    // Towards the eye, so that the plane cuts it.
    const Eigen::Vector3f towards = camera_.orientation().conjugate() * Eigen::Vector3f(4.0F, 3.0F, 24.0F);
    arrow.fill(build_arrow(-0.5F * towards, towards, 2.0F, {220, 60, 60}), GL_STATIC_DRAW);
    const auto nearest = [&](const Haze& haze, bool closed) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glEnable(GL_CLIP_DISTANCE0);
        programs.use_lit(camera_.view(), projection(), haze, {.closed = closed});
        arrow.draw();
        glDisable(GL_CLIP_DISTANCE0);
        double least = 1e9;
        for (const double d : distances())
            if (d > 0.0) least = std::min(least, d);
        return least;
    };
    const double centre = static_cast<double>(camera_.distance_a());
    EXPECT_LT(nearest({}, true), centre - 10.0);
    const Haze cut = cut_at(camera_.distance_a() + 2.0F);
    EXPECT_GE(nearest(cut, true), centre + 2.0 - 0.01);
    EXPECT_LT(nearest(cut, true), centre + 2.5);
    EXPECT_LT(nearest(cut.uncut(), true), centre - 10.0);
    // Its inner walls look like the face of a cut: the vertex colour, unlit.
    static_cast<void>(nearest(cut, true));
    const auto inside = pixel(picture(), kWidth / 2, kHeight / 2);
    EXPECT_NEAR(inside[0], 0.72 * 220, 2);
    EXPECT_NEAR(inside[1], 0.72 * 60, 2);
}

// Trilinear, in double precision.
std::optional<double> sampled(const DensityGrid& g, const Eigen::Vector3d& p_m) {
    std::array<std::uint32_t, 3> low{};
    Eigen::Vector3d part;
    for (int i = 0; i < 3; ++i) {
        const double at = (p_m[i] - g.origin_m[i]) / g.spacing_m[i];
        if (at < 0.0 || at > g.size[static_cast<std::size_t>(i)] - 1.001) return std::nullopt;
        low[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(at);
        part[i] = at - std::floor(at);
    }
    double sum = 0.0;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const std::uint32_t dx = k & 1U, dy = (k >> 1U) & 1U, dz = k >> 2U;
        const double w = (dx ? part.x() : 1.0 - part.x()) * (dy ? part.y() : 1.0 - part.y()) *
                         (dz ? part.z() : 1.0 - part.z());
        sum += w * static_cast<double>(g.at(low[0] + dx, low[1] + dy, low[2] + dz));
    }
    return sum;
}

// Voxels of unequal sides, an origin beside the middle, negative densities.
DensityGrid waves() {
    DensityGrid g;
    g.size = {24, 20, 17};
    g.spacing_m = Vec3(1.5e-10, 1.7e-10, 2.1e-10);
    g.origin_m = Vec3(-16e-10, -17e-10, -15e-10);
    for (std::uint32_t z = 0; z < g.size[2]; ++z)
        for (std::uint32_t y = 0; y < g.size[1]; ++y)
            for (std::uint32_t x = 0; x < g.size[0]; ++x)
                g.values.push_back(static_cast<float>(std::sin(0.45 * x) + 0.8 * std::cos(0.38 * y + 0.2) +
                                                      0.6 * std::sin(0.5 * z)));
    return g;
}

TEST_F(GuiCut, the_face_of_a_map_is_where_its_density_exceeds_a_contour) {
    const DensityGrid grid = waves();
    DensitySlice slice(grid);
    EXPECT_EQ(slice.stride(), 1U);
    camera_.rotate(40.0F, 25.0F, 120.0F);
    Eigen::Matrix4f scale = Eigen::Matrix4f::Identity();
    scale.topLeftCorner<3, 3>() *= 1e10F;
    const Eigen::Matrix4f eye = camera_.view() * scale;
    const Eigen::Matrix4d model_from_eye = eye.cast<double>().inverse();
    const std::array<DensitySlice::Level, 2> levels{
        {{1.1, {0.0F, 0.0F, 1.0F}, 1.0F}, {0.3, {1.0F, 0.0F, 0.0F}, 1.0F}}};
    for (const float beside : {0.0F, 4.0F, -6.0F}) {
        const Haze haze = cut_at(camera_.distance_a() - beside);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        slice.draw(eye, projection(), haze, levels);
        const Image image = picture();
        int compared = 0, outer = 0, inner = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const auto at = [&](int i, int k) {
                    const Eigen::Vector3d p = static_cast<double>(haze.cut_a) * ray(i, k);
                    return sampled(grid, (model_from_eye * p.homogeneous()).head<3>());
                };
                const auto d = at(x, y), right = at(x + 1, y), up = at(x, y + 1);
                const auto c = pixel(image, x, y);
                if (!d || !right || !up) continue;
                // Within a pixel of a contour either side is right.
                const double fine = std::abs(*right - *d) + std::abs(*up - *d) + 0.01;
                if (std::abs(*d - 0.3) < fine || std::abs(*d - 1.1) < fine) continue;
                ++compared;
                outer += *d > 0.3 && *d < 1.1 ? 1 : 0;
                inner += *d > 1.1 ? 1 : 0;
                EXPECT_EQ(c[0] > 40, *d > 0.3 && *d < 1.1) << x << ", " << y << ": " << *d;
                EXPECT_EQ(c[2] > 40, *d > 1.1) << x << ", " << y << ": " << *d;
            }
        EXPECT_GT(outer, 100);
        EXPECT_GT(inner, 50);
        EXPECT_GT(compared, 1000);
    }
}

TEST_F(GuiCut, a_large_map_is_thinned_and_stays_in_place) {
    DensityGrid grid;
    grid.size = {1030, 12, 10};
    grid.spacing_m = Vec3(0.03e-10, 2e-10, 2e-10);
    grid.origin_m = Vec3(-15e-10, -11e-10, -9e-10);
    for (std::uint32_t i = 0; i < grid.size[1] * grid.size[2]; ++i)
        for (std::uint32_t x = 0; x < grid.size[0]; ++x) grid.values.push_back(x >= 700 ? 1.0F : 0.0F);
    DensitySlice slice(grid);
    EXPECT_EQ(slice.stride(), 3U);
    Eigen::Matrix4f scale = Eigen::Matrix4f::Identity();
    scale.topLeftCorner<3, 3>() *= 1e10F;
    const Haze haze = cut_at(camera_.distance_a());
    slice.draw(camera_.view() * scale, projection(), haze, std::array{DensitySlice::Level{0.5}});
    const Image image = picture();
    const Eigen::Matrix4d scene_from_eye = camera_.view().cast<double>().inverse();
    int there = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Eigen::Vector3d eye = static_cast<double>(haze.cut_a) * ray(x, y);
            const Eigen::Vector3d at_a = (scene_from_eye * eye.homogeneous()).head<3>();
            // The step is at x = 6 Å, in a box that ends at y = 11 and z = 9.
            if (std::abs(at_a.x() - 6.0) < 0.4 || std::abs(at_a.x()) > 15.0 || std::abs(at_a.y()) > 10.0 ||
                std::abs(at_a.z()) > 8.0)
                continue;
            there += at_a.x() > 6.0 ? 1 : 0;
            EXPECT_EQ(pixel(image, x, y)[0] > 40, at_a.x() > 6.0) << at_a.transpose();
        }
    EXPECT_GT(there, 200);
}

// A wall across the view, far to near.
class Walls {
public:
    void add(const std::array<Eigen::Vector3f, 4>& corner) {
        const auto first = static_cast<std::uint32_t>(vertex_.size() / 3);
        for (const Eigen::Vector3f& c : corner) vertex_.insert(vertex_.end(), {c.x(), c.y(), c.z()});
        for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) index_.push_back(first + k);
    }
    void draw(Programs& programs, const Eigen::Matrix4f& projection) {
        const float white[4] = {1.0F, 1.0F, 1.0F, 1.0F};
        programs.use_flat(Eigen::Matrix4f::Identity(), projection, {}, white);
        glBindVertexArray(array_.get());
        glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex_.size() * sizeof(float)), vertex_.data(),
                     GL_STATIC_DRAW);
        attribute(0, 3, GL_FLOAT, GL_FALSE, 12, 0);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(index_.size() * 4), index_.data(),
                     GL_STATIC_DRAW);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(index_.size()), GL_UNSIGNED_INT, nullptr);
        glBindVertexArray(0);
    }

private:
    GlVertexArray array_;
    GlBuffer vertices_, indices_;
    std::vector<float> vertex_;
    std::vector<std::uint32_t> index_;
};

TEST_F(GuiCut, shading_darkens_corners_and_outlines_and_leaves_open_places_alone) {
    Programs programs;
    RestShading shading;
    const float d = camera_.distance_a();
    const auto shaded = [&](bool corner, const Haze& haze) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glEnable(GL_DEPTH_TEST);
        Walls walls;
        walls.add({{{-12.0F, -12.0F, -d}, {12.0F, -12.0F, -d}, {12.0F, 9.0F, -d}, {-12.0F, 9.0F, -d}}});
        // Stands on the other, at x = 3; its left side is seen.
        if (corner)
            walls.add(
                {{{3.0F, -12.0F, -d}, {8.0F, -12.0F, -d + 8.0F}, {8.0F, 9.0F, -d + 8.0F}, {3.0F, 9.0F, -d}}});
        walls.draw(programs, projection());
        shading.shade(projection(), haze, 60.0F, 0, 0, kWidth, kHeight);
        return picture();
    };
    const auto column = [&](float x_a) {
        return static_cast<int>(
            std::lround(0.5 * kWidth * (1.0 + static_cast<double>(x_a / d * projection()(0, 0)))));
    };
    const int middle = kHeight / 2;
    const Image flat = shaded(false, {});
    for (int x = column(-10.0F); x <= column(10.0F); x += 5) EXPECT_GE(pixel(flat, x, middle)[0], 250) << x;
    EXPECT_EQ(pixel(flat, 2, 2)[0], 0) << "the background is as it was";
    const Image room = shaded(true, {});
    const int far_from_it = pixel(room, column(-8.0F), middle)[0],
              beside_it = pixel(room, column(2.6F), middle)[0];
    EXPECT_GE(far_from_it, 250);
    EXPECT_LT(beside_it, 215);
    // Nearer is darker.
    EXPECT_LT(beside_it, pixel(room, column(0.5F), middle)[0]);
    // Where everything has faded, so has the shading.
    Haze fog;
    fog.begin_a = 0.0F;
    fog.end_a = 1.0F;
    fog.strength = 1.0F;
    EXPECT_GE(pixel(shaded(true, fog), column(2.6F), middle)[0], 254);
}

TEST_F(GuiCut, an_outline_stands_on_the_nearer_side_of_a_jump) {
    Programs programs;
    RestShading shading;
    const float d = camera_.distance_a();
    Walls walls;
    walls.add({{{-12.0F, -12.0F, -d}, {12.0F, -12.0F, -d}, {12.0F, 9.0F, -d}, {-12.0F, 9.0F, -d}}});
    walls.add({{{-4.0F, -4.0F, -d + 9.0F},
                {4.0F, -4.0F, -d + 9.0F},
                {4.0F, 4.0F, -d + 9.0F},
                {-4.0F, 4.0F, -d + 9.0F}}});
    walls.draw(programs, projection());
    const std::vector<double> depth = distances();
    shading.shade(projection(), {}, camera_.radius_a(), 0, 0, kWidth, kHeight);
    const Image image = picture();
    int outlined = 0;
    for (int x = 1; x < kWidth - 1; ++x) {
        const auto i = static_cast<std::size_t>(kHeight / 2 * kWidth + x);
        const bool jumps = depth[i] > 0.0 && (depth[i - 1] > depth[i] + 5.0 || depth[i + 1] > depth[i] + 5.0);
        const int seen = pixel(image, x, kHeight / 2)[0];
        if (jumps) {
            EXPECT_LT(seen, 130) << x;
        }
        outlined += seen > 0 && seen < 130 ? 1 : 0;
    }
    EXPECT_EQ(outlined, 4) << "both walls, on both sides";
}

TEST(StillPictureMatte, tells_colour_and_opacity_from_two_backgrounds) {
    EXPECT_EQ(matted({0, 0, 0}, {255, 255, 255}), (std::array<std::uint8_t, 4>{0, 0, 0, 0}));
    EXPECT_EQ(matted({200, 10, 77}, {200, 10, 77}), (std::array<std::uint8_t, 4>{200, 10, 77, 255}));
    // 40 % of (250, 100, 0).
    EXPECT_EQ(matted({100, 40, 0}, {253, 193, 153}), (std::array<std::uint8_t, 4>{250, 100, 0, 102}));
    // Rounding may put black above white.
    EXPECT_EQ(matted({10, 10, 10}, {9, 10, 10}), (std::array<std::uint8_t, 4>{10, 10, 10, 255}));
}

// What is laid over a third background looks as if it had been drawn there.
TEST_F(GuiCut, a_transparent_picture_over_any_background_looks_as_drawn_there) {
    Programs programs;
    TriangleBuffers arrow;
    arrow.fill(build_arrow({-9.0F, -4.0F, 0.0F}, {18.0F, 9.0F, 3.0F}, 2.5F, {220, 120, 60}), GL_STATIC_DRAW);
    const auto draw = [&](int w, int h, bool many, const Eigen::Vector3f* ground) {
        EXPECT_EQ(w, many ? 2 * kWidth : kWidth);
        const Eigen::Vector3f g = ground != nullptr ? *ground : Eigen::Vector3f(0.2F, 0.4F, 0.6F);
        glViewport(0, 0, w, h);
        glClearColor(g.x(), g.y(), g.z(), 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
        Haze haze;
        haze.top = haze.bottom = g;
        haze.begin_a = camera_.distance_a() - 8.0F;
        haze.end_a = camera_.distance_a() + 8.0F;
        haze.strength = 0.8F;
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        programs.use_lit(camera_.view(), projection(), haze, {.opacity = 0.7F});
        arrow.draw();
        glDisable(GL_BLEND);
    };
    for (const double samples_max : {0.0, 1e9}) {
        const StillPicture clear = draw_still_picture(kWidth, kHeight, true, samples_max, draw),
                           there = draw_still_picture(kWidth, kHeight, false, samples_max, draw);
        ASSERT_EQ(clear.pixels.size(), std::size_t{4} * kWidth * kHeight);
        ASSERT_EQ(there.pixels.size(), std::size_t{3} * kWidth * kHeight);
        const std::array<double, 3> ground{51.0, 102.0, 153.0};
        int opaque = 0, partly = 0;
        for (std::size_t i = 0; i < std::size_t{kWidth} * kHeight; ++i) {
            const int a = clear.pixels[4 * i + 3];
            opaque += a > 150 ? 1 : 0;
            partly += a > 10 && a < 150 ? 1 : 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const double laid = (a * clear.pixels[4 * i + k] + (255 - a) * ground[k]) / 255.0;
                EXPECT_NEAR(laid, there.pixels[3 * i + k], 3.0) << i;
            }
        }
        EXPECT_EQ(clear.pixels[3], 0) << "nothing is drawn in the corner";
        EXPECT_GT(opaque + partly, 500);
        EXPECT_GT(partly, 20);
    }
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), target_->name());
}

}  // namespace
}  // namespace tact::gui_cut_test
