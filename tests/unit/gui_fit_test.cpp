// The fit beside the frame loop: the same metrics as a direct call, and no work without motion.
#include <gtest/gtest.h>

#include <thread>

#include "gui/docking/docking_content.hpp"
#include "gui/docking/fit_worker.hpp"
#include "tests/unit/gui_fake.hpp"

namespace tact::gui_fit_test {
namespace {

FitOutcome next(FitWorker& worker, FitOutcome outcome) {
    for (int i = 0; i < 30'000 && !worker.take(outcome); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return outcome;
}

std::shared_ptr<SceneContent> content() {
    auto c = std::make_shared<SceneContent>();
    auto docking = std::make_unique<DockingContent>();
    docking->bodies.push_back(fake::helix(18));
    docking->codebooks.emplace_back();
    c->grid = fake::density_of(docking->bodies[0], 24, 40.0 / 23.0, 3.0);
    c->meta.contour = 0.5;
    c->meta.resolution_m = 12e-10;
    c->meta.map_sigma = 1.0;
    c->system = std::move(docking);
    return c;
}

std::vector<FitBody> at_home(const SceneContent& c) { return {{1, 0, docking_of(c).bodies[0].home()}}; }

TEST(FitWorker, gives_the_metrics_of_the_newest_pose) {
    const auto c = content();
    FitWorker worker(c, Duration(0));
    const std::vector<FitBody> home = at_home(*c);
    worker.request(home);
    const FitOutcome first = next(worker, {});
    ASSERT_TRUE(first.good) << first.error;
    const PlacedStructure placed[] = {{&docking_of(*c).bodies[0], home[0].T_model_body}};
    const FitMetrics direct = fit_metrics(
        c->grid, placed, {.resolution_m = 12e-10, .contour = 0.5, .background = 0.0, .sigma = 1.0});
    EXPECT_DOUBLE_EQ(first.all.cc_zero, direct.cc_zero);
    EXPECT_DOUBLE_EQ(first.all.cc_mean, direct.cc_mean);
    EXPECT_FALSE(first.resolution_assumed);

    std::vector<FitBody> away = home;
    away[0].T_model_body.p_m.x() += 8e-10;
    worker.request(away);
    const FitOutcome moved_away = next(worker, first);
    ASSERT_TRUE(moved_away.good);
    EXPECT_EQ(moved_away.number, first.number + 1);
    EXPECT_LT(moved_away.all.cc_mean, first.all.cc_mean);
}

TEST(FitWorker, counts_as_inside_what_is_above_the_contour_that_is_shown) {
    const auto c = content();
    FitWorker worker(c, Duration(0));
    const std::vector<FitBody> home = at_home(*c);
    worker.request(home);
    const FitOutcome baked = next(worker, {});
    EXPECT_EQ(baked.contour, 0.5);
    double highest = 0.0;
    for (const float v : c->grid.values) highest = std::max(highest, static_cast<double>(v));
    worker.request(home, 0.9 * highest);  // only the contour has changed
    const FitOutcome moved_up = next(worker, baked);
    EXPECT_EQ(moved_up.contour, 0.9 * highest);
    EXPECT_LT(moved_up.all.fraction_inside, 0.5 * baked.all.fraction_inside);
    EXPECT_EQ(moved_up.all.cc_mean, baked.all.cc_mean);
}

TEST(FitWorker, measures_each_body_and_ignores_unknown_structures) {
    const auto c = content();
    FitWorker worker(c, Duration(0));
    std::vector<FitBody> three = at_home(*c);
    three.push_back({7, 0, {three[0].T_model_body.p_m + Vec3(6e-10, 0.0, 0.0), Quat::Identity()}});
    three.push_back({8, 1, three[0].T_model_body});  // structure 1 does not exist
    worker.request(three);
    const FitOutcome outcome = next(worker, {});
    ASSERT_TRUE(outcome.good) << outcome.error;
    ASSERT_EQ(outcome.body.size(), 2U);
    ASSERT_EQ(outcome.of.size(), 2U);
    EXPECT_EQ(outcome.body[1].id, 7U);
    EXPECT_GT(outcome.of[0].cc_mean, outcome.of[1].cc_mean);
}

TEST(FitWorker, does_no_work_without_motion) {
    const auto c = content();
    FitWorker worker(c, Duration(0));
    const std::vector<FitBody> home = at_home(*c);
    worker.request(home);
    FitOutcome outcome = next(worker, {});
    for (int i = 0; i < 50; ++i) {
        worker.request(home);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_FALSE(worker.take(outcome));
}

TEST(FitWorker, reports_an_assumed_resolution) {
    const auto c = content();
    c->meta.resolution_m = 0.0;
    FitWorker worker(c, Duration(0));
    worker.request(at_home(*c));
    const FitOutcome outcome = next(worker, {});
    EXPECT_TRUE(outcome.resolution_assumed);
    EXPECT_NEAR(outcome.resolution_m, 4.0 * 40.0 / 23.0 * 1e-10, 1e-15);
}

TEST(FitWorker, reports_a_resolution_that_the_bake_estimated) {
    const auto c = content();
    c->note = "map: x\nresolution: 12 Å, " + std::string(kResolutionEstimated) + "; --resolution-a sets it\n";
    FitWorker worker(c, Duration(0));
    worker.request(at_home(*c));
    const FitOutcome outcome = next(worker, {});
    EXPECT_TRUE(outcome.resolution_assumed);
    EXPECT_EQ(outcome.resolution_m, 12e-10);
}

TEST(FitWorker, ends_at_once_without_a_request) { const FitWorker worker(content()); }

TEST(Moved, ignores_motion_below_the_displayed_precision) {
    const std::vector<FitBody> a(1), none;
    std::vector<FitBody> b(1);
    EXPECT_FALSE(moved(a, b));
    b[0].T_model_body.p_m.x() = 0.005e-10;
    EXPECT_FALSE(moved(a, b));
    b[0].T_model_body.p_m.x() = 0.05e-10;
    EXPECT_TRUE(moved(a, b));
    b = a;
    b[0].T_model_body.q = Quat(Eigen::AngleAxisd(0.1 * kDegreeRad, Vec3::UnitX()));
    EXPECT_TRUE(moved(a, b));
    EXPECT_TRUE(moved(a, none));
    b = a;
    b[0].structure = 1;
    EXPECT_TRUE(moved(a, b));
}

}  // namespace
}  // namespace tact::gui_fit_test
