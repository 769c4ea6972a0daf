// The record of queries against a list of all steps, and what it predicts for a level of the 6-DoF tool.
#include "rt/force/surface/query_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/force_tool_fixture.hpp"

namespace tact::force_query_record_test {
namespace {

using namespace tool_test;

constexpr std::uint32_t kMost = ToolContact::kQueriesMost;

ToolTouch step_of(std::uint32_t looked, std::uint32_t asked, ContactState state = ContactState::settled) {
    ToolTouch touch;
    touch.looked = looked;
    touch.asked = asked;
    touch.state = state;
    return touch;
}

// Adds as many equal steps as make the prior fade to nothing.
void fade_prior(QueryRecord& record) {
    for (int i = 0; i < 200000; ++i) record.add(step_of(1, 0), kMost, 1.0);
}

TEST(QueryRecord, the_share_of_steps_beyond_each_limit_is_counted) {
    QueryRecord record;
    fade_prior(record);
    EXPECT_NEAR(record.lagged(8), 0.0, 1e-6);
    std::mt19937 random(5);
    std::exponential_distribution<double> many(1.0 / 90.0);
    std::vector<std::uint32_t> needed;
    for (int i = 0; i < 400000; ++i) {
        const auto n = std::min(static_cast<std::uint32_t>(many(random)), kMost), other = n / 2;
        record.add(i % 2 == 0 ? step_of(n, other) : step_of(other, n), kMost, 1.0);
        needed.push_back(n);
    }
    for (const std::uint32_t limit : {32U, 64U, 128U, 256U}) {
        double more = 0.0;
        for (const std::uint32_t n : needed) more += n > limit ? 1.0 : 0.0;
        EXPECT_NEAR(record.lagged(limit), more / static_cast<double>(needed.size()), 0.015) << limit;
    }
}

TEST(QueryRecord, a_step_that_ran_out_would_have_needed_the_most_and_one_at_the_most_more_than_that) {
    QueryRecord record;
    fade_prior(record);
    for (int i = 0; i < 200000; ++i) record.add(step_of(32, 10, ContactState::lagging), 32, 1.0);
    EXPECT_NEAR(record.lagged(32), 1.0, 1e-3);
    EXPECT_NEAR(record.lagged(kMost - 8), 1.0, 1e-3);
    EXPECT_NEAR(record.lagged(kMost), 0.0, 1e-3);
    for (int i = 0; i < 200000; ++i) record.add(step_of(10, kMost + 1, ContactState::lagging), kMost, 1.0);
    EXPECT_NEAR(record.lagged(kMost), 1.0, 1e-3);
}

TEST(QueryRecord, before_the_first_contact_fewer_queries_lag_more_often) {
    const QueryRecord record;
    double before = 1.0;
    for (std::uint32_t limit = 32; limit <= kMost; limit += 32) {
        const double share = record.lagged(limit);
        EXPECT_NEAR(share, 0.07 * std::exp(-static_cast<double>(limit) / 75.0), 2e-3) << limit;
        EXPECT_LT(share, before);
        before = share;
    }
}

// Where steps lag at a level, the level's predicted error rises by twice the force of those steps, and a level with
// enough queries keeps its own.
TEST(QueryRecord, lags_raise_the_predicted_error_of_the_levels_that_have_them) {
    const auto model = box_on_rough().model({});
    const auto at = [](const Vec3& p_m) {
        ToolState tool;
        tool.T_world_tool = {p_m, Quat::Identity()};
        return tool;
    };
    model->reset(at({0.004, 0.075, 0.003}));
    Budget low, high;
    low.fidelity = ToolModel::kAllPointsAt;
    high.fidelity = 1.0F;
    for (int i = 0; i < 4000; ++i)
        (void)model->step(at({0.004, std::max(0.075 - 1e-4 * i, 0.053), 0.003}), high);
    const double before_n = model->predict(low.fidelity).error - model->predict(high.fidelity).error;
    std::uint64_t lags = model->lagging_steps();
    int in_contact = 0;
    double pulled_n = 0.0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 p_m = Eigen::AngleAxisd(4e-3 * i, Vec3::UnitZ()) * Vec3(0.004, 0.053, 0.003);
        (void)model->step(at(p_m), low);
        if (model->tool_touch().looked == 0) continue;
        ++in_contact;
        const ToolContact& c = model->contact();
        pulled_n += kStiffness * kWorldPerModel * c.way_m(c.goal(), c.proxy()).norm();
    }
    lags = model->lagging_steps() - lags;
    ASSERT_GT(lags, 400U);
    const double share = static_cast<double>(lags) / in_contact,
                 mean_n = std::min(pulled_n / in_contact, SurfaceSettings{}.force_n_max);
    const double after_n = model->predict(low.fidelity).error - model->predict(high.fidelity).error;
    EXPECT_GT(after_n, before_n);
    EXPECT_GT(after_n, 0.3 * 2.0 * share * mean_n);
    EXPECT_LT(after_n, 1.5 * 2.0 * share * mean_n);
}

}  // namespace
}  // namespace tact::force_query_record_test
