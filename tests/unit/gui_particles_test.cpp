#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "gui/drilling/particles.hpp"
#include "ipc/base/error.hpp"

namespace tact::gui_particles_test {
namespace {

constexpr double kPlenty = 1.0;  // seconds of budget: every particle is moved in every step

// A box of 40 cells of 0.5 mm, with a floor of bone eight cells thick.
struct Box {
    BoneBricks bricks{.size = {40, 40, 40}, .voxel_m = 5e-4, .origin_m = Vec3(0.01, -0.02, 0.03)};
    std::vector<std::uint8_t> density;

    Box() : density(bricks.bytes(), 0) {
        for (std::uint32_t z = 0; z < 40; ++z)
            for (std::uint32_t y = 0; y < 8; ++y)
                for (std::uint32_t x = 0; x < 40; ++x) density[bricks.voxel(x, y, z)] = 255;
    }
    [[nodiscard]] Vec3 at(double x, double y, double z) const { return bricks.to_model(Vec3(x, y, z)); }
};

ParticleSettings few() { return {.most = 20000, .margin = 4}; }

std::uint64_t carried(const Particles& p) {
    return std::accumulate(p.all().begin(), p.all().end(), std::uint64_t{0},
                           [](std::uint64_t sum, const Particle& each) { return sum + each.mass; });
}

// Every particle has its own cell, which is marked as taken, and none is inside bone.
void expect_one_a_cell(const Particles& particles) {
    std::set<Cell> seen;
    for (const Particle& p : particles.all()) {
        const Cell c = {static_cast<int>(p.at[0]), static_cast<int>(p.at[1]), static_cast<int>(p.at[2])};
        ASSERT_TRUE(particles.cells().inside(c));
        ASSERT_NE(particles.cells().state(c), CellState::free);
        ASSERT_FALSE(particles.cells().bone(c));
        ASSERT_TRUE(seen.insert(c).second);
    }
    const Cell n = particles.cells().size();
    std::size_t taken = 0;
    for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y)
            for (int x = 0; x < n[0]; ++x)
                taken += particles.cells().state({x, y, z}) != CellState::free ? 1 : 0;
    EXPECT_EQ(taken, particles.all().size());
}

void settle(Particles& particles, int steps) {
    for (int i = 0; i < steps; ++i) static_cast<void>(particles.step(0.01, kPlenty, Vec3::Zero(), {}));
}

TEST(SpeedGroups, halve_the_speed_from_group_to_group) {
    EXPECT_EQ(speed_group(1.0F), 0U);
    EXPECT_EQ(speed_group(0.51F), 0U);
    EXPECT_EQ(speed_group(0.5F), 1U);  // group j holds speeds above 2^-(j+1), up to and including 2^-j
    EXPECT_EQ(speed_group(0.26F), 1U);
    EXPECT_EQ(speed_group(0.25F), 2U);
    EXPECT_EQ(speed_group(1e-9F), kSpeedGroups - 1);
    EXPECT_EQ(speed_group(0.0F), kSpeedGroups - 1);
    EXPECT_EQ(speed_group(7.0F), 0U);
    EXPECT_EQ(speed_group(std::nanf("")), kSpeedGroups - 1);
}

TEST(SpeedGroups, move_half_as_often_as_the_group_before) {
    const GroupCounts held = {40000, 80000, 64000, 128000, 0, 512000, 0, 0, 0, 512000};
    const GroupCounts moves = moves_by_group(held, 60000.0);
    const auto share = [&](std::size_t j) {
        return static_cast<double>(moves[j]) / static_cast<double>(held[j]);
    };
    EXPECT_NEAR(share(1), share(0) / 2.0, 1e-3);
    EXPECT_NEAR(share(2), share(1) / 2.0, 1e-3);
    EXPECT_NEAR(share(3), share(2) / 2.0, 1e-3);
    EXPECT_NEAR(share(5), share(3) / 4.0, 1e-3);
    EXPECT_NEAR(share(9), share(5) / 16.0, 1e-3);
    const auto sum = std::accumulate(moves.begin(), moves.end(), std::size_t{0});
    EXPECT_NEAR(static_cast<double>(sum), 60000.0, 1.0);
}

TEST(SpeedGroups, a_group_moved_entirely_leaves_its_moves_to_slower_groups) {
    const GroupCounts held = {100, 100, 100, 100, 100, 100, 100, 100, 100, 100};
    for (const double moves : {0.0, 1.0, 150.0, 420.0, 999.0, 1000.0, 5000.0}) {
        const GroupCounts made = moves_by_group(held, moves);
        const auto sum = std::accumulate(made.begin(), made.end(), std::size_t{0});
        EXPECT_NEAR(static_cast<double>(sum), std::min(moves, 1000.0), 1.0) << moves;
        for (std::size_t j = 1; j < kSpeedGroups; ++j) EXPECT_LE(made[j], made[j - 1] + 1) << moves;
    }
    const GroupCounts none = moves_by_group({}, 10.0);
    EXPECT_EQ(std::accumulate(none.begin(), none.end(), std::size_t{0}), 0U);
}

TEST(Particles, fall_with_the_acceleration_of_gravity) {
    const Box box;
    ParticleSettings settings = few();
    settings.drag_per_s = 0.0;
    Particles particles(box.bricks, {}, settings);  // no bone
    ASSERT_TRUE(particles.emit(Matter::dust, box.at(20, 38, 20), Vec3::Zero()));
    const double from = particles.place_m(particles.all()[0]).y();
    particles.step(0.0, kPlenty, Vec3::Zero(), {});  // it starts at rest; this step wakes it
    double fallen = 0.0;
    for (int i = 1; i <= 40; ++i) {
        particles.step(1e-3, kPlenty, Vec3::Zero(), {});
        ASSERT_EQ(particles.all().size(), 1U);
        fallen = from - particles.place_m(particles.all()[0]).y();
    }
    EXPECT_NEAR(fallen, 0.5 * 9.81 * 0.04 * 0.04, 2.0 * box.bricks.voxel_m);
}

TEST(Particles, leave_through_the_bottom_of_the_site) {
    const Box box;
    Particles particles(box.bricks, {}, few());
    for (int i = 0; i < 100; ++i)
        ASSERT_TRUE(particles.emit(Matter::water, box.at(20, 20, 20), Vec3::Zero()));
    settle(particles, 200);
    EXPECT_TRUE(particles.all().empty());
    expect_one_a_cell(particles);
}

TEST(Particles, dust_piles_up_and_water_levels_out) {
    const Box box;
    const auto height = [&](Matter matter) {
        Particles particles(box.bricks, box.density, few());
        for (int i = 0; i < 250; ++i) {
            EXPECT_TRUE(particles.emit(matter, box.at(20, 30, 20), Vec3::Zero()));
            settle(particles, 8);
        }
        settle(particles, 400);
        EXPECT_EQ(particles.all().size(), 250U);
        expect_one_a_cell(particles);
        float top = 0.0F;
        for (const Particle& p : particles.all()) top = std::max(top, p.at[1]);
        return static_cast<int>(top) - 12 +
               1;  // layers above the floor: the margin and the bone are 12 thick
    };
    // A square pyramid of 250 cells with a slope of 45 degrees along the axes is about seven high.
    EXPECT_GE(height(Matter::dust), 4);
    EXPECT_LE(height(Matter::dust), 9);
    EXPECT_LE(height(Matter::water), 2);
}

TEST(Particles, dust_and_water_make_paste) {
    const Box box;
    Particles particles(box.bricks, box.density, few());
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(particles.emit(Matter::water, box.at(20, 9, 20), Vec3::Zero()));
    settle(particles, 50);
    for (int i = 0; i < 60; ++i) {
        particles.drilled(20, 20, 20, 255, Vec3::Zero());
        settle(particles, 5);
    }
    settle(particles, 300);
    std::array<int, 4> of{};
    for (const Particle& p : particles.all()) ++of[static_cast<std::size_t>(p.matter)];
    EXPECT_GT(of[static_cast<std::size_t>(Matter::paste)], 20);
    EXPECT_EQ(particles.ledger().carried, 60U * 255U);
    expect_one_a_cell(particles);
}

TEST(Particles, suction_removes_nearby_particles_unless_its_tip_is_in_bone) {
    const Box box;
    Particles particles(box.bricks, box.density, few());
    for (int i = 0; i < 100; ++i) particles.drilled(i % 2 == 0 ? 19 : 21, 9, 20, 255, Vec3::Zero());
    settle(particles, 100);
    ASSERT_EQ(particles.all().size(), 100U);
    const Suction in_bone{.tip_m = box.at(20, 3, 20), .radius_m = 1.5e-3};
    EXPECT_TRUE(particles.step(0.01, kPlenty, Vec3::Zero(), in_bone).suction_blocked);
    EXPECT_EQ(particles.ledger().sucked, 0U);
    const Suction above{.tip_m = box.at(20, 10, 20), .radius_m = 1.5e-3};
    for (int i = 0; i < 100; ++i)
        EXPECT_FALSE(particles.step(0.01, kPlenty, Vec3::Zero(), above).suction_blocked);
    EXPECT_LT(particles.all().size(), 10U);
    EXPECT_GE(particles.ledger().sucked, 90U * 255U);
    EXPECT_TRUE(particles.ledger().balances());
}

TEST(Particles, conserve_the_drilled_bone) {
    const Box box;
    Particles particles(box.bricks, box.density, few());
    SeededRandom random(3);
    std::uint32_t given_up = 0;
    for (int i = 0; i < 400; ++i) {
        for (int k = 0; k < 20; ++k)
            particles.drilled(static_cast<std::uint32_t>(10 + random.below(20)), 8,
                              static_cast<std::uint32_t>(10 + random.below(20)),
                              static_cast<std::uint32_t>(random.below(256)), 0.4 * random.direction());
        if (i % 3 == 0) particles.emit(Matter::water, box.at(15, 25, 15), Vec3(0.1, 0, 0));
        if (i % 7 == 0) particles.emit(Matter::blood, box.at(25, 9, 25), Vec3(0.0, 0.1, 0.0));
        const Suction suction{.tip_m = box.at(25, 12, 25), .radius_m = 1e-3};
        // From ample time to almost none, so that some are given up.
        given_up += particles.step(0.01, i < 300 ? kPlenty : 2e-6, box.at(20, 20, 20), suction).given_up;
        ASSERT_TRUE(particles.ledger().balances());
        ASSERT_EQ(particles.ledger().carried, carried(particles));
    }
    EXPECT_GT(particles.ledger().drilled, 900000U);
    EXPECT_GT(particles.ledger().sucked, 0U);
    EXPECT_GT(given_up, 100U);
    // Given-up grains are in others, and hardly any bone waits for a grain.
    const auto all = particles.all();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const Particle& p) { return p.mass > 2 * 255; }));
    EXPECT_LT(particles.ledger().pooled, particles.ledger().carried / 10);
    EXPECT_GT(particles.ledger().left, 0U);
    expect_one_a_cell(particles);
}

TEST(Particles, are_the_same_for_the_same_seed) {
    const Box box;
    const auto run = [&] {
        Particles particles(box.bricks, box.density, few());
        for (int i = 0; i < 60; ++i) {
            particles.drilled(20, 8, 20, 700, Vec3(0.1, 0.3, 0.0));
            particles.emit(Matter::water, box.at(15, 25, 15), Vec3(0.1, 0, 0));
            particles.step(0.01, kPlenty, Vec3::Zero(), {});
        }
        std::vector<float> places;
        for (const Particle& p : particles.all()) places.insert(places.end(), p.at.begin(), p.at.end());
        return places;
    };
    EXPECT_EQ(run(), run());
}

// A clock that advances by 1.6 us with every reading: sixteen moves of 100 ns.
std::int64_t slow_ns = 0;
Instant slow_now() {
    slow_ns += 1600;
    return instant_from_ns(slow_ns);
}

TEST(Particles, keep_to_the_time_budget) {
    const Box box;
    ParticleSettings settings = few();
    settings.now = &slow_now;
    Particles particles(box.bricks, box.density, settings);
    for (int i = 0; i < 12000; ++i) {
        const Vec3 at = box.at(2 + i % 36, 10 + i / 36 % 28, 2 + i / 1008);
        ASSERT_TRUE(particles.emit(Matter::dust, at, Vec3(0.1, 0.2, 0.1)));
    }
    double cost = 0.0;
    for (int i = 0; i < 20; ++i) {
        const ParticleStep step = particles.step(1e-4, 400e-6, Vec3::Zero(), {});
        EXPECT_LE(step.cost_s, 1.1 * 400e-6);
        if (i >= 10) cost += step.cost_s / 10.0;
    }
    EXPECT_NEAR(cost, 400e-6, 40e-6);
}

TEST(Particles, far_from_the_focus_are_removed_first_when_time_is_short) {
    const Box box;
    Particles particles(box.bricks, {}, few());
    for (int i = 0; i < 12000; ++i) {
        const Vec3 at = box.at(2 + i % 36, 2 + i / 36 % 28, 2 + i / 1008);
        ASSERT_TRUE(particles.emit(Matter::dust, at, Vec3::Zero()));
    }
    const Vec3 looked_at = box.at(20, 15, 7);
    const auto mean_m = [&] {
        double sum = 0.0;
        for (const Particle& p : particles.all()) sum += (particles.place_m(p) - looked_at).norm();
        return sum / static_cast<double>(particles.all().size());
    };
    const double before_m = mean_m();
    std::uint32_t given_up = 0;
    for (int i = 0; i < 10; ++i) given_up += particles.step(0.0, 60e-6, looked_at, {}).given_up;
    EXPECT_GT(given_up, 500U);
    EXPECT_GT(particles.all().size(), 100U);
    EXPECT_LT(mean_m(), before_m);
}

TEST(Particles, keep_to_a_maximum_number_by_removing_the_least_important) {
    const Box box;
    Particles particles(box.bricks, {}, few());
    for (int i = 0; i < 12000; ++i) {
        const Vec3 at = box.at(2 + i % 36, 2 + i / 36 % 28, 2 + i / 1008);
        ASSERT_TRUE(particles.emit(Matter::dust, at, Vec3::Zero()));
    }
    particles.keep_at_most(3000);
    EXPECT_FALSE(particles.emit(Matter::dust, box.at(38, 38, 38), Vec3::Zero()));
    std::uint32_t given_up = 0;
    for (int i = 0; i < 5; ++i) {
        const ParticleStep step = particles.step(0.0, kPlenty, box.at(20, 15, 7), {});
        given_up += step.given_up;
    }
    EXPECT_LE(particles.all().size(), 3000U);
    EXPECT_GE(particles.all().size(), 2800U);
    EXPECT_EQ(given_up + particles.all().size(), 12000U);
    EXPECT_TRUE(particles.emit(Matter::dust, box.at(38, 38, 38),
                               Vec3::Zero()));  // the cap keeps a reserve for new particles
    particles.keep_at_most(1U << 30U);
    for (int i = 0; i < 10000; ++i)
        static_cast<void>(particles.emit(Matter::water, box.at(38, 38, 2), Vec3::Zero()));
    EXPECT_LE(particles.all().size(), 20000U);
}

TEST(Particles, are_thrown_out_of_a_rotating_head_in_its_direction) {
    const Box box;
    Particles particles(box.bricks, {}, {.most = 20000, .margin = 4, .gravity_m_s2 = Vec3(0.0, -1e-6, 0.0)});
    const Vec3 centre = box.at(20, 20, 20);
    for (int i = 0; i < 125; ++i)
        ASSERT_TRUE(
            particles.emit(Matter::dust, box.at(18 + i % 5, 18 + i / 5 % 5, 18 + i / 25), Vec3::Zero()));
    const Stir stir{centre, 2e-3, Vec3(0.0, 0.0, 1000.0)};
    static_cast<void>(particles.step(1e-4, kPlenty, centre, {}, stir));
    double along = 0.0;
    for (const Particle& p : particles.all()) {
        const Vec3 off = particles.place_m(p) - centre;
        along += Vec3(0.0, 0.0, 1.0)
                     .cross(off)
                     .dot(Vec3(static_cast<double>(p.velocity[0]), static_cast<double>(p.velocity[1]),
                               static_cast<double>(p.velocity[2])));
    }
    EXPECT_GT(along, 0.0);
    for (int i = 0; i < 20; ++i) static_cast<void>(particles.step(1e-3, kPlenty, centre, {}, stir));
    for (const Particle& p : particles.all()) EXPECT_GT((particles.place_m(p) - centre).norm(), 1.9e-3);
    expect_one_a_cell(particles);
    const Stir broken{Vec3::Constant(std::nan("")), 2e-3, Vec3::Zero()};
    EXPECT_EQ(particles.step(1e-3, kPlenty, centre, {}, broken).alive, 125U);
}

TEST(Particles, refuse_impossible_positions_and_settings) {
    const Box box;
    Particles particles(box.bricks, box.density, few());
    EXPECT_FALSE(particles.emit(Matter::water, Vec3(std::nan(""), 0, 0), Vec3::Zero()));
    EXPECT_FALSE(particles.emit(Matter::water, Vec3(9, 9, 9), Vec3::Zero()));
    EXPECT_FALSE(particles.emit(Matter::water, box.at(20, 4, 20), Vec3::Zero()));  // deep in bone
    BoneBricks huge = box.bricks;
    huge.size[1] = 100000;
    EXPECT_THROW(Particles(huge, {}, few()), StartupError);
    EXPECT_THROW(Particles(box.bricks, std::span(box.density).first(64), few()), StartupError);
    ParticleSettings none = few();
    none.most = 0;
    EXPECT_THROW(Particles(box.bricks, {}, none), StartupError);
}

}  // namespace
}  // namespace tact::gui_particles_test
