// The refinement on maps made from the structure itself, with a known best pose.
#include "ipc/scene/fit/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ipc/base/error.hpp"
#include "ipc/base/random.hpp"
#include "ipc/scene/density/simulated_map.hpp"

namespace tact::scene_refine_test {
namespace {

constexpr double kA = kAngstromM;
constexpr double kResolutionM = 8.0 * kA;
constexpr RefineGoal kGoals[] = {RefineGoal::mean_density, RefineGoal::correlation_zero,
                                 RefineGoal::correlation_mean};

// An asymmetric cloud of carbon atoms: no symmetry axis, three different extents.
Structure cloud() {
    Structure s;
    s.name = "cloud";
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<Vec3> at;
    Vec3 mean = Vec3::Zero();
    for (int i = 0; i < 400; ++i) {
        Vec3 p(14.0 * normal(random), 9.0 * normal(random), 6.0 * normal(random));
        if (i % 4 == 0) p = Vec3(18.0, 12.0, 3.0) + 0.3 * p;
        at.push_back(p * kA);
        mean += at.back() / 400.0;
    }
    for (const Vec3& p : at) {
        s.x_m.push_back(static_cast<float>(p.x() - mean.x()));
        s.y_m.push_back(static_cast<float>(p.y() - mean.y()));
        s.z_m.push_back(static_cast<float>(p.z() - mean.z()));
        s.mass_fraction.push_back(1.0F / 400.0F);
        s.element.push_back(6);
    }
    s.mass_u = 4800.0;
    return s;
}

const Pose kTruth{Vec3(3.0, -2.0, 5.0) * kA, quat_from_rotation_vector(Vec3(0.3, 0.5, -0.2))};

struct Scene {
    Structure structure = cloud();
    DensityGrid grid;
    Scene() {
        grid.size = {64, 58, 54};
        grid.spacing_m = Vec3::Constant(2.0 * kA);
        grid.origin_m = Vec3(-63.0, -57.0, -53.0) * kA;
        const PlacedStructure placed{&structure, kTruth};
        grid.values = simulated_map(grid, {&placed, 1}, kResolutionM);
    }
};

const Scene& scene() {
    static const Scene one;
    return one;
}

const DensityMap& map() {
    static const DensityMap one(scene().grid, 0.0, 10.0);
    return one;
}

RefineSettings settings(RefineGoal goal) {
    RefineSettings s;
    s.goal = goal;
    s.resolution_m = kResolutionM;
    return s;
}

Pose displaced(const Pose& from, double distance_m, double angle_rad, SeededRandom& random) {
    const auto direction = [&random] {
        Vec3 v;
        do v = Vec3(random.uniform(), random.uniform(), random.uniform()) * 2.0 - Vec3::Ones();
        while (v.norm() < 0.1 || v.norm() > 1.0);
        return Vec3(v.normalized());
    };
    return {from.p_m + distance_m * direction(),
            (quat_from_rotation_vector(angle_rad * direction()) * from.q).normalized()};
}

double mean_density(const Pose& pose) {
    double sum = 0.0;
    Vec3 gradient;
    const Structure& s = scene().structure;
    for (std::size_t i = 0; i < s.size(); ++i)
        sum += map().sample(pose * Vec3(static_cast<double>(s.x_m[i]), static_cast<double>(s.y_m[i]),
                                        static_cast<double>(s.z_m[i])),
                            gradient) /
               static_cast<double>(s.size());
    return sum;
}

TEST(Refine, returns_to_the_maximum_from_two_angstrom_and_ten_degrees) {
    for (const RefineGoal goal : kGoals) {
        SeededRandom random(11);
        for (int trial = 0; trial < 8; ++trial) {
            const Pose start = displaced(kTruth, 2.0 * kA, 10.0 * kDegreeRad, random);
            const RefineResult r = refine(map(), scene().structure, start, settings(goal));
            SCOPED_TRACE("goal " + std::to_string(static_cast<int>(goal)) + " trial " +
                         std::to_string(trial) + " iterations " + std::to_string(r.iterations));
            EXPECT_EQ(r.end, RefineEnd::converged);
            EXPECT_LT((r.T_model_body.p_m - kTruth.p_m).norm(), 0.05 * kA);
            EXPECT_LT(r.T_model_body.q.angularDistance(kTruth.q), 0.2 * kDegreeRad);
            EXPECT_GT(r.score, r.score_start);
            EXPECT_LT(r.iterations, 60U);
        }
    }
}

TEST(Refine, ends_at_a_local_maximum) {
    SeededRandom random(12);
    const Pose start = displaced(kTruth, 3.0 * kA, 12.0 * kDegreeRad, random);
    const RefineResult r = refine(map(), scene().structure, start);
    EXPECT_NEAR(r.score, mean_density(r.T_model_body), 1e-4);
    EXPECT_NEAR(r.score_start, mean_density(start), 1e-4);
    for (int a = 0; a < 3; ++a) {
        for (const double sign : {-1.0, 1.0}) {
            Vec3 axis = Vec3::Zero();
            axis[a] = sign;
            const Pose& best = r.T_model_body;
            EXPECT_LT(mean_density({best.p_m + 0.2 * kA * axis, best.q}), r.score);
            EXPECT_LT(mean_density({best.p_m, quat_from_rotation_vector(0.5 * kDegreeRad * axis) * best.q}),
                      r.score);
        }
    }
}

TEST(Refine, never_lowers_the_score_from_any_start) {
    SeededRandom random(13);
    for (const RefineGoal goal : kGoals) {
        for (int trial = 0; trial < 12; ++trial) {
            const Pose start =
                displaced(kTruth, 90.0 * kA * random.uniform(), 3.1 * random.uniform(), random);
            RefineSettings s = settings(goal);
            s.iterations_max = 40;
            const RefineResult r = refine(map(), scene().structure, start, s);
            EXPECT_GE(r.score, r.score_start);
            EXPECT_TRUE(r.T_model_body.finite());
            EXPECT_NEAR(r.T_model_body.q.norm(), 1.0, 1e-9);
            if (goal == RefineGoal::mean_density) {
                EXPECT_GE(mean_density(r.T_model_body), mean_density(start) - 1e-4);
            }
        }
    }
}

TEST(Refine, keeps_its_step_limit) {
    SeededRandom random(14);
    const Pose start = displaced(kTruth, 2.0 * kA, 10.0 * kDegreeRad, random);
    RefineSettings s = settings(RefineGoal::mean_density);
    s.step_m_max = 0.1 * kA;
    Pose last = start;
    for (std::uint32_t n = 1; n <= 10; ++n) {  // the n-th iteration, as seen by the caller
        s.iterations_max = n;
        const RefineResult r = refine(map(), scene().structure, start, s);
        EXPECT_LE((r.T_model_body.p_m - last.p_m).norm(), 0.1 * kA * 1.0001);
        EXPECT_EQ(r.iterations, n);
        EXPECT_EQ(r.end, RefineEnd::iterations);
        last = r.T_model_body;
    }
}

TEST(Refine, repeats_exactly_and_can_be_cancelled) {
    SeededRandom random(15);
    const Pose start = displaced(kTruth, 2.0 * kA, 10.0 * kDegreeRad, random);
    const RefineResult a = refine(map(), scene().structure, start);
    double last = -1.0;
    std::uint32_t calls = 0;
    const RefineResult b = refine(map(), scene().structure, start, {}, [&](std::uint32_t i, double score) {
        EXPECT_EQ(i, calls++);
        EXPECT_GE(score, last - 1e-5);
        last = score;
        return true;
    });
    EXPECT_EQ(a.T_model_body.p_m, b.T_model_body.p_m);
    EXPECT_EQ(a.T_model_body.q.coeffs(), b.T_model_body.q.coeffs());
    const RefineResult c =
        refine(map(), scene().structure, start, {}, [](std::uint32_t i, double) { return i < 3; });
    EXPECT_EQ(c.end, RefineEnd::cancelled);
    EXPECT_EQ(c.iterations, 3U);
    EXPECT_GT(c.score, c.score_start);
}

TEST(Refine, without_density_nothing_moves) {
    const Pose far{Vec3(0.0, 1e-6, 0.0), Quat::Identity()};
    for (const RefineGoal goal : kGoals) {
        const RefineResult r = refine(map(), scene().structure, far, settings(goal));
        EXPECT_EQ(r.end, RefineEnd::no_density);
        EXPECT_EQ(r.T_model_body.p_m, far.p_m);
    }
}

TEST(Refine, handles_a_rod_and_a_single_atom) {
    Structure rod = scene().structure;
    for (std::size_t i = 0; i < rod.size(); ++i) rod.y_m[i] = rod.z_m[i] = 0.0F;
    Structure atom = scene().structure;
    atom.x_m = atom.y_m = atom.z_m = {0.0F};
    atom.mass_fraction = {1.0F};
    atom.element = {6};
    for (const Structure& s : {rod, atom}) {
        for (const RefineGoal goal : kGoals) {
            const RefineResult r =
                refine(map(), s, {kTruth.p_m + Vec3(2.0, 1.0, 0.0) * kA, kTruth.q}, settings(goal));
            EXPECT_TRUE(r.T_model_body.finite());
            EXPECT_GE(r.score, r.score_start);
        }
    }
}

TEST(Refine, invalid_input_is_refused) {
    EXPECT_THROW(refine(map(), scene().structure, {Vec3(NAN, 0, 0), Quat::Identity()}), StartupError);
    EXPECT_THROW(refine(map(), scene().structure, {Vec3::Zero(), Quat(0, 0, 0, 0)}), StartupError);
    RefineSettings s;
    s.goal = RefineGoal::correlation_mean;
    EXPECT_THROW(refine(map(), scene().structure, kTruth, s), StartupError);
    EXPECT_THROW(refine(map(), Structure{}, kTruth), StartupError);
}

}  // namespace
}  // namespace tact::scene_refine_test
