// What a drill predicts: the work of a step, of another level, of a contact that may come.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "rt/force/drilling/drill_model.hpp"
#include "tests/unit/force_drilled.hpp"

namespace tact::force_drill_predict_test {
namespace {

using test::Drilled;
using test::kDrilledRadS;
using test::kDrilledVoxelM;
using test::stroke_m;

TEST(DrillPrediction, predicted_work_is_that_of_the_step) {
    for (const double radius_m : {2e-3, 3e-3, 8e-3}) {
        for (const float level : {0.0F, 0.3F, 0.6F, 1.0F}) {
            Drilled d(radius_m);
            d.begin(stroke_m(radius_m, 0.0));
            double expected = 0.0, found = 0.0;
            for (int i = 0; i < 700; ++i) {
                if (i > 300) expected += d.model->predict(level).items;
                const StepResult r = d.step(stroke_m(radius_m, 1e-3 * i), level);
                if (i > 300) found += r.load.items;
            }
            EXPECT_NEAR(expected, found, 0.1 * found) << radius_m << " m at " << level;
        }
    }
}

// The stiffness is measured in one direction a step, a ball pressed deeper meets more bone, and blocks halve: a step that is compared
// with the one before would look like an interrupted one.
TEST(DrillPrediction, a_whole_step_is_compared_with_the_work_that_it_did) {
    constexpr double kRadiusM = 20e-3;
    Drilled d(kRadiusM, 160);
    const Vec3 pressed_m = stroke_m(kRadiusM, 0.3);
    d.begin(pressed_m);
    d.model->turn_burr({0.0, 1e-3});
    for (int i = 0; i < 80; ++i) (void)d.step(pressed_m, 0.5F);
    std::vector<double> predicted, items;
    for (int i = 0; i < 16; ++i) {
        const StepResult r = d.step(pressed_m, 0.5F);
        predicted.push_back(to_us(r.load.cost_predicted));
        items.push_back(r.load.items);
    }
    const auto [least, most] = std::minmax_element(items.begin(), items.end());
    ASSERT_GT(*most, 1.1 * *least);
    const auto about_mean = [](std::vector<double> v) {
        const double mean = std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
        for (double& x : v) x -= mean;
        return v;
    };
    const std::vector<double> a = about_mean(predicted), b = about_mean(items);
    const auto dot = [](const std::vector<double>& x, const std::vector<double>& y) {
        return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
    };
    EXPECT_GT(dot(a, b), 0.9 * std::sqrt(dot(a, a) * dot(b, b)));
}

// What another level would do, told from this one.
TEST(DrillPrediction, work_predicted_from_another_level_is_right_within_a_factor_of_two) {
    for (const double radius_m : {2e-3, 3e-3, 8e-3}) {
        for (const float level : {0.0F, 0.3F, 0.6F, 1.0F}) {
            Drilled at_half(radius_m), d(radius_m);
            at_half.begin(stroke_m(radius_m, 0.0));
            d.begin(stroke_m(radius_m, 0.0));
            double expected = 0.0, found = 0.0;
            for (int i = 0; i < 700; ++i) {
                const Vec3 p_m = stroke_m(radius_m, 1e-3 * i);
                if (i > 300) expected += to_us(at_half.model->predict(level).cost_predicted);
                if (i > 300) found += to_us(d.model->predict(level).cost_predicted);
                (void)at_half.step(p_m, 0.5F);
                (void)d.step(p_m, level);
            }
            EXPECT_LT(expected, 2.0 * found) << radius_m << " m at " << level;
            EXPECT_GT(expected, 0.5 * found) << radius_m << " m at " << level;
        }
    }
}

// Which blocks are looked at in halves is no smooth function of the level: the bone in the burr's surface decides.
TEST(DrillPrediction, work_in_a_pocket_is_expected_from_another_level_within_a_third) {
    constexpr double kRadiusM = 20e-3;
    const std::vector<float> levels{0.15F, 0.3F, 0.5F, 0.7F};
    std::vector<std::unique_ptr<Drilled>> at;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        at.push_back(std::make_unique<Drilled>(kRadiusM, 160));
        at.back()->begin(stroke_m(kRadiusM, 0.0));
    }
    std::vector<std::vector<double>> us(levels.size(), std::vector<double>(levels.size(), 0.0));
    for (int i = 0; i < 900; ++i) {
        const Vec3 p_m = stroke_m(kRadiusM, 0.5e-3 * i);
        for (std::size_t from = 0; from < levels.size(); ++from) {
            for (std::size_t to = 0; to < levels.size() && i > 500; ++to)
                us[from][to] += to_us(at[from]->model->predict(levels[to]).cost_predicted);
            (void)at[from]->step(p_m, levels[from]);
        }
    }
    for (std::size_t from = 0; from < levels.size(); ++from) {
        for (std::size_t to = 0; to < levels.size(); ++to) {
            EXPECT_LT(us[from][to], 1.33 * us[to][to]) << levels[from] << " to " << levels[to];
            EXPECT_GT(us[from][to], us[to][to] / 1.33) << levels[from] << " to " << levels[to];
        }
    }
}

// The level of a hand in free space must fit when it touches, and later in the pocket that it cuts: it may not be chosen by
// the cost of free space.
TEST(DrillPrediction, in_free_space_a_level_is_predicted_to_cost_what_a_pocket_costs) {
    constexpr int kSteps = 4000, kGrown = 2000;
    for (const double radius_m : {8e-3, 20e-3}) {
        Drilled d(radius_m, radius_m > 0.01 ? 160 : 72);
        DrillRehearsal rehearsal = rehearse_drill(d.model->settings(), kDrilledVoxelM, 1e-3);
        rehearsal.set_speed({});  // work, not the time of this machine
        d.model->foresee(rehearsal);
        double z_m = radius_m + 1e-3;
        d.begin({0.0, 0.0, z_m});
        const double free_us = to_us(d.model->predict(0.25F).cost_foreseen);
        double pocket_us = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double t_s = 1e-3 * i;
            const StepResult r = d.step({6e-3 * std::sin(8.0 * t_s), 2e-3 * std::sin(3.0 * t_s), z_m}, 0.25F);
            z_m -= std::clamp((3.0 - d.model->elastic_n()) * 2e-5, -2e-5, 1e-5);  // pressed with 3 N
            if (i > kGrown) pocket_us = std::max(pocket_us, to_us(r.load.cost_predicted));
        }
        EXPECT_GT(free_us, 0.6 * pocket_us) << radius_m;
        EXPECT_LT(free_us, 1.7 * pocket_us) << radius_m;
        // The contact has shown what it costs; after a while in free space that is forgotten.
        EXPECT_EQ(d.model->predict(0.25F).cost_foreseen.count(), 0);
        for (int i = 0; i < 9000; ++i) (void)d.step({0.0, 0.0, 3.0 * radius_m}, 0.0F);
        EXPECT_EQ(d.model->predict(0.25F).cost_foreseen.count(), 0);
        for (int i = 0; i < 1500; ++i) (void)d.step({0.0, 0.0, 3.0 * radius_m}, 0.0F);
        EXPECT_EQ(to_us(d.model->predict(0.25F).cost_foreseen), free_us);
    }
}

// Only a step that another program held cuts more groups: the next ones do not.
TEST(DrillPrediction, a_held_step_raises_no_prediction_of_cost_or_error) {
    constexpr double kRadiusM = 20e-3;
    Drilled d(kRadiusM, 160);
    d.begin(stroke_m(kRadiusM, 0.0));
    for (int i = 0; i < 500; ++i) (void)d.step(stroke_m(kRadiusM, 1e-3 * i), 0.0F);
    const PathLoad before = d.model->predict(0.0F);
    d.model->turn_burr({kDrilledRadS, 45e-3});
    (void)d.step(stroke_m(kRadiusM, 0.5), 0.0F);
    const PathLoad after = d.model->predict(0.0F);
    EXPECT_LT(to_us(after.cost_predicted), 1.3 * to_us(before.cost_predicted));
    EXPECT_LT(after.error, 1.3F * before.error);
    // A rate that stays lower is followed.
    for (int i = 0; i < 300; ++i) {
        d.model->turn_burr({kDrilledRadS, 45e-3});
        (void)d.step(stroke_m(kRadiusM, 0.5), 0.0F);
    }
    EXPECT_GT(to_us(d.model->predict(0.0F).cost_predicted), 1.3 * to_us(before.cost_predicted));
}

// A burr that starts cuts one group a step: what the others will cost is expected from the first.
TEST(DrillPrediction, the_first_group_tells_what_all_will_cost) {
    Drilled d(8e-3);
    Vec3 place = stroke_m(8e-3, 0.3);
    ToolState tool;
    tool.T_world_tool.p_m = place;
    d.model->reset(tool);
    double first = 0.0, all = 0.0;
    for (int i = 0; i < 20; ++i) {
        (void)d.step(place, 1.0F);
        if (i == 1) first = d.model->predict(1.0F).items;
        all = d.model->predict(1.0F).items;
    }
    EXPECT_NEAR(first, all, 0.3 * all);
}

}  // namespace
}  // namespace tact::force_drill_predict_test
