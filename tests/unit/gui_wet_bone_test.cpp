// Wet and stained bone: what wets it, how it dries, and what is drawn again.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "gui/drilling/wet_bone.hpp"

namespace tact::gui_wet_bone_test {
namespace {

constexpr std::uint32_t kMargin = 16;
constexpr double kLookS = 1.0 / WetBone::kLooksPerS;

struct Place {
    BoneBricks bricks;
    ParticleCells cells;
    WetBone wet;
    std::vector<Particle> particles;

    Place() : bricks(of_size({40, 48, 56})), cells(bricks, {}, kMargin), wet(bricks) {}
    static BoneBricks of_size(std::array<std::uint32_t, 3> size) {
        BoneBricks b;
        b.size = size;
        b.voxel_m = 3e-4;
        return b;
    }
    void put(Matter matter, float x, float y, float z) {
        Particle p{};
        p.at = {x + kMargin + 0.5F, y + kMargin + 0.5F, z + kMargin + 0.5F};
        p.matter = matter;
        particles.push_back(p);
    }
    void look(double seconds = kLookS) { wet.step(seconds, particles, cells); }
    // Of the cell of a voxel.
    [[nodiscard]] WetBone::Texel at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        const auto& n = wet.size();
        return wet.texels()[(std::size_t{z / 4} * n[1] + y / 4) * n[0] + x / 4];
    }
    [[nodiscard]] std::size_t wet_cells() const {
        return static_cast<std::size_t>(
            std::count_if(wet.texels().begin(), wet.texels().end(),
                          [](const WetBone::Texel& t) { return t[0] != 0 || t[1] != 0; }));
    }
};

TEST(WetBone, a_drop_wets_its_cell_and_no_other) {
    Place p;
    p.put(Matter::water, 33.0F, 20.0F, 51.0F);
    p.put(Matter::dust, 5.0F, 5.0F, 5.0F);
    p.look();
    EXPECT_GT(p.at(33, 20, 51)[0], 120);
    EXPECT_EQ(p.at(33, 20, 51)[1], 0);
    EXPECT_EQ(p.wet_cells(), 1U);
    ASSERT_EQ(p.wet.changed().size(), 1U);
    EXPECT_EQ(p.wet.changed()[0], p.bricks.brick(33, 20, 51));
    p.look();
    p.look();
    EXPECT_GT(p.at(33, 20, 51)[0], 230) << "and more while it stays";
}

TEST(WetBone, it_looks_a_few_times_a_second_and_reports_each_change_once) {
    Place p;
    p.put(Matter::water, 8.0F, 8.0F, 8.0F);
    int reported = 0;
    for (int i = 0; i < 60; ++i) {
        p.look(1.0 / 60.0);
        reported += static_cast<int>(p.wet.changed().size());
    }
    EXPECT_GE(reported, 2);
    EXPECT_LE(reported, 5);
}

TEST(WetBone, it_dries_within_a_minute_or_two_in_few_steps) {
    Place p;
    p.put(Matter::water, 12.0F, 12.0F, 12.0F);
    for (int i = 0; i < 10; ++i) p.look();
    const int full = p.at(12, 12, 12)[0];
    p.particles.clear();
    int steps = 0, after_20_s = 0;
    for (int i = 0; i < 600; ++i) {
        p.look();
        steps += static_cast<int>(p.wet.changed().size());
        if (i == 99) after_20_s = p.at(12, 12, 12)[0];
    }
    EXPECT_NEAR(after_20_s, full / 2.718, 17.0);
    EXPECT_EQ(p.wet_cells(), 0U);
    EXPECT_LE(steps, 16);
    p.put(Matter::water, 12.0F, 12.0F, 12.0F);
    p.look();
    EXPECT_EQ(p.wet_cells(), 1U) << "and gets wet again";
}

TEST(WetBone, blood_stains_and_water_washes_it_away) {
    Place p;
    p.put(Matter::blood, 20.0F, 20.0F, 20.0F);
    p.put(Matter::blood, 30.0F, 20.0F, 20.0F);
    for (int i = 0; i < 10; ++i) p.look();
    EXPECT_GT(p.at(20, 20, 20)[1], 200);
    p.particles.clear();
    p.put(Matter::water, 20.0F, 20.0F, 20.0F);
    for (int i = 0; i < 40; ++i) p.look();
    EXPECT_EQ(p.at(20, 20, 20)[1], 0);
    EXPECT_GT(p.at(30, 20, 20)[1], 180) << "where no water flows it stays";
}

TEST(WetBone, places_outside_the_bone_and_no_numbers_are_ignored) {
    Place p;
    for (const float bad : {-1.0F, 40.0F, 1e30F, -1e30F, std::numeric_limits<float>::quiet_NaN()})
        p.put(Matter::water, bad, 10.0F, 10.0F);
    p.look();
    EXPECT_EQ(p.wet_cells(), 0U);
    EXPECT_TRUE(p.wet.changed().empty());
}

// Cells that dry at different times leave the list in any order.
TEST(WetBone, many_cells_that_wet_and_dry_stay_apart) {
    Place p;
    for (int round = 0; round < 40; ++round) {
        p.particles.clear();
        for (int i = 0; i < 30; ++i)
            p.put(i % 3 == 0 ? Matter::blood : Matter::paste, static_cast<float>((7 * round + 4 * i) % 40),
                  static_cast<float>((11 * round + 4 * i) % 48), static_cast<float>((4 * i) % 56));
        for (int i = 0; i < 30; ++i) p.look();
        for (const Particle& at : p.particles)
            EXPECT_GT(p.at(static_cast<std::uint32_t>(at.at[0]) - kMargin,
                           static_cast<std::uint32_t>(at.at[1]) - kMargin,
                           static_cast<std::uint32_t>(at.at[2]) - kMargin)[0],
                      200);
    }
    p.particles.clear();
    for (int i = 0; i < 5000; ++i) p.look();
    EXPECT_EQ(p.wet_cells(), 0U);
}

}  // namespace
}  // namespace tact::gui_wet_bone_test
