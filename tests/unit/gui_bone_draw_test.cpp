// Bone in the pixels: position of its surface, changes by drilling, structures, and refinement of a moving view.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "gui/drilling/bone_view.hpp"
#include "gui/drilling/microscope.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/elements.hpp"
#include "ipc/base/units.hpp"
#include "tests/support/bone_block.hpp"
#include "tests/unit/gui_canvas.hpp"

namespace tact::gui_bone_draw_test {
namespace {

constexpr int kWidth = 200, kHeight = 160;
constexpr std::uint32_t kEdge = 48, kAllRays = 1U << 30U;
constexpr double kBallRadius = 15.0;  // voxels, around the middle

Vec3 middle() { return Vec3::Constant(0.5 * kEdge - 0.5); }

class BoneDraw : public Canvas<kWidth, kHeight> {
protected:
    void SetUp() override {
        Canvas::SetUp();
        if (IsSkipped()) return;
        const auto ball = [](const Vec3& p) {
            return std::clamp(kBallRadius + 0.5 - (p - middle()).norm(), 0.0, 1.0);
        };
        block_.emplace(kEdge, 3e-4, ball, 1);
        drilled_ = block_->density;
        now_.bricks = block_->bricks;
        now_.density = drilled_;
        centre_model_m_ = block_->bricks.to_model(middle());
        BoneVolumeView baked = now_;
        baked.density = block_->density;
        bone_ = std::make_unique<BoneContent>(empty_scene(), baked, BoneLabelsView{},
                                              std::vector<DistanceField>{});
        camera_.frame(static_cast<float>(20.0 * 3e-4 / kAngstromM));
    }
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}); }

    static SceneFile empty_scene() {
        SceneMeta meta{};
        meta.kind = SceneKind::drilling;
        meta.world_per_model = 1.0;
        SceneWriter out;
        write_meta(out, meta, "made by a test\n");
        const std::filesystem::path path = std::filesystem::path(folder_) / "empty.tact";
        out.write(path);
        return SceneFile::open(path);
    }
    [[nodiscard]] BoneFrame frame(std::uint32_t rays) const {
        Haze none;
        none.end_a = 1e12F;
        return {camera_.view(),
                camera_.projection(static_cast<float>(kWidth) / kHeight),
                none,
                0,
                0,
                kWidth,
                kHeight,
                rays};
    }
    void draw(BoneView& view, std::uint32_t rays = kAllRays) const {
        glViewport(0, 0, kWidth, kHeight);
        glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        view.draw(frame(rays));
    }
    // Depth along the view in ångström; negative: background.
    [[nodiscard]] double depth_a(int x, int y) const {
        float seen = 1.0F;
        glReadPixels(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &seen);
        if (seen >= 1.0F) return -1.0;
        const Eigen::Matrix4f p = camera_.projection(static_cast<float>(kWidth) / kHeight);
        return static_cast<double>(p(2, 3)) /
               (2.0 * static_cast<double>(seen) - 1.0 + static_cast<double>(p(2, 2)));
    }
    static Rgb8 pixel(int x, int y) {
        Rgb8 c{};
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(x, y, 1, 1, GL_RGB, GL_UNSIGNED_BYTE, c.data());
        return c;
    }
    static std::size_t covered(const Image& image) {
        std::size_t n = 0;
        for (std::size_t i = 0; i < image.rgb.size(); i += 3)
            n += (image.rgb[i] | image.rgb[i + 1] | image.rgb[i + 2]) != 0 ? 1U : 0U;
        return n;
    }

    std::optional<BoneBlock> block_;
    std::vector<std::uint8_t> drilled_;
    BoneVolumeView now_;
    std::unique_ptr<BoneContent> bone_;
    Vec3 centre_model_m_ = Vec3::Zero();
    Camera camera_;
};

TEST_F(BoneDraw, the_depth_of_every_pixel_matches_the_surface_of_a_ball) {
    BoneView view(*bone_, centre_model_m_, now_);
    draw(view);
    EXPECT_TRUE(view.sharp());
    const Eigen::Matrix4d p = camera_.projection(static_cast<float>(kWidth) / kHeight).cast<double>();
    const double voxel_a = 3e-4 / kAngstromM;
    int hits = 0, wrong = 0;
    for (int y = 0; y < kHeight; y += 3)
        for (int x = 0; x < kWidth; x += 3) {
            const Eigen::Vector3d ray((2.0 * (x + 0.5) / kWidth - 1.0) / p(0, 0),
                                      (2.0 * (y + 0.5) / kHeight - 1.0) / p(1, 1), -1.0);
            const Eigen::Vector3d c(0.0, 0.0, -static_cast<double>(camera_.distance_a()));
            const double nearest = (c - ray * (c.dot(ray) / ray.squaredNorm())).norm() / voxel_a;
            const double z = depth_a(x, y);
            if ((z > 0.0) != (nearest < kBallRadius)) wrong += std::fabs(nearest - kBallRadius) > 0.6 ? 1 : 0;
            if (z <= 0.0) continue;
            ++hits;
            // The edge of the ball ramps over one voxel; its surface lies at a third of the ramp.
            if (nearest < 0.9 * kBallRadius) {
                EXPECT_NEAR((ray * z - c).norm() / voxel_a, kBallRadius + 0.2, 0.25) << x << ", " << y;
            }
        }
    EXPECT_GT(hits, 500);
    EXPECT_EQ(wrong, 0);
}

TEST_F(BoneDraw, drilling_redraws_only_the_changed_part) {
    BoneView view(*bone_, centre_model_m_, now_);
    draw(view);
    const double before = depth_a(kWidth / 2, kHeight / 2);
    const std::uint32_t whole = view.rays();
    draw(view);
    EXPECT_EQ(view.rays(), 0U) << "nothing changed";
    EXPECT_NEAR(depth_a(kWidth / 2, kHeight / 2), before, 1.0);
    // A shaft from the eye to the centre of the ball.
    const Vec3 towards = camera_.orientation().conjugate().cast<double>() * Vec3::UnitZ();
    std::set<std::uint32_t> bricks;
    for (std::uint32_t z = 0; z < kEdge; ++z)
        for (std::uint32_t y = 0; y < kEdge; ++y)
            for (std::uint32_t x = 0; x < kEdge; ++x) {
                const Vec3 d = Vec3(x, y, z) - middle();
                if (d.dot(towards) < 0.0 || (d - towards * d.dot(towards)).norm() > 3.0) continue;
                drilled_[block_->bricks.voxel(x, y, z)] = 0;
                bricks.insert(static_cast<std::uint32_t>(block_->bricks.brick(x, y, z)));
            }
    for (const std::uint32_t b : bricks) view.changed(b);
    draw(view);
    EXPECT_GT(view.rays(), 0U);
    EXPECT_LE(view.rays(), whole);
    EXPECT_NEAR((depth_a(kWidth / 2, kHeight / 2) - before) / (3e-4 / kAngstromM), kBallRadius, 1.5);
    draw(view);
    EXPECT_EQ(view.rays(), 0U);
}

TEST_F(BoneDraw, a_moving_view_is_coarse_and_refines_to_the_still_one) {
    BoneView still(*bone_, centre_model_m_, now_), moving(*bone_, centre_model_m_, now_);
    draw(still);
    const Image sharp = read_pixels(kWidth, kHeight);
    constexpr std::uint32_t kRays = 3000;
    camera_.rotate(7.0F, 3.0F, kHeight);
    draw(moving, kRays);
    camera_.frame(static_cast<float>(20.0 * 3e-4 / kAngstromM));
    draw(moving, kRays);
    EXPECT_LE(moving.rays(), kRays);
    EXPECT_FALSE(moving.sharp());
    const Image coarse = read_pixels(kWidth, kHeight);
    EXPECT_NEAR(static_cast<double>(covered(coarse)), static_cast<double>(covered(sharp)),
                0.1 * static_cast<double>(covered(sharp)));
    EXPECT_NE(coarse.rgb, sharp.rgb);
    int frames = 0;
    for (; frames < 40 && !moving.sharp(); ++frames) {
        draw(moving, kRays);
        EXPECT_LE(moving.rays(), 64U * 64U);
    }
    EXPECT_TRUE(moving.sharp());
    EXPECT_GT(frames, 2);
    draw(moving, kRays);
    EXPECT_EQ(read_pixels(kWidth, kHeight).rgb, sharp.rgb);
}

TEST_F(BoneDraw, a_soft_structure_appears_in_its_colour_after_the_bone_above_is_removed) {
    // The inner half of the ball is a nerve, with a density that renders as almost transparent in bone.
    std::vector<std::uint8_t> labels(block_->density.size());
    for (std::uint32_t z = 0; z < kEdge; ++z)
        for (std::uint32_t y = 0; y < kEdge; ++y)
            for (std::uint32_t x = 0; x < kEdge; ++x) {
                const std::size_t v = block_->bricks.voxel(x, y, z);
                if ((Vec3(x, y, z) - middle()).norm() > 0.5 * kBallRadius) continue;
                labels[v] = 1;
                block_->density[v] = drilled_[v] = 40;
            }
    bone_->labels.structure.push_back({"facial nerve", {255, 221, 64, 255}, true});
    bone_->labels.label = labels;
    BoneView view(*bone_, centre_model_m_, now_);
    draw(view);
    const Rgb8 bone = pixel(kWidth / 2, kHeight / 2);
    EXPECT_GT(bone[2], 0.6 * bone[0]) << "ivory";
    for (std::size_t v = 0; v < drilled_.size(); ++v)
        if (labels[v] == 0) drilled_[v] = 0;
    for (std::uint32_t b = 0; b < block_->bricks.brick_count(); ++b) view.changed(b);
    draw(view);
    const Rgb8 nerve = pixel(kWidth / 2, kHeight / 2);
    EXPECT_GT(nerve[0], 100);
    EXPECT_LT(nerve[2], 0.5 * nerve[0]) << "yellow";
    std::fill(drilled_.begin(), drilled_.end(), std::uint8_t{0});
    for (std::uint32_t b = 0; b < block_->bricks.brick_count(); ++b) view.changed(b);
    draw(view);
    EXPECT_EQ(pixel(kWidth / 2, kHeight / 2), (Rgb8{0, 0, 0}));
    EXPECT_LT(depth_a(kWidth / 2, kHeight / 2), 0.0);
}

TEST_F(BoneDraw, a_large_volume_is_uploaded_front_to_back_over_several_frames) {
    BoneView at_once(*bone_, centre_model_m_, now_), slowly(*bone_, centre_model_m_, now_);
    draw(at_once);
    EXPECT_EQ(at_once.filled(), 1.0F);
    const Image whole = read_pixels(kWidth, kHeight);
    const auto slabs = block_->bricks.bricks()[2];
    BoneFrame frame_of_no_time = frame(kAllRays);
    frame_of_no_time.fill_s = 0.0;
    // One texture per frame until the first slab can be drawn; changes meanwhile are not uploaded.
    for (int texture = 1; texture <= 3; ++texture) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        slowly.draw(frame_of_no_time);
        slowly.changed(0);
        EXPECT_EQ(slowly.filled(), 0.0F);
        EXPECT_FALSE(slowly.sharp());
        EXPECT_EQ(covered(read_pixels(kWidth, kHeight)), 0U);
        EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    }
    std::size_t seen = 0;
    for (std::uint32_t i = 1; i <= slabs; ++i) {
        EXPECT_FALSE(slowly.sharp());
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        slowly.draw(frame_of_no_time);
        EXPECT_FLOAT_EQ(slowly.filled(), static_cast<float>(i) / static_cast<float>(slabs));
        const std::size_t now = covered(read_pixels(kWidth, kHeight));
        EXPECT_GE(now + now / 50, seen);
        seen = now;
        if (i == slabs / 2) {
            EXPECT_GT(seen, 100U);
        }
        slowly.changed(0);  // not loaded yet: nothing is uploaded before its turn
    }
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    slowly.draw(frame_of_no_time);
    EXPECT_TRUE(slowly.sharp());
    EXPECT_EQ(read_pixels(kWidth, kHeight).rgb, whole.rgb);
}

// A slope of one voxel in six, of voxels that are bone or not: without smoothing its steps are stripes.
TEST_F(BoneDraw, a_segmented_slope_has_no_steps) {
    for (std::uint32_t z = 0; z < kEdge; ++z)
        for (std::uint32_t y = 0; y < kEdge; ++y)
            for (std::uint32_t x = 0; x < kEdge; ++x)
                block_->density[block_->bricks.voxel(x, y, z)] = drilled_[block_->bricks.voxel(x, y, z)] =
                    z < 20 + x / 6 ? 255 : 0;
    BoneView view(*bone_, centre_model_m_, now_);
    draw(view);
    const Image image = read_pixels(kWidth, kHeight);
    // Along the slope, in the middle of the picture: how much brightness goes to and fro.
    double to_and_fro = 0.0, rise = 0.0;
    for (int x = kWidth / 2 - 40; x < kWidth / 2 + 40; ++x) {
        const auto at = static_cast<std::size_t>(3 * (kHeight / 2 * kWidth + x));
        const double step = static_cast<double>(image.rgb[at + 3]) - image.rgb[at];
        to_and_fro += std::abs(step);
        rise += step;
    }
    EXPECT_LT(to_and_fro - std::abs(rise), 100.0) << "without smoothing it is 160";
    // A brick beside a change is drawn as changed, too.
    std::vector<std::uint32_t> hole;
    for (std::uint32_t z = 16; z < 32; ++z)
        for (std::uint32_t y = 16; y < 24; ++y)
            for (std::uint32_t x = 16; x < 24; ++x) {
                drilled_[block_->bricks.voxel(x, y, z)] = 0;
                hole.push_back(static_cast<std::uint32_t>(block_->bricks.brick(x, y, z)));
            }
    for (const std::uint32_t b : hole) view.changed(b);
    draw(view);
    const Image now = read_pixels(kWidth, kHeight);
    BoneView anew(*bone_, centre_model_m_, now_);
    draw(anew);
    EXPECT_EQ(read_pixels(kWidth, kHeight).rgb, now.rgb);
}

TEST_F(BoneDraw, a_wet_place_is_darker_a_stain_is_red_and_only_they_are_drawn_again) {
    BoneView view(*bone_, centre_model_m_, now_);
    draw(view);
    const std::uint32_t whole = view.rays();
    const Image dry = read_pixels(kWidth, kHeight);
    // On the ball, a little beside the middle of the picture, so that no highlight covers it.
    const Eigen::Quaterniond q = camera_.orientation().conjugate().cast<double>();
    const auto on_ball = [&](double right) {
        const Vec3 off = q * Vec3(right, 0.0, std::sqrt(1.0 - right * right));
        return Vec3(middle() + (kBallRadius + 1.0) * off);
    };
    const Vec3 water = on_ball(-0.55), blood = on_ball(0.55);
    WetBone wet(block_->bricks);
    const ParticleCells cells(block_->bricks, {}, 16);
    std::vector<Particle> drops;
    for (const Matter matter : {Matter::water, Matter::blood})
        for (int i = 0; i < 40; ++i) {
            const Vec3 at = (matter == Matter::water ? water : blood).array() + 16.5;
            Particle drop{};
            for (int axis = 0; axis < 3; ++axis)
                drop.at[static_cast<std::size_t>(axis)] =
                    static_cast<float>(at[axis] + 4.0 * (i >> axis & 1) - 2.0);
            drop.matter = matter;
            drops.push_back(drop);
        }
    wet.step(1.0, drops, cells);
    view.wetted(wet);
    draw(view);
    EXPECT_GT(view.rays(), 0U);
    EXPECT_LE(view.rays(), whole);
    const Image now = read_pixels(kWidth, kHeight);
    const auto change = [&](const Vec3& voxel, std::size_t channel) {
        const Eigen::Matrix4d p = camera_.projection(static_cast<float>(kWidth) / kHeight).cast<double>();
        const Vec3 scene_a = (block_->bricks.to_model(voxel) - centre_model_m_) / kAngstromM;
        const Eigen::Vector4d clip = p * camera_.view().cast<double>() * scene_a.homogeneous();
        const auto x = static_cast<std::size_t>((0.5 + 0.5 * clip.x() / clip.w()) * kWidth),
                   y = static_cast<std::size_t>((0.5 - 0.5 * clip.y() / clip.w()) * kHeight);
        const std::size_t at = 3 * (y * kWidth + x) + channel;
        return static_cast<double>(now.rgb[at]) / dry.rgb[at];
    };
    EXPECT_LT(change(water, 1), 0.92);
    EXPECT_GT(change(water, 1), 0.6);
    EXPECT_LT(change(blood, 1), 0.6) << "less green";
    EXPECT_GT(change(blood, 0), 1.35 * change(blood, 1)) << "than red";
    EXPECT_NEAR(change(middle() + (kBallRadius + 1.0) * (q * Vec3(0.0, 0.8, 0.6)), 1), 1.0, 0.02);
    draw(view);
    EXPECT_EQ(view.rays(), 0U) << "wetted once";
}

TEST_F(BoneDraw, a_microscope_blurs_what_is_out_of_its_focus_and_lights_along_the_view) {
    // Stripes of two colours, two voxels wide.
    std::vector<std::uint8_t> labels(block_->density.size());
    for (std::uint32_t z = 0; z < kEdge; ++z)
        for (std::uint32_t y = 0; y < kEdge; ++y)
            for (std::uint32_t x = 0; x < kEdge; ++x)
                if (block_->density[block_->bricks.voxel(x, y, z)] > 0)
                    labels[block_->bricks.voxel(x, y, z)] =
                        static_cast<std::uint8_t>(1 + (x + y + z) / 3 % 2);
    bone_->labels.structure.push_back({"dark", {40, 40, 40, 255}, false});
    bone_->labels.structure.push_back({"bright", {230, 230, 230, 255}, false});
    bone_->labels.label = labels;
    BoneView view(*bone_, centre_model_m_, now_);
    draw(view);
    const double at_a = depth_a(kWidth / 2, kHeight / 2);
    Microscope microscope;
    const auto seen = [&](bool coaxial, double focus_a) {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        BoneFrame f = frame(kAllRays);
        f.coaxial_light = coaxial;
        view.draw(f);
        if (focus_a > 0.0)
            microscope.draw({0, 0, kWidth, kHeight, f.projection, static_cast<float>(focus_a)});
        return read_pixels(kWidth, kHeight);
    };
    // How sharp edges are: second differences in the middle of the picture.
    const auto detail = [](const Image& image) {
        double sum = 0.0;
        for (int y = kHeight / 2 - 15; y < kHeight / 2 + 15; ++y)
            for (int x = kWidth / 2 - 15; x < kWidth / 2 + 15; ++x) {
                const auto at = static_cast<std::size_t>(3 * (y * kWidth + x));
                sum += std::abs(static_cast<double>(image.rgb[at - 3]) - 2.0 * image.rgb[at] +
                                image.rgb[at + 3]);
            }
        return sum;
    };
    const Image plain = seen(false, 0.0);
    EXPECT_GT(detail(plain), 5.0 * 900.0);
    EXPECT_GT(detail(seen(false, at_a)), 0.9 * detail(plain));
    EXPECT_LT(detail(seen(false, 2.0 * at_a)), 0.6 * detail(plain));
    EXPECT_EQ(seen(false, 0.0).rgb, plain.rgb) << "and back";
    // Mean brightness of the ball's left and right half.
    const auto side = [](const Image& image, int x0) {
        double sum = 0.0;
        for (int y = kHeight / 2 - 20; y < kHeight / 2 + 20; ++y)
            for (int x = x0; x < x0 + 12; ++x)
                sum += image.rgb[static_cast<std::size_t>(3 * (y * kWidth + x))];
        return sum;
    };
    const auto lopsided = [&](const Image& image) {
        return side(image, kWidth / 2 + 25) / side(image, kWidth / 2 - 37);
    };
    EXPECT_GT(lopsided(plain), 1.3 * lopsided(seen(true, 0.0))) << "the lamp of the room stands on the right";
}

TEST_F(BoneDraw, a_microscope_has_a_round_field) {
    Microscope microscope;
    glViewport(0, 0, kWidth, kHeight);
    glClearColor(1.0F, 1.0F, 1.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    microscope.draw({0, 0, kWidth, kHeight, camera_.projection(static_cast<float>(kWidth) / kHeight), 0.0F});
    const double radius = 0.495 * kHeight;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double r = std::hypot(x + 0.5 - 0.5 * kWidth, y + 0.5 - 0.5 * kHeight);
            const Rgb8 seen = pixel(x, y);
            const bool right = r > radius + 1.0   ? seen == Rgb8{0, 0, 0}
                               : r < 0.5 * radius ? seen == Rgb8{255, 255, 255}
                               : r < radius - 3.0 ? seen[0] > 120
                                                  : true;
            ASSERT_TRUE(right) << x << ", " << y;
        }
}

TEST_F(BoneDraw, the_bound_frame_buffer_is_restored) {
    BoneView view(*bone_, centre_model_m_, now_);
    GLint before = 0, after = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
    draw(view);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &after);
    EXPECT_EQ(before, after);
    EXPECT_GT(covered(read_pixels(kWidth, kHeight)), 1000U);
}

}  // namespace
}  // namespace tact::gui_bone_draw_test
