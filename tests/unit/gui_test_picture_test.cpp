// The test picture of a stage: depths, the tool at the hand, a text for each eye.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "gui/stereo/test_picture.hpp"

namespace tact::gui_test_picture_test {
namespace {

TEST(TestPicture, steps_have_their_depths_and_the_tool_is_at_the_hand) {
    const GlassSize glass{530.0, 300.0, 0.28};
    const auto depths = stair_depths_mm(glass);
    EXPECT_DOUBLE_EQ(depths[2], 0.0);
    for (std::size_t i = 1; i < 5; ++i) EXPECT_GT(depths[i], depths[i - 1]);
    EXPECT_GT(grid_spacing_mm(glass), 10.0);
    const Eigen::Vector3d tool(40.0, -30.0, 55.0);
    std::set<float> levels;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double count = 0.0;
    const auto plain = test_picture(glass, {0, {}}), with_tool = test_picture(glass, {0, tool});
    for (const PictureVertex& v : plain) levels.insert(v.z_mm);
    for (const double d : depths) EXPECT_TRUE(levels.count(static_cast<float>(d))) << d;
    for (const PictureVertex& v : plain) {
        EXPECT_LE(std::abs(v.x_mm), 266.0F);
        EXPECT_LE(std::abs(v.y_mm), 151.0F);
    }
    ASSERT_GT(with_tool.size(), plain.size());
    // The cross is last; its three bars come first.
    for (std::size_t i = plain.size(); i < plain.size() + 6 * 4; ++i, count += 1.0)
        middle +=
            Eigen::Vector3d(static_cast<double>(with_tool[i].x_mm), static_cast<double>(with_tool[i].y_mm),
                            static_cast<double>(with_tool[i].z_mm));
    EXPECT_LT((middle / count - tool).norm(), 1e-3);
    // Each eye has its own text.
    const auto right = test_picture(glass, {1, {}});
    EXPECT_NE(plain.size(), right.size());
}

TEST(TestPicture, the_texts_for_the_two_eyes_are_inside_the_circle_and_separate) {
    for (const GlassSize& glass : {GlassSize{530.0, 300.0, 0.28}, GlassSize{400.0, 400.0, 2.0}}) {
        const auto inks_of = [&](std::size_t eye) {
            std::set<std::array<int, 3>> inks;
            for (const PictureVertex& v : test_picture(glass, {eye, {}}))
                inks.insert({v.ink.r, v.ink.g, v.ink.b});
            return inks;
        };
        for (const std::size_t eye : {std::size_t{0}, std::size_t{1}}) {
            const auto others = inks_of(1 - eye);
            std::size_t of_word = 0;
            for (const PictureVertex& v : test_picture(glass, {eye, {}})) {
                if (others.count({v.ink.r, v.ink.g, v.ink.b}) > 0) continue;
                ++of_word;
                EXPECT_LT(std::hypot(v.x_mm, v.y_mm), 0.38 * glass.height_mm);
                EXPECT_GT(eye == 0 ? -v.x_mm : v.x_mm, 0.0F);
            }
            EXPECT_GT(of_word, 0U);
        }
    }
}

}  // namespace
}  // namespace tact::gui_test_picture_test
