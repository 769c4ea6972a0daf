// Which parts of the bone's picture are drawn, and how many rays a frame affords; without a display.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "gui/drilling/bone_tiles.hpp"
#include "gui/drilling/ray_pace.hpp"

namespace tact::gui_bone_tiles_test {
namespace {

TEST(BoneTiles, the_view_is_drawn_once_from_the_middle_outwards) {
    BoneTiles tiles;
    tiles.resize(300, 200);
    tiles.all_wrong({0, 0, 300, 200});
    EXPECT_EQ(tiles.rays_wrong(), 300U * 200U);
    std::set<std::uint32_t> seen;
    std::uint32_t rays = 0;
    bool first = true;
    for (int i = 0; i < 100 && !tiles.all_good(); ++i) {
        const auto now = tiles.take(5000);
        std::uint32_t here = 0;
        for (const std::uint32_t t : now) {
            EXPECT_TRUE(seen.insert(t).second);
            here += tiles.rays(t);
        }
        if (first) {
            ASSERT_EQ(now.size(), 1U);
            const PixelBox b = tiles.box(now[0]);
            EXPECT_TRUE(b.x0 <= 150 && 150 <= b.x1 && b.y0 <= 100 && 100 <= b.y1);
        }
        first = false;
        EXPECT_LE(here, 5000U);
        rays += here;
    }
    EXPECT_TRUE(tiles.all_good());
    EXPECT_EQ(rays, 300U * 200U);
    EXPECT_TRUE(tiles.take(5000).empty());
}

TEST(BoneTiles, a_tile_larger_than_the_ray_budget_is_drawn) {
    BoneTiles tiles;
    tiles.resize(256, 64);
    tiles.all_wrong({0, 0, 256, 64});
    EXPECT_EQ(tiles.take(1).size(), 1U);
}

TEST(BoneTiles, only_stale_tiles_are_redrawn) {
    BoneTiles tiles;
    tiles.resize(640, 640);
    tiles.all_wrong({0, 0, 640, 640});
    tiles.take(640 * 640);
    ASSERT_TRUE(tiles.all_good());
    tiles.stale({0, 0, 70, 10});
    EXPECT_FALSE(tiles.all_good());
    EXPECT_EQ(tiles.rays_wrong(), 0U) << "stale tiles stay visible until redrawn";
    const auto now = tiles.take(640 * 640);
    EXPECT_EQ(std::set<std::uint32_t>(now.begin(), now.end()), (std::set<std::uint32_t>{0, 1}));
}

TEST(BoneTiles, a_picture_is_completed_while_a_burr_keeps_some_tiles_stale) {
    BoneTiles tiles;
    tiles.resize(640, 640);
    tiles.all_wrong({0, 0, 640, 640});
    constexpr std::uint32_t kOne = 64 * 64;
    int frames = 0;
    std::map<std::uint32_t, int> drawn;
    std::uint32_t wrong = tiles.rays_wrong();
    for (; frames < 400 && wrong > 0; ++frames) {
        for (const std::uint32_t i : tiles.take(kOne)) ++drawn[i];
        tiles.stale({250, 250, 400, 300});  // of eight tiles about the middle
        wrong = tiles.rays_wrong();
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_LE(frames, 210);
    // And the burr's own tiles are each drawn again and again.
    int often = 0;
    for (const auto& [tile, times] : drawn) often += times >= 8 ? 1 : 0;
    EXPECT_EQ(often, 8);
}

TEST(BoneTiles, beyond_the_bone_nothing_is_drawn) {
    BoneTiles tiles;
    tiles.resize(640, 640);
    tiles.all_wrong({64, 64, 128, 96});
    EXPECT_EQ(tiles.rays_wrong(), 64U * 32U);
    EXPECT_EQ(tiles.take(640 * 640).size(), 1U);
    EXPECT_TRUE(tiles.all_good());
}

TEST(RayPace, rays_fit_the_frame_time_and_recover_slowly) {
    RayPace pace;
    for (int i = 0; i < 60; ++i) pace.took(0, 0.010);
    for (int i = 0; i < 60; ++i) pace.took(pace.rays_most(), 0.010 + 2e-6 * pace.rays_most());
    EXPECT_NEAR(pace.rays_most(), (RayPace::kFrame_s - 0.010) / 2e-6, 500.0);
    pace.took(pace.rays_most(), 0.010 + 8e-6 * pace.rays_most());
    const std::uint32_t dear = pace.rays_most();
    EXPECT_NEAR(dear, std::max((RayPace::kFrame_s - 0.010) / 8e-6, 1.0 * RayPace::kFewest), 500.0)
        << "a higher cost is applied at once";
    pace.took(dear, 0.010 + 1e-6 * dear);
    EXPECT_LT(pace.rays_most(), 1.3 * dear) << "a lower cost is applied slowly";
    for (const double odd : {0.0, -1.0, 100.0, std::nan("")}) {
        const std::uint32_t before = pace.rays_most();
        pace.took(20000, odd);
        EXPECT_EQ(pace.rays_most(), before);
    }
}

}  // namespace
}  // namespace tact::gui_bone_tiles_test
