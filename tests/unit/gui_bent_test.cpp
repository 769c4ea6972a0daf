// Bent bodies in the window's data: the topic, the list of bodies, when the fit is computed again, and what is saved.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gui/docking/body_list.hpp"
#include "gui/docking/docking_content.hpp"
#include "gui/docking/poses_json.hpp"
#include "gui/link/region_checks.hpp"

namespace tact::gui_bent_test {
namespace {

ShapesTopic bent(std::uint32_t id, std::vector<float> amplitude_m) {
    ShapesTopic t{};
    t.body[3].id = id;
    std::copy(amplitude_m.begin(), amplitude_m.end(), t.body[3].amplitude_m);
    return t;
}

TEST(RegionChecks, refuse_impossible_shapes) {
    EXPECT_TRUE(sensible(ShapesTopic{}));
    EXPECT_TRUE(sensible(bent(2, {1e-10F, -3e-10F})));
    for (const float bad : {std::nanf(""), 1.0F, -1.0F}) EXPECT_FALSE(sensible(bent(2, {0.0F, bad}))) << bad;
    const auto refused = [](auto&& damage) {
        ShapesTopic t{};
        damage(t);
        return !sensible(t);
    };
    EXPECT_TRUE(refused([](ShapesTopic& t) { t.strain = std::nanf(""); }));
    EXPECT_TRUE(refused([](ShapesTopic& t) { t.strain_most = -1.0F; }));
    EXPECT_TRUE(refused([](ShapesTopic& t) { t.rmsd_m = 1.0F; }));
    EXPECT_TRUE(refused([](ShapesTopic& t) { t.bends = 2; }));
}

TEST(BodyList, bodies_have_their_published_shapes_until_another_controller_comes) {
    BodyList list;
    list.start(std::vector<Pose>(2));
    list.follow(bent(2, {1e-10F, -3e-10F, 0.0F}));
    EXPECT_TRUE(list.bodies()[0].amplitude_m.empty());
    EXPECT_EQ(list.bodies()[1].amplitude_m, (std::vector<float>{1e-10F, -3e-10F}));
    list.follow(bent(2, {}));
    EXPECT_TRUE(list.bodies()[1].amplitude_m.empty());
    list.follow(bent(1, {2e-10F}));
    list.forget_motion();
    EXPECT_TRUE(list.bodies()[0].amplitude_m.empty());
}

TEST(Moved, a_bend_of_more_than_a_hundredth_of_an_angstrom_counts) {
    const FitBody straight{1, 0, {}, {}}, hardly{1, 0, {}, {5e-13F}}, bend{1, 0, {}, {0.0F, 1e-10F}};
    const auto differ = [](const FitBody& a, const FitBody& b) { return moved({&a, 1}, {&b, 1}); };
    EXPECT_FALSE(differ(straight, hardly));
    EXPECT_TRUE(differ(straight, bend));
    EXPECT_TRUE(differ(bend, straight));
    EXPECT_FALSE(differ(bend, bend));
}

TEST(PosesJson, a_bent_body_has_its_amplitudes) {
    SceneContent content;
    auto docking = std::make_unique<DockingContent>();
    docking->bodies.resize(1);
    content.system = std::move(docking);
    const std::string text = poses_json(
        std::vector<PosedBody>{{{1, 0, {}, {1e-10F, -2e-10F}}, false}, {{2, 0, {}, {}}, true}}, content);
    EXPECT_NE(text.find("mode_amplitudes_a"), std::string::npos);
    EXPECT_EQ(text.find("mode_amplitudes_a"), text.rfind("mode_amplitudes_a"));
    EXPECT_NE(text.find("-2.0"), std::string::npos) << text;
}

}  // namespace
}  // namespace tact::gui_bent_test
