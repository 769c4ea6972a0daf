// The stated stiffness of the docking force against an independent reference, at rest, in motion and at the answer.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>
#include <string>

#include "ipc/scene/density/docking_gain.hpp"
#include "rt/force/docking/docking_model.hpp"
#include "rt/force/docking/start_pose.hpp"
#include "tests/unit/chain_sample.hpp"
#include "tests/unit/force_rod_scene.hpp"

namespace tact::force_docking_stiffness_test {
namespace {

using namespace chain;

constexpr double kResolutionM = 9.0 * kA, kSigmaM = 0.225 * kResolutionM;
constexpr std::size_t kAtoms = 800;

// A chain in its own map, with codebook levels of runs of atoms, and the gain that a bake would choose.
struct Scene {
    SceneMeta meta{};
    Structure chain = structure(kAtoms);
    DensityGrid grid;
    Codebook codebook;
    DockingGain gain;
    LevelMaps maps;
    double resolution_m = kResolutionM;
};

const Scene& scene() {
    static const Scene made = [] {
        Scene s;
        s.grid = map_of(s.chain, kSigmaM, kResolutionM / 3.5);
        for (const std::size_t share : {32, 16, 8, 4, 2}) rod::add_level(s.codebook, s.chain, share);
        s.meta.kind = SceneKind::docking;
        s.meta.body_count = 1;
        s.meta.world_per_model = 0.12 / (100.0 * kA);
        for (int a = 0; a < 3; ++a) s.meta.centre_model_m[a] = s.chain.home_com_model_m[a];
        s.meta.map_sigma = sigma_of(s.grid);
        s.meta.resolution_m = kResolutionM;
        s.maps = make_level_maps(s.grid, 0.0, s.meta.map_sigma, kResolutionM,
                                 level_smoothings_m({&s.chain, 1}, {&s.codebook, 1}, kResolutionM));
        s.gain = docking_gain(s.maps, {&s.chain, 1}, {&s.codebook, 1}, s.meta.world_per_model);
        s.meta.energy_j_per_sigma = s.gain.energy_j_per_sigma;
        return s;
    }();
    return made;
}

std::unique_ptr<DockingModel> make_chain_model(const DockingSettings& settings = {}) {
    const Scene& s = scene();
    return std::make_unique<DockingModel>(s.meta, s.grid, std::vector<Structure>{s.chain},
                                          std::vector<Codebook>{s.codebook}, settings);
}

const reference::Spline& exact_map() {
    static const reference::Spline spline(grid_of(scene().grid, 0.0, scene().meta.map_sigma));
    return spline;
}

reference::Gain gain() { return {scene().meta.energy_j_per_sigma, scene().meta.world_per_model}; }

reference::Stiffness exact_stiffness(const Pose& body) {
    return reference::stiffness(sum(exact_map(), atoms_of(scene().chain), place_of(body)), gain());
}

ModelOrder place(const Pose& body) {
    ModelOrder order;
    order.kind = ModelOrder::Kind::place;
    order.body = 1;
    order.T_model_body = body;
    return order;
}

ToolState tool_for(const Pose& hand) { return rod::tool_at(hand); }

// Rests for a tenth of a second of steps of this length.
void rest(DockingModel& model, const Pose& hand, float fidelity, double step_s) {
    for (double t = 0.0; t < 0.1; t += step_s) {
        model.drive({.step_s = step_s});
        (void)model.step(tool_for(hand), rod::at(fidelity));
    }
}

TEST(DockingStiffness, at_rest_it_is_that_of_an_independent_reference_at_any_rate) {
    SeededRandom random(2);
    for (const double step_s : {1e-3, 1e-4, 1e-2}) {
        const auto model = make_chain_model();
        for (int i = 0; i < 4; ++i) {
            const Pose body =
                start_pose(model->home(), 8.0 * kA * random.uniform(), 0.6 * random.uniform(), random.next());
            ASSERT_TRUE(model->order(place(body)));
            rest(*model, rod::kGrip, 1.0F, step_s);
            const reference::Stiffness exact = exact_stiffness(body);
            const ModelStiffness felt = model->stiffness();
            EXPECT_NEAR(felt.force_n_m, exact.force_n_m, 0.01 * exact.force_n_m) << step_s;
            EXPECT_NEAR(felt.torque_n_m_rad, exact.torque_n_m_rad, 0.01 * exact.torque_n_m_rad) << step_s;
        }
    }
}

// Finite differences of the force that the model itself gives at this level.
TEST(DockingStiffness, at_rest_it_is_the_derivative_of_the_force_at_every_level) {
    const auto model = make_chain_model();
    const Pose body = start_pose(model->home(), 2.0 * kA, 0.1, 4);
    ASSERT_TRUE(model->order(place(body)));
    for (const float level : {0.0F, 0.2F, 0.4F, 0.5F, 0.6F, 0.9F, 1.0F}) {
        rest(*model, rod::kGrip, level, 1e-3);
        Eigen::Matrix3d by_shift, by_turn;
        for (int a = 0; a < 3; ++a) {
            const double step_m = 0.05 * kA, turn_rad = 2e-3;
            Pose fore = body, back = body;
            fore.p_m[a] += step_m, back.p_m[a] -= step_m;
            by_shift.col(a) = (model->evaluate(fore, rod::at(level)).wrench_world.force_n -
                               model->evaluate(back, rod::at(level)).wrench_world.force_n) /
                              (2.0 * step_m * scene().meta.world_per_model);
            fore = back = body;
            fore.q = quat_from_rotation_vector(turn_rad * Vec3::Unit(a)) * body.q;
            back.q = quat_from_rotation_vector(-turn_rad * Vec3::Unit(a)) * body.q;
            by_turn.col(a) = (model->evaluate(fore, rod::at(level)).wrench_world.torque_n_m -
                              model->evaluate(back, rod::at(level)).wrench_world.torque_n_m) /
                             (2.0 * turn_rad);
        }
        const auto norm = [](const Eigen::Matrix3d& m) {
            return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(0.5 * (m + m.transpose()))
                .eigenvalues()
                .cwiseAbs()
                .maxCoeff();
        };
        // A blend states the sum of both levels' norms, at most some percent more.
        EXPECT_NEAR(model->stiffness().force_n_m / norm(by_shift), 1.0, 0.05) << "level " << level;
        EXPECT_NEAR(model->stiffness().torque_n_m_rad / norm(by_turn), 1.0, 0.05) << "level " << level;
    }
}

TEST(DockingStiffness, in_motion_it_is_an_upper_bound) {
    const auto model = make_chain_model();
    SeededRandom random(6);
    int above = 0, count = 0;
    for (int path = 0; path < 12; ++path) {
        const Pose start =
            start_pose(model->home(), 8.0 * kA * random.uniform(), 0.4 * random.uniform(), random.next());
        ASSERT_TRUE(model->order(place(start)));
        model->reset(tool_for(rod::kGrip));
        Pose hand = rod::kGrip;
        const Vec3 way = random.direction(), axis = random.direction();
        const double speed_m_s = path % 3 == 0 ? 0.1 : path % 3 == 1 ? 0.02 : 0.003;
        for (int i = 1; i <= 200; ++i) {
            hand.p_m += 1e-3 * speed_m_s * way;
            hand.q = quat_from_rotation_vector(1e-3 * 10.0 * speed_m_s * axis) * hand.q;
            (void)model->step(tool_for(hand), rod::at(1.0F));
            if (i % 20 != 0) continue;
            const reference::Stiffness exact = exact_stiffness(model->bodies().T_model_body[0]);
            const ModelStiffness felt = model->stiffness();
            ++count;
            if (felt.force_n_m < 0.99 * exact.force_n_m || felt.torque_n_m_rad < 0.99 * exact.torque_n_m_rad)
                ++above;
        }
    }
    EXPECT_EQ(count, 120);
    EXPECT_EQ(above, 0);
}

TEST(DockingStiffness, before_the_first_step_it_covers_every_level_at_the_answer) {
    const auto model = make_chain_model();
    const Pose fit{model->home().p_m, model->home().q};
    const ModelStiffness before = model->stiffness();
    const reference::Stiffness exact = exact_stiffness(fit);
    EXPECT_GE(before.force_n_m, exact.force_n_m);
    EXPECT_GE(before.torque_n_m_rad, exact.torque_n_m_rad);
    EXPECT_LT(before.force_n_m, 3.0 * exact.force_n_m);
}

TEST(DockingStiffness, two_runs_state_the_same_to_the_bit) {
    const auto a = make_chain_model(), b = make_chain_model();
    Pose hand = rod::kGrip;
    for (int i = 0; i < 500; ++i) {
        hand.p_m += Vec3(1e-5, -2e-5, 1e-5) * std::sin(0.02 * i);
        const float fidelity = i < 250 ? 0.7F : 1.0F;
        (void)a->step(tool_for(hand), rod::at(fidelity));
        (void)b->step(tool_for(hand), rod::at(fidelity));
        ASSERT_EQ(a->stiffness().force_n_m, b->stiffness().force_n_m);
        ASSERT_EQ(a->stiffness().torque_n_m_rad, b->stiffness().torque_n_m_rad);
    }
}

TEST(DockingStiffness, follows_the_force_scale_and_is_zero_with_an_empty_hand) {
    DockingSettings settings;
    settings.force_scale = 0.25;
    const auto full = make_chain_model(), quarter = make_chain_model(settings);
    rest(*full, rod::kGrip, 1.0F, 1e-3);
    rest(*quarter, rod::kGrip, 1.0F, 1e-3);
    EXPECT_NEAR(quarter->stiffness().force_n_m, 0.25 * full->stiffness().force_n_m, 1e-9);
    EXPECT_NEAR(quarter->stiffness().torque_n_m_rad, 0.25 * full->stiffness().torque_n_m_rad, 1e-9);
    ModelOrder release;
    release.kind = ModelOrder::Kind::select;
    release.body = ModelBodies::kNone;
    ASSERT_TRUE(full->order(release));
    EXPECT_EQ(full->stiffness().force_n_m, 0.0);
}

// The gain's search starts at the pose in the file; here the file has the structure 12 A and 20 degrees away from its answer.
TEST(DockingStiffness, the_gain_keeps_its_limits_at_the_answer_of_a_structure_away_from_home) {
    const Scene& s = scene();
    Structure away = s.chain;
    away.home_com_model_m += 12.0 * kA * Vec3(0.6, -0.64, 0.48);
    const Quat turn = quat_from_rotation_vector(0.35 * Vec3(0.48, 0.6, 0.64));
    for (std::size_t i = 0; i < away.size(); ++i) {
        const Vec3 p = turn * Vec3(static_cast<double>(away.x_m[i]), static_cast<double>(away.y_m[i]),
                                   static_cast<double>(away.z_m[i]));
        away.x_m[i] = static_cast<float>(p.x());
        away.y_m[i] = static_cast<float>(p.y());
        away.z_m[i] = static_cast<float>(p.z());
    }
    const Codebook none;
    const DockingGain found =
        docking_gain(s.maps, {&away, 1}, {&none, 1}, s.meta.world_per_model, {.climbs = 16});
    const reference::Atoms atoms = atoms_of(s.chain);
    const reference::Place answer = climbed(exact_map(), atoms, place_of(s.chain.home()));
    const reference::Sums at_answer = sum(exact_map(), atoms, answer);
    const reference::Gain used{found.energy_j_per_sigma, s.meta.world_per_model};
    EXPECT_LE(reference::stiffness(at_answer, used).force_n_m, 300.0 * 1.01);
    EXPECT_NEAR(found.stiffness_n_m_max, 300.0, 1.0);  // the stiffness, not the force, limits this scene
    SeededRandom random(8);
    for (int i = 0; i < 30; ++i) {
        reference::Place near = answer;
        near.p_m += random.within(5.0 * kA);
        EXPECT_LE(wrench(sum(exact_map(), atoms, near), used).force_n.norm(), 2.0 * 1.1);
    }
}

// Vectors in the map of the atoms see details that the atoms average out; in a map smoothed by their cells they do not. Not of
// the two coarsest levels, whose cells are wider than the map resolves (level_maps.cpp).
TEST(DockingLevels, a_level_is_nearer_to_all_atoms_than_its_vectors_in_the_map_of_the_atoms) {
    const auto model = make_chain_model();
    const std::size_t levels = scene().codebook.levels.size();
    SeededRandom random(8);
    for (std::size_t level = 3; level < levels; ++level) {
        const reference::Atoms vectors = atoms_of(scene().codebook.levels[level].view());
        Budget budget;
        budget.fidelity = static_cast<float>(level) / static_cast<float>(levels);
        double smoothed = 0.0, sharp = 0.0;
        for (int i = 0; i < 60; ++i) {
            Pose at = scene().chain.home();
            at.p_m += random.within(6.0 * kA);
            at.q = quat_from_rotation_vector(random.within(0.3)) * at.q;
            const Vec3 all_n =
                reference::wrench(sum(exact_map(), atoms_of(scene().chain), place_of(at)), gain()).force_n;
            smoothed += (model->evaluate(at, budget).wrench_world.force_n - all_n).squaredNorm();
            sharp += (reference::wrench(sum(exact_map(), vectors, place_of(at)), gain()).force_n - all_n)
                         .squaredNorm();
        }
        EXPECT_LT(std::sqrt(smoothed), 0.5 * std::sqrt(sharp)) << "level " << level;
    }
}

}  // namespace
}  // namespace tact::force_docking_stiffness_test
