// The fit beside the frame loop: the same metrics as a direct call, and no work without motion.
#include <gtest/gtest.h>

#include <thread>

#include "gui/docking/docking_content.hpp"
#include "gui/docking/fit_colours.hpp"
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

TEST(FitWorker, residues_come_in_a_second_outcome_and_are_those_of_each_body_with_all_others) {
    const auto c = content();
    FitWorker worker(c, Duration(0));
    std::vector<FitBody> bodies = at_home(*c);
    bodies.push_back(bodies[0]);
    bodies[1].id = 77;
    bodies[1].T_model_body.p_m.x() += 9e-10;
    worker.request(bodies, {}, true);
    FitOutcome outcome = next(worker, {});
    EXPECT_TRUE(outcome.good);
    while (!outcome.residues_current) outcome = next(worker, outcome);
    ASSERT_EQ(outcome.residues.size(), 2U);
    const Structure& s = docking_of(*c).bodies[0];
    for (std::size_t i = 0; i < 2; ++i) {
        const PlacedStructure placed[] = {{&s, bodies[i].T_model_body}, {&s, bodies[1 - i].T_model_body}};
        const std::vector<ResidueFit> direct = residue_fit(
            c->grid, placed, {.resolution_m = 12e-10, .contour = 0.5, .background = 0.0, .sigma = 1.0}, 9);
        ASSERT_EQ(outcome.residues[i].size(), direct.size());
        ASSERT_FALSE(direct.empty());
        for (std::size_t r = 0; r < direct.size(); ++r) {
            EXPECT_EQ(outcome.residues[i][r].residue, direct[r].residue);
            EXPECT_EQ(outcome.residues[i][r].correlation, direct[r].correlation);
        }
    }
    bodies[0].T_model_body.p_m.y() += 5e-10;
    worker.request(bodies, {}, true);
    FitOutcome later = next(worker, outcome);
    EXPECT_EQ(later.residues.size(), 2U) << "those of the old places stay until there are new ones";
    while (!later.residues_current || later.residues[0][0].correlation == outcome.residues[0][0].correlation)
        later = next(worker, later);
}

TEST(FitColours, go_from_red_to_blue_and_are_grey_where_nothing_is_known) {
    EXPECT_EQ(fit_colour({}), kUnknownFit);
    EXPECT_EQ(fit_colour(-1.0), fit_colour(kPoorFit));
    EXPECT_EQ(fit_colour(kGoodFit), fit_colour(1.1));
    EXPECT_GT(fit_colour(kPoorFit)[0], fit_colour(kPoorFit)[2] + 100);
    EXPECT_GT(fit_colour(kGoodFit)[2], fit_colour(kGoodFit)[0] + 100);
    const std::vector<ResidueFit> residues{{0, 5, 1, 2, 0.0, 1.0}, {0, 6, 3, 9, 0.0, std::nullopt}};
    const std::vector<Rgb8> colours = fit_colours(5, residues);  // fewer atoms than the residues claim
    ASSERT_EQ(colours.size(), 5U);
    EXPECT_EQ(colours[0], kUnknownFit);
    EXPECT_EQ(colours[1], fit_colour(1.0));
    EXPECT_EQ(colours[2], fit_colour(1.0));
    EXPECT_EQ(colours[4], kUnknownFit);
}

}  // namespace
}  // namespace tact::gui_fit_test
