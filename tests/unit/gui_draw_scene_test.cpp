// Rendered pixels of a docking scene: styles, colours and bends of bodies, the second hand, levels and contours of the map.
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <set>

#include "gui/docking/docking_layer.hpp"
#include "gui/render/scene_view.hpp"
#include "gui/render/screen.hpp"
#include "gui/window/load_scene.hpp"
#include "ipc/base/units.hpp"
#include "tests/unit/gui_draw_canvas.hpp"
#include "tests/unit/gui_fake.hpp"
#include "tests/unit/gui_wait.hpp"

namespace tact::gui_draw_scene_test {
namespace {

// Number of pixels that differ from the background.
std::size_t drawn(const Image& image) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
        count += (image.rgb[i] | image.rgb[i + 1] | image.rgb[i + 2]) != 0 ? 1U : 0U;
    return count;
}

class GuiDrawScene : public DrawCanvas {
protected:
    void SetUp() override {
        DrawCanvas::SetUp();
        if (IsSkipped()) return;
        const std::string path = folder_ + "/scene.tact";
        if (!std::filesystem::exists(path)) fake::write_helix_scene(path, 16);
        content_ = load_scene(path);
        programs_.emplace();
        begin_view();
        camera_.frame(view_->radius_a());
        options_.surface = options_.force = false;
        layer_->frame.codebook = layer_->frame.graph = false;
        home_ = {docking_of(*content_).bodies[0].home(), 0, 1};
    }
    void TearDown() override {
        view_.reset();
        layer_.reset();
        programs_.reset();
        DrawCanvas::TearDown();
    }
    void begin_view(const RefineContour& refine = {}) {
        view_.emplace(content_, *programs_, refine);
        layer_.emplace(content_, *programs_);
        view_->set_layer(&*layer_);
    }
    Image picture(std::span<const DrawnBody> bodies) {
        ViewFrame frame{};
        frame.width_px = kWidth;
        frame.height_px = kHeight;
        layer_->frame.bodies = bodies;
        frame.hand = second_hand_;
        // Surfaces are computed in the background.
        EXPECT_TRUE(test::wait_for([&] {
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            view_->draw(camera_.eye(static_cast<float>(frame.width_px) / static_cast<float>(frame.height_px)),
                        options_, frame);
            return layer_->molecules().surfaces_awaited() == 0;
        }));
        return read_pixels(kWidth, kHeight);
    }
    std::shared_ptr<const SceneContent> content_;
    std::optional<Programs> programs_;
    std::optional<SceneView> view_;
    std::optional<DockingLayer> layer_;
    ViewOptions options_;
    DrawnBody home_;
    std::optional<DrawnHand> second_hand_;
};

TEST_F(GuiDrawScene, each_style_draws_a_different_image) {
    std::set<std::string> pictures;
    for (const auto style : {MoleculeStyle::trace, MoleculeStyle::tube, MoleculeStyle::sticks,
                             MoleculeStyle::spheres, MoleculeStyle::cartoon, MoleculeStyle::surface})
        for (const auto colouring : {Colouring::chain, Colouring::body}) {
            layer_->molecules().set_look({style, colouring});
            const Image image = picture(std::array{home_});
            EXPECT_GT(drawn(image), 100U);
            pictures.insert({image.rgb.begin(), image.rgb.end()});
        }
    EXPECT_EQ(pictures.size(), 12U);
}

TEST_F(GuiDrawScene, a_bent_body_is_drawn_as_its_bent_atoms_and_follows_each_change) {
    auto& docking = const_cast<DockingContent&>(docking_of(*content_));  // this test's own scene
    const Structure straight = docking.bodies[0];
    NormalModes bow;
    bow.node = residue_nodes(straight);
    bow.stiffness = {1.0F};
    for (std::size_t n = 0; n < bow.nodes(); ++n) {
        const double along = static_cast<double>(n) / static_cast<double>(bow.nodes()) - 0.5;
        bow.x.push_back(static_cast<float>(4.0 * along * along));
        bow.y.push_back(0.0F);
        bow.z.push_back(0.0F);
    }
    docking.modes = {bow};
    for (const auto style : {MoleculeStyle::trace, MoleculeStyle::tube, MoleculeStyle::sticks,
                             MoleculeStyle::spheres, MoleculeStyle::cartoon, MoleculeStyle::surface}) {
        const auto begin_layer = [&] {  // the view stays, with the haze of the straight scene
            layer_.emplace(content_, *programs_);
            view_->set_layer(&*layer_);
            layer_->frame.codebook = layer_->frame.graph = false;
            layer_->molecules().set_look({style, Colouring::chain});
        };
        begin_layer();
        const Image before = picture(std::array{home_});
        std::vector<Image> bent;
        for (const float amplitude_m : {3e-10F, 6e-10F}) {
            DrawnBody body = home_;
            body.amplitude_m = {&amplitude_m, 1};
            bent.push_back(picture(std::array{body}));
        }
        EXPECT_EQ(picture(std::array{home_}).rgb, before.rgb);
        for (std::size_t i = 0; i < 2; ++i) {
            const float amplitude_m = i == 0 ? 3e-10F : 6e-10F;
            docking.bodies[0] = bent_structure(straight, bow, {&amplitude_m, 1});
            begin_layer();
            // A cartoon keeps the helices and strands of the straight structure while it is bent, and a surface is moved.
            if (style != MoleculeStyle::cartoon && style != MoleculeStyle::surface) {
                EXPECT_EQ(picture(std::array{home_}).rgb, bent[i].rgb)
                    << static_cast<int>(style) << ", " << i;
            }
            EXPECT_NE(bent[i].rgb, before.rgb);
        }
        docking.bodies[0] = straight;
    }
}

TEST_F(GuiDrawScene, copies_are_drawn_and_hidden_or_unknown_ones_are_not) {
    layer_->molecules().set_look({MoleculeStyle::spheres, Colouring::chain});
    const std::size_t one = drawn(picture(std::array{home_}));
    DrawnBody copy = home_;
    copy.id = 2;
    copy.T_model_body.p_m += Vec3(0.0, 0.0, 14e-10);
    EXPECT_GT(drawn(picture(std::array{home_, copy})), one + 50);
    copy.hidden = true;
    EXPECT_EQ(drawn(picture(std::array{home_, copy})), one);
    copy.hidden = false;
    copy.structure = 77;
    EXPECT_EQ(drawn(picture(std::array{home_, copy})), one);
}

TEST_F(GuiDrawScene, a_second_hand_is_drawn_with_its_force_and_the_wall_it_touches) {
    EXPECT_EQ(drawn(picture({})), 0U);
    const auto in_half = [](const Image& image, bool right) {
        std::size_t count = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = right ? kWidth / 2 : 0; x < (right ? kWidth : kWidth / 2); ++x) {
                const std::size_t at = std::size_t{3} * static_cast<std::size_t>(y * kWidth + x);
                count += (image.rgb[at] | image.rgb[at + 1] | image.rgb[at + 2]) != 0 ? 1U : 0U;
            }
        return count;
    };
    DrawnHand hand;
    hand.T_model_hand.p_m = content_->centre_model_m + Vec3(0.5 * content_->radius_m, 0.0, 0.0);
    second_hand_ = hand;
    const Image right = picture({});
    EXPECT_GT(in_half(right, true), 60U);
    EXPECT_EQ(in_half(right, false), 0U);
    second_hand_->T_model_hand.p_m.x() -= 1.2 * content_->radius_m;
    EXPECT_GT(in_half(picture({}), false), 30U);
    second_hand_ = hand;

    // The drawn hand rotates with the tool.
    second_hand_->T_model_hand.q = quat_from_rotation_vector({0.0, 0.0, 2.0});
    EXPECT_NE(picture({}).rgb, right.rgb);
    second_hand_ = hand;

    const auto force = [&](const Vec3& force_n, bool at_wall) {
        second_hand_->force_world_n = force_n;
        second_hand_->at_wall = at_wall;
        return drawn(picture({}));
    };
    const std::size_t alone = drawn(right);
    const std::size_t pushed = force({-0.7, 0.0, 0.0}, false);
    EXPECT_GT(pushed, alone + 20);
    EXPECT_GT(force({-0.7, 0.0, 0.0}, true), pushed + 10);
    EXPECT_EQ(force(Vec3::Zero(), true), alone);  // without a force the direction of the wall is unknown
    EXPECT_EQ(force(Vec3::Constant(std::nan("")), true), alone);
}

TEST_F(GuiDrawScene, a_body_coloured_by_its_fit_has_the_given_colours_and_is_grey_without) {
    const std::size_t atoms = docking_of(*content_).bodies[0].size();
    std::vector<Rgb8> halves(atoms, Rgb8{255, 0, 0});
    std::fill(halves.begin() + static_cast<std::ptrdiff_t>(atoms / 2), halves.end(), Rgb8{0, 0, 255});
    // Pixels in which one channel exceeds the others by far.
    const auto strong = [](const Image& image, std::size_t channel) {
        std::size_t count = 0;
        for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
            const int own = image.rgb[i + channel];
            if (own > 60 + std::max<int>(image.rgb[i + (channel + 1) % 3], image.rgb[i + (channel + 2) % 3]))
                ++count;
        }
        return count;
    };
    for (const auto style : {MoleculeStyle::trace, MoleculeStyle::tube, MoleculeStyle::sticks,
                             MoleculeStyle::spheres, MoleculeStyle::cartoon, MoleculeStyle::surface}) {
        layer_.emplace(content_, *programs_);
        view_->set_layer(&*layer_);
        layer_->frame.codebook = layer_->frame.graph = false;
        layer_->molecules().set_look({style, Colouring::fit});
        const Image grey = picture(std::array{home_});
        EXPECT_LT(strong(grey, 0) + strong(grey, 2), 5U);
        layer_->molecules().set_fit_colours(home_.id, halves);
        const Image painted = picture(std::array{home_});
        EXPECT_GT(strong(painted, 0), 30U) << static_cast<int>(style);
        EXPECT_GT(strong(painted, 2), 30U) << static_cast<int>(style);
        layer_->molecules().set_fit_colours(home_.id, {Rgb8{255, 0, 0}});  // of another structure
        EXPECT_EQ(picture(std::array{home_}).rgb, grey.rgb);
        layer_->molecules().set_look({style, Colouring::chain});
        EXPECT_NE(picture(std::array{home_}).rgb, grey.rgb);
    }
}

TEST_F(GuiDrawScene, a_style_applies_to_one_body_and_a_limit_turns_spheres_into_tubes) {
    DrawnBody copy = home_;
    copy.id = 2;
    layer_->molecules().set_look({MoleculeStyle::tube, Colouring::chain});
    const Image tube = picture(std::array{home_});
    layer_->molecules().set_look(2, {MoleculeStyle::spheres, Colouring::chain});
    EXPECT_EQ(picture(std::array{home_}).rgb, tube.rgb);
    EXPECT_NE(picture(std::array{copy}).rgb, tube.rgb);
    layer_->molecules().set_shapes_max(docking_of(*content_).bodies[0].size() - 1);
    EXPECT_EQ(picture(std::array{copy}).rgb, tube.rgb);
    EXPECT_EQ(layer_->molecules().left_out(), 1U);
}

// The surface of a lone atom looks like its sphere, which is drawn as an impostor.
TEST_F(GuiDrawScene, the_surface_of_an_atom_is_lit_as_its_sphere) {
    Structure atom;
    atom.x_m = atom.y_m = atom.z_m = {0.0F};
    atom.element = {19};
    atom.chain = {2};
    const MolecularSurface mesh = build_surface(atom, 0.3);
    PaintedSurface surface(std::make_shared<SurfaceShape>(mesh.vertex, mesh.index),
                           surface_colours(mesh, atom, false));
    ImpostorPrograms impostors;
    ImpostorShapes sphere;
    sphere.fill(spheres_of(atom));
    camera_.frame(3.0F);
    const Haze haze;
    const EyeView eye = camera_.eye(static_cast<float>(kWidth) / static_cast<float>(kHeight));
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    impostors.use_spheres({eye.eye_from_scene, eye.projection, haze});
    sphere.draw();
    const Image wanted = read_pixels(kWidth, kHeight);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    programs_->light_by_pixel(true);
    programs_->use_lit(eye.eye_from_scene, eye.projection, haze, {.closed = true});
    glEnable(GL_CULL_FACE);
    surface.draw();
    glDisable(GL_CULL_FACE);
    const Image seen = read_pixels(kWidth, kHeight);
    std::size_t off = 0;
    for (std::size_t i = 0; i < seen.rgb.size(); ++i)
        off += std::abs(seen.rgb[i] - wanted.rgb[i]) > 8 ? 1U : 0U;
    EXPECT_GT(drawn(wanted), 2000U);
    EXPECT_LT(off, drawn(wanted) / 20) << "of three channels, at the outline";
}

TEST_F(GuiDrawScene, a_surface_that_is_cut_looks_solid_inside) {
    layer_->molecules().set_look({MoleculeStyle::surface, Colouring::chain});
    options_.depth_cue = false;
    // Pixels of the flat colour that the faces of a cut have.
    const auto faces = [](const Image& image) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < image.rgb.size(); i += 3)
            for (const std::size_t chain : {0U, 1U}) {
                const Rgb8 c = chain_colour(chain);
                bool same = true;
                for (std::size_t k = 0; k < 3; ++k)
                    same = same && std::abs(image.rgb[i + k] - 0.72 * c[k]) < 1.5;
                count += same ? 1U : 0U;
            }
        return count;
    };
    const Image whole = picture(std::array{home_});
    const std::size_t by_chance = faces(whole);
    options_.cut_a = 0.0F;
    const Image half = picture(std::array{home_});
    EXPECT_GT(faces(half), by_chance + 100U);
    EXPECT_GT(drawn(half), drawn(whole) / 3);
    options_.cut_a = -60.0F;  // behind it
    EXPECT_EQ(drawn(picture(std::array{home_})), 0U);
}

TEST_F(GuiDrawScene, a_surface_has_the_vertices_allowed_and_is_a_tube_until_it_is_there) {
    layer_->molecules().set_look({MoleculeStyle::tube, Colouring::chain});
    const Image tube = picture(std::array{home_});
    Molecules& molecules = layer_->molecules();
    molecules.set_look({MoleculeStyle::surface, Colouring::chain});
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    ViewFrame frame{};
    frame.width_px = kWidth;
    frame.height_px = kHeight;
    layer_->frame.bodies = std::span(&home_, 1);
    view_->draw(camera_.eye(static_cast<float>(kWidth) / static_cast<float>(kHeight)), options_, frame);
    if (molecules.surfaces_computed() == 0) {
        EXPECT_EQ(read_pixels(kWidth, kHeight).rgb, tube.rgb);
        EXPECT_EQ(molecules.surfaces_awaited(), 1U);
    }
    const Image fine = picture(std::array{home_});
    EXPECT_EQ(molecules.surfaces_coarse() + molecules.left_out(), 0U);
    const std::uint32_t most = molecules.triangles();
    EXPECT_EQ(molecules.triangles_max(), most);
    // Triangles are twice the vertices of a closed surface, about.
    molecules.set_surface_vertices_max(most / 4);
    EXPECT_NE(picture(std::array{home_}).rgb, fine.rgb);
    EXPECT_EQ(molecules.surfaces_coarse(), 1U);
    EXPECT_LE(molecules.triangles(), most / 2 + 4);
    // Two copies share what one was allowed.
    DrawnBody copy = home_;
    copy.id = 2;
    static_cast<void>(picture(std::array{home_, copy}));
    EXPECT_EQ(molecules.surfaces_coarse(), 2U);
    EXPECT_LE(molecules.triangles(), most / 2 + 8);
    molecules.set_surface_vertices_max(10);
    EXPECT_EQ(picture(std::array{home_}).rgb, tube.rgb);
    EXPECT_EQ(molecules.left_out(), 1U);
}

TEST_F(GuiDrawScene, a_surface_follows_its_level_at_once_for_any_frame_time) {
    const std::string path = folder_ + "/fine.tact";
    fake::write_helix_scene(path, 64);
    content_ = load_scene(path);
    begin_view();
    const std::uint32_t most = view_->vertices_max();
    ASSERT_GT(most, 4 * MeshCut::kStepsMin);
    view_->approach_vertices(most, 0.0);
    view_->upload();
    for (const std::uint32_t wanted : {most / 8, most, most / 3, most - 1, view_->vertices_min()}) {
        view_->approach_vertices(wanted, 0.0);
        EXPECT_EQ(view_->vertices(), wanted);
        view_->upload();
    }
}

TEST_F(GuiDrawScene, contours_share_the_vertices_and_stay_until_refined) {
    const auto refine = [this](double level, const std::function<bool()>&) {
        return std::make_shared<const ProgressiveMesh>(make_progressive(isosurface(content_->grid, level)));
    };
    begin_view(refine);
    options_.surface = true;
    const double own = content_->meta.contour;
    EXPECT_EQ(view_->vertices_max(), content_->mesh->vertices());
    view_->approach_vertices(view_->vertices_max(), 1e9);
    view_->upload();
    options_.style = SurfaceStyle::solid;
    const Image alone = picture({});
    std::array<Contour, 3> contours;
    contours[0].level = own;
    contours[1].level = 0.6 * own;
    contours[2].level = 1.4 * own;
    view_->contours().set(contours);
    EXPECT_EQ(view_->vertices(), content_->mesh->vertices());
    EXPECT_EQ(picture({}).rgb, alone.rgb);
    ASSERT_TRUE(test::wait_for([&] {
        view_->upload();
        return view_->contours().state(1).final && view_->contours().state(2).final;
    }));
    EXPECT_EQ(view_->contours().state(1).level, 0.6 * own);
    EXPECT_NE(picture({}).rgb, alone.rgb);  // the outer contour hides it
    const std::uint32_t most = view_->vertices_max();
    EXPECT_GT(most, content_->mesh->vertices());
    EXPECT_EQ(view_->vertices(), most);
    view_->approach_vertices(most / 2, 1e9);
    EXPECT_NEAR(static_cast<double>(view_->vertices()), 0.5 * most, 3.0);
    // Hidden contours are neither drawn nor counted.
    contours[1].shown = contours[2].shown = false;
    view_->contours().set(contours);
    view_->approach_vertices(view_->vertices_max(), 1e9);
    view_->upload();
    EXPECT_EQ(view_->vertices(), content_->mesh->vertices());
    EXPECT_EQ(picture({}).rgb, alone.rgb);
}

TEST_F(GuiDrawScene, a_moved_contour_is_visible_in_every_style_and_opacity) {
    options_.surface = true;
    std::set<std::string> pictures;
    Contour contour;
    contour.level = 0.8 * content_->meta.contour;
    view_->contours().set(std::array{contour});
    ASSERT_TRUE(test::wait_for([&] {
        view_->upload();
        return view_->contours().state(0).level == contour.level;
    }));
    for (const auto style : {SurfaceStyle::glass, SurfaceStyle::solid, SurfaceStyle::wire})
        for (const float opacity : {0.4F, 1.0F}) {
            contour.style = style;
            contour.opacity = opacity;
            view_->contours().set(std::array{contour});
            const Image image = picture({});
            EXPECT_GT(drawn(image), 200U);
            pictures.insert({image.rgb.begin(), image.rgb.end()});
        }
    EXPECT_EQ(pictures.size(), 6U);
}

}  // namespace
}  // namespace tact::gui_draw_scene_test
