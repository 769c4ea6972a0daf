// A body that bends along its normal modes, against double-precision sums over its atoms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ipc/base/random.hpp"
#include "ipc/scene/density/docking_gain.hpp"
#include "ipc/scene/density/laplacian_map.hpp"
#include "ipc/scene/density/simulated_map.hpp"
#include "ipc/topics/command.hpp"
#include "prep/codebook/best_codebook.hpp"
#include "prep/modes/elastic_network.hpp"
#include "prep/synthetic/ring.hpp"
#include "rt/force/docking/docking_model.hpp"

namespace tact::force_flexible_test {
namespace {

constexpr double kA = 1e-10;
constexpr double kResolutionA = 8.0;

Vec3 atom(const Structure& s, std::size_t i) {
    return Eigen::Vector3f(s.x_m[i], s.y_m[i], s.z_m[i]).cast<double>();
}

// A subunit of the ring, and the map of the same subunit bent along its own modes by 4 Å.
struct Scene {
    Structure straight = make_ring().subunits.front();
    NormalModes modes = elastic_modes(straight, 12);
    std::array<float, kModesMax> answer_m{};
    SceneMeta meta{};
    DensityGrid grid;
    Codebook codebook = best_codebook(straight).codebook;

    Scene() {
        straight.home_com_model_m = Vec3::Constant(60.0 * kA);
        const double part[] = {0.7, -0.5, 0.4, 0.3};
        double square = 0.0;
        for (const double p : part) square += p * p;
        for (std::size_t k = 0; k < 4; ++k)
            answer_m[k] = static_cast<float>(4.0 * kA * part[k] / std::sqrt(square));
        Structure bent = straight;
        for (std::size_t i = 0; i < bent.size(); ++i) {
            const Vec3 p = atom(straight, i) + modes.shift_m(modes.node[i], answer_m);
            bent.x_m[i] = static_cast<float>(p.x());
            bent.y_m[i] = static_cast<float>(p.y());
            bent.z_m[i] = static_cast<float>(p.z());
        }
        meta.kind = SceneKind::docking;
        meta.body_count = 1;
        meta.resolution_m = kResolutionA * kA;
        grid.size = {61, 61, 61};
        grid.spacing_m = Vec3::Constant(2.0 * kA);
        meta.world_per_model = 0.16 / (120.0 * kA);
        for (double& c : meta.centre_model_m) c = 60.0 * kA;
        const PlacedStructure one[] = {{&bent, straight.home()}};
        grid.values = simulated_map(grid, one, meta.resolution_m);
        meta.map_sigma = rms_of(grid);
        const std::vector<Structure> structures{straight};
        const std::vector<Codebook> codebooks{codebook};
        meta.energy_j_per_sigma =
            docking_gain(make_level_maps(grid, 0.0, meta.map_sigma, meta.resolution_m,
                                         level_smoothings_m(structures, codebooks, meta.resolution_m)),
                         structures, codebooks, meta.world_per_model)
                .energy_j_per_sigma;
    }

    // Relative to the seventh of twelve modes.
    [[nodiscard]] double spring(std::size_t k) const {
        return 3.0 * static_cast<double>(modes.stiffness[k]) / static_cast<double>(modes.stiffness[6]);
    }
    [[nodiscard]] double off_a(const BodyShape& shape) const {
        double square = 0.0;
        for (std::size_t k = 0; k < kModesMax; ++k) {
            const auto d = static_cast<double>(shape.amplitude_m[k]) - static_cast<double>(answer_m[k]);
            square += d * d;
        }
        return std::sqrt(square) / kA;
    }
};

const Scene& scene() {
    static const Scene made;
    return made;
}

class Flexible : public testing::Test {
protected:
    DockingModel model_{scene().meta,       scene().grid, {scene().straight},
                        {scene().codebook}, {},           {scene().modes}};
    ToolState tool_;
    Budget budget_;

    Flexible() {
        tool_.T_world_tool = {Vec3(0.01, 0.02, -0.01), Quat::Identity()};
        model_.reset(tool_);
    }
    void turn(bool on) {
        ModelOrder order;
        order.kind = ModelOrder::Kind::setting;
        order.command = static_cast<std::uint8_t>(CommandKind::set_flexible);
        order.on = on;
        ASSERT_TRUE(model_.order(order));
    }
    StepResult run(int steps, double step_s = 1e-3) {
        StepResult result;
        for (int i = 0; i < steps; ++i) {
            model_.drive({.enabled = true, .on = false, .step_s = step_s});
            result = model_.step(tool_, budget_);
        }
        return result;
    }
    [[nodiscard]] const BodyShape& shape() const { return model_.flexible().shapes().front(); }
    // -U / k_E of the body as it is bent now: sigma.
    [[nodiscard]] double well_sigma(double bound) const {
        const Pose T = model_.bodies().T_model_body[0];
        double sum = 0.0;
        for (std::size_t i = 0; i < scene().straight.size(); ++i) {
            Vec3 gradient;
            const Vec3 p =
                atom(scene().straight, i) + scene().modes.shift_m(scene().modes.node[i], shape().amplitude_m);
            sum +=
                static_cast<double>(scene().straight.mass_fraction[i]) * model_.map().sample(T * p, gradient);
        }
        for (std::size_t k = 0; k < scene().modes.count(); ++k) {
            const auto a = static_cast<double>(shape().amplitude_m[k]);
            sum -= 0.5 * FlexibleBody::kSoftness * scene().spring(k) * bound * a * a;
        }
        return sum;
    }
};

TEST_F(Flexible, a_body_bends_into_the_map_of_its_bent_self) {
    EXPECT_NEAR(scene().off_a(BodyShape{}), 4.0, 1e-5);
    turn(true);
    EXPECT_EQ(model_.bodies().options, kDockingFlexible);
    run(3000);
    EXPECT_LT(scene().off_a(shape()), 1.5);
    EXPECT_NEAR(shape().rmsd_m() / kA, 4.0, 1.0);
    EXPECT_GT(model_.flexible().strain(), 0.0);
    EXPECT_LE(model_.flexible().strain(), StrainLimit::kMost + StrainLimit::kSlack);
}

TEST_F(Flexible, it_bends_at_any_level_and_rate) {
    for (const auto& [fidelity, step_s] :
         {std::pair(0.0F, 2e-3), std::pair(0.3F, 2.5e-4), std::pair(0.7F, 1e-3)}) {
        DockingModel other{scene().meta,       scene().grid, {scene().straight},
                           {scene().codebook}, {},           {scene().modes}};
        ASSERT_TRUE(other.set_options(kDockingFlexible, true));
        other.reset(tool_);
        budget_.fidelity = fidelity;
        for (double t = 0.0; t < 2.5; t += step_s) {
            other.drive({.enabled = true, .on = false, .step_s = step_s});
            static_cast<void>(other.step(tool_, budget_));
        }
        EXPECT_LT(scene().off_a(other.flexible().shapes().front()), 1.5) << fidelity << ", " << step_s;
    }
}

// The drive of the modes is the gradient of the energy: bending without a moving hand only lowers it, in every tenth of a second,
// and ends where no mode would lower it further.
TEST_F(Flexible, bending_only_lowers_the_energy) {
    turn(true);
    run(30);
    // B, by its definition the bound of the level of all atoms, which stiffness() states before anything is measured.
    const DockingModel fresh{scene().meta,       scene().grid, {scene().straight},
                             {scene().codebook}, {},           {scene().modes}};
    const double scale_2 = scene().meta.world_per_model * scene().meta.world_per_model;
    const double bound = fresh.stiffness().force_n_m * scale_2 / scene().meta.energy_j_per_sigma;
    double before = well_sigma(bound);
    const double first = before;
    for (int i = 0; i < 30; ++i) {
        run(100);
        const double now = well_sigma(bound);
        EXPECT_GE(now, before - 1e-4) << i;
        before = now;
    }
    EXPECT_GT(before, first + 0.2);
}

TEST_F(Flexible, a_turned_body_bends_downhill_too) {
    ModelOrder place;
    place.kind = ModelOrder::Kind::place;
    place.body = 1;
    place.T_model_body = {scene().straight.home_com_model_m,
                          Quat(0.0, 1.0, 0.0, 0.0)};  // half a turn: the wrong frame would drive uphill
    ASSERT_TRUE(model_.order(place));
    turn(true);
    run(30);
    double before = well_sigma(0.0);
    const double first = before;
    for (int i = 0; i < 10; ++i) {
        run(100);
        const double now = well_sigma(0.0);
        EXPECT_GE(now, before - 0.01) << i;  // the springs are left out here
        before = now;
    }
    EXPECT_GT(before, first + 0.05);
}

TEST_F(Flexible, without_density_its_springs_straighten_it_at_their_rates) {
    turn(true);
    run(3000);
    ModelOrder place;
    place.kind = ModelOrder::Kind::place;
    place.body = 1;
    place.T_model_body = scene().straight.home();
    place.T_model_body.p_m.x() += 140.0 * kA;
    ASSERT_TRUE(model_.order(place));
    run(100);
    const BodyShape before = shape();
    run(2000);
    for (const std::size_t k : {0U, 1U, 2U}) {
        const double rate = FlexibleBody::kRatePerS * FlexibleBody::kSoftness * scene().spring(k);
        const double kept =
            static_cast<double>(shape().amplitude_m[k]) / static_cast<double>(before.amplitude_m[k]);
        EXPECT_NEAR(kept, std::exp(-2.0 * rate), 0.02) << k;
    }
}

TEST_F(Flexible, it_bends_no_faster_than_stated) {
    turn(true);
    double fastest_m = 0.0;
    BodyShape before = shape();
    for (int i = 0; i < 1000; ++i) {
        run(1);
        double way_2 = 0.0;
        for (std::size_t k = 0; k < kModesMax; ++k)
            way_2 += std::pow(static_cast<double>(shape().amplitude_m[k] - before.amplitude_m[k]), 2);
        fastest_m = std::max(fastest_m, std::sqrt(way_2));
        before = shape();
    }
    EXPECT_LE(fastest_m, 1.01e-3 * FlexibleBody::kSpeedMost_m_s);
    EXPECT_GT(fastest_m, 0.5e-3 * FlexibleBody::kSpeedMost_m_s);
}

TEST_F(Flexible, the_force_is_that_of_the_bent_atoms) {
    turn(true);
    run(1500);
    // Beside the fit, so that there is a force. The body bends on while it is held there.
    tool_.T_world_tool.p_m.x() += 2.0 * kA * scene().meta.world_per_model;
    const StepResult felt = run(1500);
    ASSERT_EQ(felt.status, StepStatus::ok);
    const Pose T = model_.bodies().T_model_body[0];
    Vec3 force = Vec3::Zero();
    for (std::size_t i = 0; i < scene().straight.size(); ++i) {
        Vec3 gradient;
        const Vec3 p =
            atom(scene().straight, i) + scene().modes.shift_m(scene().modes.node[i], shape().amplitude_m);
        static_cast<void>(model_.map().sample(T * p, gradient));
        force += static_cast<double>(scene().straight.mass_fraction[i]) * gradient;
    }
    force *= scene().meta.energy_j_per_sigma / scene().meta.world_per_model;
    EXPECT_GT(force.norm(), 0.02);
    EXPECT_LT((felt.wrench_world.force_n - force).norm(), 0.01 * force.norm());
}

// The hand gets back no more than it put in, around any closed path that ends in the shape of its start.
TEST_F(Flexible, closed_paths_give_no_energy_away) {
    turn(true);
    run(3000);
    const Vec3 home = tool_.T_world_tool.p_m;
    SeededRandom random(5);
    for (int path = 0; path < 6; ++path) {
        const Vec3 a = random.direction(), b = random.direction();
        const double radius_m = 4.0 * kA * scene().meta.world_per_model;
        double work_j = 0.0;
        Vec3 force = run(1500).wrench_world.force_n;  // at rest: the shape settles
        constexpr int kSteps = 1000;
        for (int i = 1; i <= kSteps; ++i) {
            const double phase = 2.0 * std::numbers::pi * i / kSteps;
            const Vec3 before = tool_.T_world_tool.p_m;
            tool_.T_world_tool.p_m = home + radius_m * (std::sin(phase) * a + (1.0 - std::cos(phase)) * b);
            const Vec3 now = run(1).wrench_world.force_n;
            work_j += 0.5 * (force + now).dot(tool_.T_world_tool.p_m - before);
            force = now;
        }
        EXPECT_LT(work_j, 1e-6) << "path " << path << ": the body gave energy to the hand";
    }
}

TEST_F(Flexible, switched_off_it_returns_to_its_own_shape) {
    const Vec3 rigid = run(600).wrench_world.force_n;
    turn(true);
    run(2000);
    ASSERT_GT(shape().rmsd_m(), 2.0 * kA);
    turn(false);
    run(200);
    EXPECT_GT(shape().rmsd_m(), 0.1 * kA);  // no jump
    run(12000);
    EXPECT_EQ(shape().rmsd_m(), 0.0);
    EXPECT_FALSE(model_.flexible().bent());
    EXPECT_EQ(run(1).wrench_world.force_n, rigid);
}

TEST_F(Flexible, no_order_makes_the_force_step) {
    tool_.T_world_tool.p_m.y() += 3.0 * kA * scene().meta.world_per_model;
    Vec3 before = run(600).wrench_world.force_n;
    double largest = 0.0;
    for (int i = 0; i < 4000; ++i) {
        if (i % 1000 == 100) turn(i % 2000 == 100);
        const Vec3 now = run(1).wrench_world.force_n;
        largest = std::max(largest, (now - before).norm());
        before = now;
    }
    EXPECT_LT(largest, 0.04);  // 40 N/s, as ForceFade
}

TEST_F(Flexible, a_fixed_body_keeps_its_shape_and_a_removed_one_is_forgotten) {
    turn(true);
    run(500);
    ModelOrder fix;
    fix.kind = ModelOrder::Kind::fix;
    fix.body = 1;
    fix.on = true;
    ASSERT_TRUE(model_.order(fix));
    const BodyShape kept = shape();
    ASSERT_GT(kept.rmsd_m(), 0.0);
    run(500);
    EXPECT_EQ(shape().amplitude_m, kept.amplitude_m);
    ModelOrder add;
    add.kind = ModelOrder::Kind::add;
    add.T_model_body = model_.home();
    ASSERT_TRUE(model_.order(add));
    ModelOrder remove;
    remove.kind = ModelOrder::Kind::remove;
    remove.body = 1;
    ASSERT_TRUE(model_.order(remove));
    EXPECT_EQ(shape().id, 0U);
}

TEST_F(Flexible, a_rigid_body_in_the_hand_leaves_the_shapes_of_others) {
    DockingModel two{scene().meta,
                     scene().grid,
                     {scene().straight, scene().straight},
                     {scene().codebook, scene().codebook},
                     {},
                     {scene().modes, {}}};
    ASSERT_TRUE(two.set_options(kDockingFlexible, true));
    two.reset(tool_);
    for (int i = 0; i < 1000; ++i) static_cast<void>(two.step(tool_, budget_));
    const BodyShape kept = two.flexible().shapes().front();
    ASSERT_GT(kept.rmsd_m(), 1e-10);
    ModelOrder select;
    select.kind = ModelOrder::Kind::select;
    select.body = 2;
    ASSERT_TRUE(two.order(select));
    for (int i = 0; i < 100; ++i) static_cast<void>(two.step(tool_, budget_));
    EXPECT_EQ(two.flexible().shapes().front().amplitude_m, kept.amplitude_m);
}

TEST_F(Flexible, a_rebuilt_model_keeps_the_shape) {
    turn(true);
    run(2000);
    ASSERT_TRUE(model_.set_options(kDockingLaplacian, true));
    const auto next = model_.rebuild(model_.bodies());
    ASSERT_TRUE(next && next->adopt(model_));
    const auto& adopted = dynamic_cast<const DockingModel&>(*next);
    EXPECT_EQ(adopted.flexible().shapes().front().amplitude_m, shape().amplitude_m);
    EXPECT_EQ(adopted.bodies().options, kDockingFlexible | kDockingLaplacian);
}

TEST_F(Flexible, strain_stays_bounded_whatever_pulls) {
    // A map of one far blob pulls everything the same way, as hard as the gain allows.
    DensityGrid grid = scene().grid;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x)
                grid.values[(std::size_t{z} * grid.size[1] + y) * grid.size[0] + x] =
                    static_cast<float>(std::exp(-0.01 * (std::pow(x - 12.0, 2) + std::pow(y - 30.0, 2))) +
                                       std::exp(-0.01 * (std::pow(x - 48.0, 2) + std::pow(z - 30.0, 2))));
        }
    }
    SceneMeta meta = scene().meta;
    meta.energy_j_per_sigma *= 1000.0;
    DockingModel pulled{meta, grid, {scene().straight}, {scene().codebook}, {}, {scene().modes}};
    ASSERT_TRUE(pulled.set_options(kDockingFlexible, true));
    pulled.reset(tool_);
    double largest = 0.0;
    for (int i = 0; i < 4000; ++i) {
        static_cast<void>(pulled.step(tool_, budget_));
        const BodyShape& s = pulled.flexible().shapes().front();
        // Of the centres of residues, from the atoms and the published amplitudes alone.
        for (std::size_t a = 1; i % 200 == 199 && a < scene().straight.size(); ++a) {
            const std::size_t n = scene().modes.node[a], m = scene().modes.node[a - 1];
            if (n == m) continue;
            Vec3 at[2] = {Vec3::Zero(), Vec3::Zero()};
            double count[2] = {0.0, 0.0};
            for (std::size_t b = 0; b < scene().straight.size(); ++b) {
                if (scene().modes.node[b] != n && scene().modes.node[b] != m) continue;
                const std::size_t which = scene().modes.node[b] == n ? 1 : 0;
                at[which] += atom(scene().straight, b);
                count[which] += 1.0;
            }
            const Vec3 rest = at[1] / count[1] - at[0] / count[0];
            if (rest.norm() > 8.0 * kA) continue;
            const Vec3 bent =
                rest + scene().modes.shift_m(n, s.amplitude_m) - scene().modes.shift_m(m, s.amplitude_m);
            largest = std::max(largest, std::abs(bent.norm() / rest.norm() - 1.0));
        }
    }
    EXPECT_GT(largest, 0.05);
    EXPECT_LE(largest, StrainLimit::kMost + StrainLimit::kSlack);
    EXPECT_NEAR(pulled.flexible().strain(), largest, 0.02);
}

TEST(FlexibleRigid, without_modes_the_order_changes_nothing) {
    DockingModel rigid{scene().meta, scene().grid, {scene().straight}, {scene().codebook}, {}};
    ToolState tool;
    rigid.reset(tool);
    ASSERT_TRUE(rigid.set_options(kDockingFlexible, true));
    for (int i = 0; i < 300; ++i) static_cast<void>(rigid.step(tool, Budget{}));
    EXPECT_FALSE(rigid.flexible().bent());
    EXPECT_EQ(rigid.flexible().shapes().front().id, 0U);
}

}  // namespace
}  // namespace tact::force_flexible_test
