// What the visual levels change on the screen, and what is drawn once and copied.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "gui/docking/docking_layer.hpp"
#include "gui/render/backdrop.hpp"
#include "gui/render/camera.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/render/view_target.hpp"
#include "gui/window/load_scene.hpp"
#include "gui/window/panel_image.hpp"
#include "gui/window/still_view.hpp"
#include "tests/unit/gui_canvas.hpp"
#include "tests/unit/gui_fake.hpp"
#include "tests/unit/gui_wait.hpp"

namespace tact::gui_detail_test {
namespace {

using std::chrono::milliseconds;

constexpr int kWidth = 320, kHeight = 240;

// Number of pixels that differ.
std::size_t differing(const Image& a, const Image& b) {
    EXPECT_EQ(a.rgb.size(), b.rgb.size());
    std::size_t n = 0;
    for (std::size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); i += 3)
        n += std::equal(a.rgb.begin() + static_cast<std::ptrdiff_t>(i),
                        a.rgb.begin() + static_cast<std::ptrdiff_t>(i) + 3,
                        b.rgb.begin() + static_cast<std::ptrdiff_t>(i))
                 ? 0
                 : 1;
    return n;
}

void clear(float r, float g, float b) {
    glDisable(GL_SCISSOR_TEST);
    glClearColor(r, g, b, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

class GuiDetail : public Canvas<kWidth, kHeight> {
protected:
    void SetUp() override {
        Canvas::SetUp();
        if (IsSkipped()) return;
        glUseProgram(0);  // not one that an earlier case destroyed
        glViewport(0, 0, kWidth, kHeight);
        clear(0.0F, 0.0F, 0.0F);
    }
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}); }
    static Image picture() { return read_pixels(kWidth, kHeight); }
};

// --- drawn once, then copied ---

TEST_F(GuiDetail, the_background_is_drawn_again_only_when_its_size_or_colour_changes) {
    Programs programs;
    Backdrop backdrop;
    const auto shown = [&](const std::optional<Eigen::Vector3f>& plain, int x_px, int width_px) {
        clear(1.0F, 0.0F, 0.0F);
        backdrop.show(programs, plain, x_px, 20, width_px, 200);
        return picture();
    };
    const Image first = shown({}, 10, 200), again = shown({}, 10, 200);
    EXPECT_EQ(differing(first, again), 0U);
    EXPECT_EQ(backdrop.drawn(), 1U);
    static_cast<void>(shown({}, 40, 200));  // elsewhere, but of the same size
    EXPECT_EQ(backdrop.drawn(), 1U);
    const Image wider = shown({}, 10, 220);
    EXPECT_EQ(backdrop.drawn(), 2U);
    EXPECT_GE(differing(first, wider), 20U * 200U);
    const Image green = shown(Eigen::Vector3f(0.0F, 1.0F, 0.0F), 10, 220);
    EXPECT_EQ(backdrop.drawn(), 3U);
    EXPECT_GE(differing(green, wider), 220U * 200U);
    const std::size_t inside = 3 * (std::size_t{120} * kWidth + 100);
    EXPECT_EQ(green.rgb[inside + 1], 255);
    EXPECT_EQ(green.rgb[inside], 0);
    static_cast<void>(shown(Eigen::Vector3f(0.0F, 1.0F, 0.0F), 10, 220));
    EXPECT_EQ(backdrop.drawn(), 3U);
    EXPECT_EQ(differing(shown({}, 10, 220), wider), 0U);
}

TEST_F(GuiDetail, a_saved_area_comes_back_as_it_was_and_nothing_around_it_changes) {
    glEnable(GL_SCISSOR_TEST);  // something without symmetry
    glScissor(30, 40, 25, 60);
    glClearColor(0.0F, 1.0F, 1.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    const Image before = picture();
    SavedArea area;
    EXPECT_FALSE(area.fits(100, 90));
    area.save(20, 30, 100, 90);
    EXPECT_TRUE(area.fits(100, 90));
    EXPECT_FALSE(area.fits(100, 91));
    clear(0.0F, 0.0F, 0.0F);
    area.restore(20, 30);
    EXPECT_EQ(differing(before, picture()), 0U);
    area.forget();
    EXPECT_FALSE(area.fits(100, 90));
}

// One card on the left, and a line of text over the view.
class Panels {
public:
    explicit Panels(Window& window) : window_(window) {
        layout_ = {{80.0F, 0.0F, 240.0F, 180.0F}, {4.0F, 4.0F, 72.0F, 232.0F},    {4.0F, 4.0F, 0.0F, 0.0F},
                   {4.0F, 4.0F, 0.0F, 0.0F},      {80.0F, 180.0F, 236.0F, 56.0F}, {4.0F, 4.0F, 0.0F, 0.0F}};
    }
    void draw(ImU32 card, ImU32 over) {
        static_cast<void>(window_.take_input());
        window_.begin_panels(theme_);
        ImGui::SetNextWindowPos({4.0F, 4.0F});
        ImGui::SetNextWindowSize({72.0F, 232.0F});
        ImGui::Begin("card", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground);
        ImGui::GetWindowDrawList()->AddRectFilled({10.0F, 10.0F}, {60.0F, 100.0F}, card);
        ImGui::End();
        ImGui::GetBackgroundDrawList()->AddRectFilled({100.0F, 20.0F}, {200.0F, 60.0F}, over);
        ImGui::Render();
        image.draw(*ImGui::GetDrawData(), layout_, 1.0F, kWidth, kHeight);
    }
    bool show() { return image.show(layout_, 1.0F, kWidth, kHeight); }

    PanelImage image;

private:
    Window& window_;
    Layout layout_{};
    inline static Theme theme_;  // the backend keeps its fonts
};

Rgb8 at(const Image& image, std::size_t x, std::size_t y) {
    const std::size_t i = 3 * (y * image.width_px + x);
    return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

TEST_F(GuiDetail, cards_are_copied_and_what_lies_over_the_view_is_drawn_every_frame) {
    Panels panels(*window_);
    target_->bind();
    EXPECT_FALSE(panels.show());
    constexpr ImU32 kRed = IM_COL32(255, 0, 0, 255), kGreen = IM_COL32(0, 255, 0, 255),
                    kBlue = IM_COL32(0, 0, 255, 255);
    panels.draw(kRed, kGreen);
    const Image drawn = picture();
    EXPECT_EQ(at(drawn, 30, 50), (Rgb8{255, 0, 0}));
    EXPECT_EQ(at(drawn, 150, 40), (Rgb8{0, 255, 0}));
    clear(0.0F, 0.0F, 0.0F);
    ASSERT_TRUE(panels.show());
    const Image copied = picture();
    EXPECT_EQ(at(copied, 30, 50), (Rgb8{255, 0, 0}));
    EXPECT_EQ(at(copied, 150, 40), (Rgb8{0, 0, 0}));  // the view's
    panels.image.draw_over();
    EXPECT_EQ(differing(picture(), drawn), 0U);
    panels.draw(kBlue, kGreen);  // the card changes
    clear(0.0F, 0.0F, 0.0F);
    ASSERT_TRUE(panels.show());
    EXPECT_EQ(at(picture(), 30, 50), (Rgb8{0, 0, 255}));
    panels.image.forget();
    EXPECT_FALSE(panels.show());
}

TEST_F(GuiDetail, panels_are_drawn_twelve_times_a_second_and_at_once_after_input) {
    Panels panels(*window_);
    target_->bind();
    Instant now = Instant{} + std::chrono::hours(1);
    PanelImage& image = panels.image;
    EXPECT_TRUE(image.due(now, false));  // nothing is saved yet
    panels.draw(0, 0);
    const auto drawn_in = [&](Duration length, bool input) {
        int drawn = 0;
        for (const Instant end = now + length; now < end; now += milliseconds(5))
            drawn += image.due(now, input) ? 1 : 0;
        return drawn;
    };
    EXPECT_NEAR(drawn_in(std::chrono::seconds(2), false), 2.0 * PanelImage::kPanelHz, 2.0);
    EXPECT_TRUE(image.due(now, true));
    // Every frame, for as long as a hand may still be at it.
    EXPECT_EQ(drawn_in(PanelImage::kAfterInput, false), 50);
    now += milliseconds(10);
    EXPECT_LT(drawn_in(milliseconds(500), false), 8);
}

// --- levels ---

class GuiLevels : public GuiDetail {
protected:
    void SetUp() override {
        GuiDetail::SetUp();
        if (IsSkipped()) return;
        const std::filesystem::path path = std::filesystem::path(folder_) / "levels.tact";
        fake::write_helix_scene(path, 40);
        content_ = load_scene(path);
        programs_ = std::make_unique<Programs>();
        view_ = std::make_unique<SceneView>(content_, *programs_);
        layer_ = std::make_unique<DockingLayer>(content_, *programs_);
        view_->set_layer(layer_.get());
        view_->approach_vertices(view_->vertices_max(), 1e9);
        view_->upload();
        camera_.frame(view_->radius_a());
        body_ = {Pose{docking_of(*content_).bodies[0].home()}, 0, 1, false};
        layer_->frame.codebook = layer_->frame.graph = false;
        layer_->frame.bodies = std::span(&body_, 1);
        options_.smooth_edges = false;
    }
    void TearDown() override {
        layer_.reset();
        view_.reset();
        programs_.reset();
        GuiDetail::TearDown();
    }
    [[nodiscard]] EyeView eye() const {
        return camera_.eye(static_cast<float>(kWidth) / static_cast<float>(kHeight));
    }
    Image drawn(int width_px = kWidth, int height_px = kHeight) {
        glViewport(0, 0, width_px, height_px);
        ViewFrame frame{};
        frame.width_px = width_px;
        frame.height_px = height_px;
        // Surfaces are computed in the background.
        EXPECT_TRUE(test::wait_for([&] {
            clear(0.0F, 0.0F, 0.0F);
            view_->draw(eye(), options_, frame);
            return layer_->molecules().surfaces_awaited() == 0;
        }));
        return picture();
    }

    std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<Programs> programs_;
    std::unique_ptr<SceneView> view_;
    std::unique_ptr<DockingLayer> layer_;
    DrawnBody body_;
    Camera camera_;
    ViewOptions options_;
};

TEST_F(GuiLevels, gui_molecules_changes_triangles_and_picture_in_every_style) {
    options_.surface = false;
    for (const MoleculeStyle style :
         {MoleculeStyle::trace, MoleculeStyle::tube, MoleculeStyle::sticks, MoleculeStyle::spheres,
          MoleculeStyle::cartoon, MoleculeStyle::surface}) {
        Molecules& molecules = layer_->molecules();
        molecules.set_look({style, Colouring::chain});
        molecules.set_level(1.0F);
        const Image full = drawn();
        const std::uint32_t most = molecules.triangles();
        EXPECT_EQ(most, molecules.triangles_max());
        EXPECT_GT(most, 0U);
        std::uint32_t before = most;
        for (const float level : {0.7F, 0.45F, 0.17F}) {
            molecules.set_level(level);
            static_cast<void>(drawn());
            EXPECT_LE(molecules.triangles(), before) << static_cast<int>(style) << ", " << level;
            EXPECT_EQ(molecules.triangles_max(), most);
            before = molecules.triangles();
        }
        if (style == MoleculeStyle::sticks)
            continue;  // the helix has no bonds: single atoms are always drawn
        EXPECT_LE(before, most / 2) << static_cast<int>(style);
        EXPECT_GT(differing(full, drawn()), 50U) << static_cast<int>(style);
        molecules.set_level(1.0F);
        EXPECT_EQ(differing(full, drawn()), 0U);
    }
}

TEST_F(GuiLevels, gui_mesh_changes_triangles_and_picture_and_a_refined_view_shows_all_of_it_meanwhile) {
    layer_->frame.bodies = {};
    const Image full = drawn();
    const std::uint32_t triangles = view_->triangles(), few = view_->vertices_max() / 8;
    view_->approach_vertices(few, 1e9);
    view_->upload();
    const Image coarse = drawn();
    EXPECT_EQ(view_->vertices(), few);
    EXPECT_LT(view_->triangles(), triangles / 4);
    EXPECT_GT(differing(full, coarse), 500U);
    view_->contours().set_refined(true);
    EXPECT_EQ(differing(full, drawn()), 0U);
    EXPECT_EQ(view_->vertices(), few);  // counts are of the level
    view_->contours().set_refined(false);
    EXPECT_EQ(differing(coarse, drawn()), 0U);
}

TEST_F(GuiLevels, glass_shows_the_walls_towards_the_eye_and_not_those_behind) {
    layer_->frame.bodies = {};
    options_.style = SurfaceStyle::glass;
    options_.surface = false;
    const Image nothing = drawn();
    options_.surface = true;
    EXPECT_GT(differing(nothing, drawn()), 2000U);
    camera_.approach(Eigen::Vector3f::Zero(), 0.2F);  // inside the contour
    EXPECT_EQ(differing(nothing, drawn()), 0U);
    options_.style = SurfaceStyle::solid;
    EXPECT_GT(differing(nothing, drawn()), 2000U);
}

TEST_F(GuiLevels, gui_resolution_changes_pixels_and_picture_but_not_what_is_seen) {
    const Image full = drawn();
    ViewTarget target;
    const ViewSize most{kWidth, kHeight};
    std::size_t before = 0;
    for (const double share : {0.8, 0.5, 0.25}) {
        const ViewSize size = ViewSize::of_share(kWidth, kHeight, share);
        EXPECT_NEAR(size.pixels(), share * most.pixels(), 0.01 * most.pixels());
        target.begin(size, most);
        clear(0.0F, 0.0F, 0.0F);
        ViewFrame frame{};
        frame.width_px = size.width_px;
        frame.height_px = size.height_px;
        view_->draw(eye(), options_, frame);
        target.show(target_->name(), 0, 0, kWidth, kHeight);
        target_->bind();
        const Image enlarged = picture();
        const std::size_t changed = differing(full, enlarged);
        EXPECT_GT(changed, before);
        before = changed / 2;
        // The mean of the picture stays, and so does every place: blocks of sixteen pixels agree.
        for (std::size_t y = 0; y + 16 <= kHeight; y += 16)
            for (std::size_t x = 0; x + 16 <= kWidth; x += 16) {
                double sum = 0.0;
                for (std::size_t k = 0; k < 256; ++k)
                    for (std::size_t c = 0; c < 3; ++c)
                        sum += at(enlarged, x + k % 16, y + k / 16)[c] - at(full, x + k % 16, y + k / 16)[c];
                EXPECT_LT(std::abs(sum / 768.0), 14.0) << share << ": " << x << ", " << y;
            }
    }
    EXPECT_EQ(ViewSize::of_share(kWidth, kHeight, 1.0).pixels(), most.pixels());
    EXPECT_EQ(ViewSize::of_share(3, 1, 0.0).pixels(), 1U);
}

TEST_F(GuiLevels, enlarging_keeps_areas_and_puts_no_halo_around_an_edge) {
    ViewTarget target;
    const ViewSize half{kWidth / 2, kHeight / 2};
    target.begin(half, {kWidth, kHeight});
    clear(0.2F, 0.4F, 0.6F);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, kWidth / 4, kHeight / 2);
    glClearColor(0.8F, 0.4F, 0.2F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    target.show(target_->name(), 0, 0, kWidth, kHeight);
    target_->bind();
    const Image image = picture();
    for (std::size_t y = 0; y < kHeight; ++y)
        for (std::size_t x = 0; x < kWidth; ++x) {
            const Rgb8 c = at(image, x, y);
            ASSERT_GE(c[0], 50) << x;
            ASSERT_LE(c[0], 205) << x;
            ASSERT_NEAR(c[1], 102, 1) << x;
            if (x + 2 < kWidth / 2) {
                ASSERT_NEAR(c[0], 204, 1) << x;
            } else if (x > kWidth / 2 + 2) {
                ASSERT_NEAR(c[0], 51, 1) << x;
            }
        }
}

// --- a view at rest ---

TEST_F(GuiDetail, a_view_is_refined_once_it_rests_and_drawn_again_when_anything_changes) {
    StillView still;
    Instant now = Instant{} + std::chrono::hours(1);
    using Step = StillView::Step;
    EXPECT_EQ(still.next(7, now), Step::at_levels);
    EXPECT_EQ(still.next(7, now + StillView::kAfter - milliseconds(1)), Step::at_levels);
    now += StillView::kAfter;
    EXPECT_EQ(still.next(7, now), Step::refine);
    clear(0.0F, 1.0F, 0.0F);
    still.keep(0, 0, kWidth, kHeight);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(still.next(7, now += milliseconds(10)), Step::copy);
    clear(0.0F, 0.0F, 0.0F);
    still.show(0, 0);
    EXPECT_EQ(at(picture(), 100, 100), (Rgb8{0, 255, 0}));
    EXPECT_EQ(still.next(8, now), Step::at_levels);
    EXPECT_EQ(still.next(std::nullopt, now += StillView::kAfter), Step::at_levels);
    EXPECT_EQ(still.next(std::nullopt, now += StillView::kAfter), Step::at_levels);
}

TEST_F(GuiDetail, a_drag_that_pauses_is_not_held_up_by_full_detail) {
    StillView still;
    Instant now = Instant{} + std::chrono::hours(1);
    using Step = StillView::Step;
    for (int i = 0; i < 10; ++i) EXPECT_EQ(still.next(7, now += StillView::kAfter, true), Step::at_levels);
    EXPECT_EQ(still.next(7, now += milliseconds(10)), Step::at_levels) << "the button was just released";
    EXPECT_EQ(still.next(7, now += StillView::kAfter), Step::refine);
    still.keep(0, 0, kWidth, kHeight);
    EXPECT_EQ(still.next(7, now += milliseconds(10), true), Step::copy) << "a picture that is there is shown";
}

TEST(ContentKey, differs_when_a_number_differs_and_not_for_noise) {
    const auto key = [](double x_m, double angle_rad) {
        ContentKey k;
        k.add(Pose{Vec3(x_m, 0.0, 0.0), Quat(Eigen::AngleAxisd(angle_rad, Vec3::UnitX()))});
        return k.value();
    };
    EXPECT_EQ(key(1e-9, 0.0), key(1e-9 + 1e-13, 1e-7));
    EXPECT_NE(key(1e-9, 0.0), key(1.01e-9, 0.0));
    EXPECT_NE(key(1e-9, 0.0), key(1e-9, 1e-3));
}

}  // namespace
}  // namespace tact::gui_detail_test
