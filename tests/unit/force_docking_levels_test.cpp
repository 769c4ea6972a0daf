// Levels of the docking force: their agreement, their error and their cost.
#include <gtest/gtest.h>

#include <cmath>

#include "rt/force/docking/docking_model.hpp"
#include "rt/force/docking/start_pose.hpp"
#include "tests/unit/force_rod_scene.hpp"

namespace tact::force_docking_levels_test {
namespace {

using namespace rod;

TEST(DockingLevels, force_barely_depends_on_the_number_of_codebook_points) {
    const auto model = make_model();
    const Pose body = start_pose(model->home(), 6.0 * kA, 0.2, 5);
    const Vec3 all = model->evaluate(body, at(1.0F)).wrench_world.force_n;
    for (const float fidelity : {0.0F, 0.2F, 0.4F, 0.6F, 0.8F}) {
        const StepResult result = model->evaluate(body, at(fidelity));
        EXPECT_LT((result.wrench_world.force_n - all).norm(), 0.25 * all.norm()) << "at " << fidelity;
    }
}

TEST(DockingLevels, the_reported_error_holds_near_home) {
    const auto model = make_model();
    SeededRandom random(11);
    int above = 0;
    for (int i = 0; i < 200; ++i) {
        const Pose body =
            start_pose(model->home(), 15.0 * kA * random.uniform(), 0.5 * random.uniform(), random.next());
        const Vec3 all = model->evaluate(body, at(1.0F)).wrench_world.force_n;
        for (const float fidelity : {0.0F, 0.3F, 0.7F}) {
            const StepResult result = model->evaluate(body, at(fidelity));
            if ((result.wrench_world.force_n - all).norm() > result.load.error) ++above;
        }
    }
    EXPECT_LE(above, 30);  // 5 % of 600: an estimate over sampled poses, not a proof
    EXPECT_EQ(model->evaluate(model->home(), at(1.0F)).load.error, 0.0);
    EXPECT_GT(model->evaluate(model->home(), at(0.0F)).load.error, 0.0);
}

TEST(DockingLevels, the_audit_measures_the_error_against_all_atoms_and_the_bound_covers_it) {
    const auto model = make_model();
    const double n_per_gradient = scene().meta.energy_j_per_sigma / scene().meta.world_per_model;
    model->reset(tool_at(kGrip));
    for (int i = 0; i < 400; ++i) (void)model->step(tool_at(kGrip), at(0.3F));  // one pose, so one result
    const Pose held = model->bodies().T_model_body[0];
    const double off_n = (model->evaluate(held, at(0.3F)).wrench_world.force_n -
                          model->evaluate(held, at(1.0F)).wrench_world.force_n)
                             .norm();
    ASSERT_GT(model->audit().done(), 0U);
    EXPECT_NEAR(n_per_gradient * model->audit().off(), off_n, 1e-4);
    SeededRandom random(9);
    std::size_t done = model->audit().done();
    Pose hand = kGrip;
    for (int i = 0; i < 20000; ++i) {
        if (i % 40 == 0) hand.p_m = kGrip.p_m + random.within(0.03);
        const double error_n = model->step(tool_at(hand), at(0.3F)).load.error;
        if (model->audit().done() == done) continue;
        done = model->audit().done();
        const double bound_n = model->evaluate(held, at(0.3F)).load.error;
        EXPECT_LE(n_per_gradient * model->audit().off(), bound_n * (1.0 + 1e-6));
        EXPECT_LE(error_n, bound_n);  // the bound never decreases
    }
    EXPECT_GT(done, 100U);
}

TEST(DockingLevels, predicted_cost_grows_with_the_level) {
    const auto model = make_model();
    const auto predicted = [&](float level) {
        return model->evaluate(model->home(), at(level)).load.cost_predicted;
    };
    EXPECT_GT(predicted(1.0F).count(), 0);
    EXPECT_LT(predicted(0.0F), predicted(1.0F));
    EXPECT_EQ(model->items(0.0F), 25U);
    EXPECT_EQ(model->items(1.0F), 1000U);
    EXPECT_EQ(std::string(model->knob().path), "docking.force");
    EXPECT_EQ(model->items(model->knob().start),
              250U);  // the first level with 200 points or more, unblended
}

}  // namespace
}  // namespace tact::force_docking_levels_test
