// Dust, water and blood in the pixels.
#include <gtest/gtest.h>

#include <filesystem>

#include "gui/drilling/drilling_layer.hpp"
#include "gui/drilling/particle_cloud.hpp"
#include "gui/drilling/particle_pace.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/scene_view.hpp"
#include "ipc/base/units.hpp"
#include "tests/unit/gui_canvas.hpp"

namespace tact::gui_cloud_test {
namespace {

constexpr int kWidth = 160, kHeight = 120;

Particle particle(Matter matter, float x, float y, float z) {
    Particle p{};
    p.at = {x, y, z};
    p.matter = matter;
    return p;
}

// A slab of `layers` layers across the view with its front face at z = 0.
std::vector<Particle> slab(Matter matter, int layers) {
    std::vector<Particle> all;
    for (int z = 0; z < layers; ++z)
        for (int y = -14; y <= 14; ++y)
            for (int x = -14; x <= 14; ++x)
                all.push_back(
                    particle(matter, static_cast<float>(x), static_cast<float>(y), static_cast<float>(-z)));
    return all;
}

TEST(ParticleDots, grains_come_first_and_fluids_have_a_bounding_box) {
    const std::vector<Particle> particles{
        particle(Matter::water, 1, 2, 3), particle(Matter::dust, 90, 90, 90),
        particle(Matter::blood, -4, 5, 6), particle(Matter::paste, 7, 8, 9)};
    std::vector<ParticleDot> dots;
    const DotRanges r = build_dots(particles, dots);
    ASSERT_EQ(r.grains, 1U);
    ASSERT_EQ(r.fluids, 3U);
    EXPECT_EQ(dots[0].matter, Matter::dust);
    EXPECT_EQ(r.fluids_low, (std::array{-4.0F, 2.0F, 3.0F}));
    EXPECT_EQ(r.fluids_high, (std::array{7.0F, 8.0F, 9.0F}));
    EXPECT_EQ(build_dots({}, dots).fluids, 0U);
    EXPECT_TRUE(dots.empty());
}

TEST(ParticlePace, falls_at_once_recovers_slowly_and_ignores_the_cost_of_pixels) {
    ParticlePace pace;
    EXPECT_EQ(pace.most(), 12000U);
    for (int i = 0; i < 10; ++i) pace.took(1000, 0.005);  // almost all of the time is per pixel
    EXPECT_GT(pace.most(), 11000U);
    for (int i = 0; i < 5; ++i) pace.took(12000, 0.1);
    EXPECT_EQ(pace.most(), ParticlePace::kLeast);
    for (int i = 0; i < 5; ++i) pace.took(5000, 0.004);
    EXPECT_EQ(pace.most(), ParticlePace::kLeast);
    for (int i = 0; i < 200; ++i) pace.took(5000, 0.004);
    EXPECT_GT(pace.most(), 40000U);
    pace.took(2000, 1e30);
    pace.took(3, 1.0);
    EXPECT_GE(pace.most(), ParticlePace::kLeast);
}

class GuiCloud : public Canvas<kWidth, kHeight> {
protected:
    void SetUp() override {
        Canvas::SetUp();
        if (IsSkipped()) return;
        camera_.frame(12.0F);
        // Along -z: x and y of a particle are those of the image.
        view_.eye_from_cells = Eigen::Matrix4f::Identity();
        view_.eye_from_cells(2, 3) = -camera_.distance_a();
        view_.projection = camera_.projection(static_cast<float>(kWidth) / kHeight);
        view_.width_px = kWidth;
        view_.height_px = kHeight;
        cloud_ = std::make_unique<ParticleCloud>();
    }
    void TearDown() override {
        cloud_.reset();
        EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    }
    // Draws on white with a background at this depth in clip space (1: no background).
    Image picture(std::span<const Particle> particles, double depth = 1.0) {
        glViewport(0, 0, kWidth, kHeight);
        glClearColor(1.0F, 1.0F, 1.0F, 1.0F);
        glClearDepth(depth);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glClearDepth(1.0);
        cloud_->fill(particles);
        cloud_->draw(view_);
        GLint frame = 0;
        glGetIntegerv(GL_FRAMEBUFFER_BINDING, &frame);
        EXPECT_EQ(glIsEnabled(GL_SCISSOR_TEST), GL_FALSE);
        EXPECT_EQ(glIsEnabled(GL_BLEND), GL_FALSE);
        target_->bind();
        GLint own = 0;
        glGetIntegerv(GL_FRAMEBUFFER_BINDING, &own);
        EXPECT_EQ(frame, own);
        return read_pixels(kWidth, kHeight);
    }
    // Depth in clip space for this z of particles.
    double depth_at(float z) const {
        const Eigen::Vector4f clip =
            view_.projection * (view_.eye_from_cells * Eigen::Vector4f(0.0F, 0.0F, z, 1.0F));
        return 0.5 + 0.5 * static_cast<double>(clip.z() / clip.w());
    }
    static std::array<int, 3> middle(const Image& image) {
        const std::size_t at = std::size_t{3} * (kHeight / 2 * kWidth + kWidth / 2);
        return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
    }
    static std::size_t touched(const Image& image) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < image.rgb.size(); i += 3)
            count += image.rgb[i] != 255 || image.rgb[i + 1] != 255 || image.rgb[i + 2] != 255 ? 1U : 0U;
        return count;
    }

    std::unique_ptr<ParticleCloud> cloud_;
    Camera camera_;
    ParticleCloud::View view_;
};

TEST_F(GuiCloud, no_particles_draw_nothing) { EXPECT_EQ(touched(picture({})), 0U); }

TEST_F(GuiCloud, blood_hides_the_background_and_water_does_not) {
    const auto blood = middle(picture(slab(Matter::blood, 3))),
               water = middle(picture(slab(Matter::water, 3)));
    EXPECT_GT(blood[0], 50);
    EXPECT_LT(blood[1], 60);
    EXPECT_LT(blood[2], 60);
    for (const int c : water) EXPECT_GT(c, 150);
    EXPECT_GT(touched(picture(slab(Matter::water, 3))), 2000U);  // but water is visible
    const auto dust = middle(picture(slab(Matter::dust, 1)));
    EXPECT_GT(dust[0], dust[2]);  // ivory
    const auto paste = middle(picture(slab(Matter::paste, 3)));
    EXPECT_GT(paste[0], paste[2] + 10);
    EXPECT_GT(paste[1], 80);
}

TEST_F(GuiCloud, particles_behind_the_scene_are_not_drawn) {
    for (const Matter matter : {Matter::dust, Matter::water, Matter::blood, Matter::paste}) {
        const std::vector<Particle> particles = slab(matter, 2);
        EXPECT_GT(touched(picture(particles, depth_at(-6.0F))), 2000U) << static_cast<int>(matter);
        EXPECT_EQ(touched(picture(particles, depth_at(4.0F))), 0U) << static_cast<int>(matter);
    }
}

TEST_F(GuiCloud, touching_drops_merge_and_distant_ones_do_not) {
    const auto gap = [&](float apart) {
        const std::array drops{particle(Matter::blood, -0.5F * apart, 0, 0),
                               particle(Matter::blood, 0.5F * apart, 0, 0)};
        return middle(picture(drops))[1];
    };
    EXPECT_LT(gap(1.0F), 150);
    EXPECT_EQ(gap(8.0F), 255);
}

TEST_F(GuiCloud, another_view_size_or_a_close_eye_does_no_harm) {
    const std::vector<Particle> particles = slab(Matter::water, 2);
    view_.x_px = 40;
    view_.y_px = 30;
    view_.width_px = 61;
    view_.height_px = 43;
    EXPECT_GT(touched(picture(particles)), 500U);
    view_.eye_from_cells(2, 3) = -0.5F;  // the eye is inside
    static_cast<void>(picture(particles));
    view_.eye_from_cells(2, 3) = 50.0F;  // the particles are behind the eye
    EXPECT_EQ(touched(picture(particles)), 0U);
}

TEST_F(GuiCloud, a_scene_draws_no_more_particles_than_its_limit) {
    BoneBricks bricks;
    bricks.size = {32, 32, 32};
    bricks.voxel_m = 3e-4;
    Particles particles(bricks, {}, {.most = 5000});
    for (int i = 0; i < 3000; ++i) {
        const Vec3 at(2 + i % 28, 2 + i / 28 % 28, 14 + i / 784);
        ASSERT_TRUE(particles.emit(Matter::dust, bricks.to_model(at), Vec3::Zero()));
    }
    const auto content = std::make_shared<SceneContent>();
    content->centre_model_m = bricks.to_model(Vec3::Constant(16.0));
    Programs programs;
    SceneView view(content, programs);
    DrillingLayer layer(content->centre_model_m);
    view.set_layer(&layer);
    camera_.frame(static_cast<float>(16.0 * bricks.voxel_m / kAngstromM));
    ViewFrame frame;
    frame.width_px = kWidth;
    frame.height_px = kHeight;
    layer.frame.particles = &particles;
    const auto covered = [&] {
        target_->bind();
        glViewport(0, 0, kWidth, kHeight);
        glClearColor(1.0F, 1.0F, 1.0F, 1.0F);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        view.draw(camera_.eye(static_cast<float>(kWidth) / kHeight), {}, frame);
        return touched(read_pixels(kWidth, kHeight));
    };
    EXPECT_GT(covered(), 2000U);
    particles.keep_at_most(0);
    EXPECT_EQ(particles.all().size(), 3000U);
    EXPECT_EQ(covered(), 0U);
}

}  // namespace
}  // namespace tact::gui_cloud_test
