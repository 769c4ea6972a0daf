// Training tasks: what the file may say, points by hand, what is written.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "ipc/base/error.hpp"
#include "tests/unit/training_ear.hpp"

namespace tact::training_test {
namespace {

std::string why(const std::string& text) {
    try {
        static_cast<void>(plan_of(text));
    } catch (const StartupError& e) {
        return e.what();
    }
    return "nothing was wrong";
}

TEST(TrainingPlan, holds_what_the_file_says) {
    const TrainingPlan p =
        plan_of(std::string("time_s = 90\ntask = 'x'\n") + kTask + "[points]\nsight = 0\ngoal = 70\n");
    EXPECT_EQ(p.title, "T");
    EXPECT_EQ(p.time_s, 90.0);
    ASSERT_EQ(p.goal.size(), 2U);
    EXPECT_EQ(p.goal[0].share, 0.5);
    EXPECT_EQ(p.goal[1].region.kind, TrainingRegion::Kind::box);
    EXPECT_EQ(p.goal[1].region.a_mm, Vec3(6, 3, 8));
    EXPECT_EQ(p.forbidden[0].name, "facial <nerve>");
    EXPECT_EQ(p.forbidden[0].region.margin_mm, 0.7);
    EXPECT_EQ(p.points[0], 70.0);
    EXPECT_EQ(p.points[static_cast<std::size_t>(TrainingPart::sight)], 0.0);
    EXPECT_EQ(p.points[static_cast<std::size_t>(TrainingPart::structures)], 20.0);
}

TEST(TrainingPlan, a_wrong_file_is_refused_with_its_line_and_reason) {
    const std::string goal = "[[goal]]\nname = 'g'\nsphere = { centre_mm = [0,0,0], radius_mm = 1 }\n";
    const struct {
        std::string text, says;
    } rows[] = {
        {goal, "'title' is missing"},
        {"title = 'T'\n", "neither a goal"},
        {"title = 'T'\ntitel = 'T'\n" + goal, "line 2"},
        {"title = 'T'\ntitel = 'T'\n" + goal, "unknown key 'titel'"},
        {"title = 'T\n", "line 1"},
        {"title = ''\n" + goal, "1 to 2000 characters"},
        {"title = 'T'\nframe = 'room'\n" + goal, "\"patient\""},
        {"title = 'T'\ntime_s = -1\n" + goal, "from 1 to 100000"},
        {"title = 'T'\ntime_s = nan\n" + goal, "from 1 to 100000"},
        {"title = 'T'\ngoal = 3\n", "[[goal]]"},
        {"title = 'T'\n[[goal]]\nname = 'g'\n", "a sphere, a box or an expert's file"},
        {"title = 'T'\n[[goal]]\nname = 'g'\nsphere = { centre_mm = [0,0], radius_mm = 1 }\n",
         "three numbers"},
        {"title = 'T'\n[[goal]]\nname = 'g'\nsphere = { centre_mm = [0,0,inf], radius_mm = 1 }\n",
         "three numbers"},
        {"title = 'T'\n[[goal]]\nname = 'g'\nsphere = { centre_mm = [0,0,0] }\n", "'radius_mm' is missing"},
        {"title = 'T'\n[[goal]]\nname = 'g'\nbox = { from_mm = [0,0,0], to_mm = [1,0,1] }\n", "no volume"},
        {"title = 'T'\n[[goal]]\nname = 'g'\nexpert = 'a.bone'\nbox = { from_mm = [0,0,0], to_mm = [1,1,1] "
         "}\n",
         "one of"},
        {"title = 'T'\n[[forbidden]]\nname = 'f'\nmargin_mm = 1\n" + goal, "belongs to a structure"},
        {"title = 'T'\n[[thin]]\nleave_mm = 1\n", "'structure' is missing"},
        {"title = 'T'\n" + goal + "share = 1.5\n", "from 0.01 to 1"},
        {"title = 'T'\n" + goal + "[points]\nstyle = 5\n", "unknown key 'style'"},
    };
    for (const auto& row : rows)
        EXPECT_NE(why(row.text).find(row.says), std::string::npos) << row.text << why(row.text);
    std::string many = "title = 'T'\n";
    for (int i = 0; i < 17; ++i) many += goal;
    EXPECT_NE(why(many).find("more than 16"), std::string::npos);
}

// A task with a goal of 1000 levels, a structure to thin and a forbidden zone; numbers by hand.
struct Scored {
    TrainingPlan plan = plan_of(R"(
title = "T"
time_s = 100
[[goal]]
name = "g"
sphere = { centre_mm = [0,0,0], radius_mm = 1 }
share = 0.8
[[thin]]
structure = "nerve"
share = 0.5
[[forbidden]]
structure = "nerve"
most_mm3 = 1
)");
    TrainingSums sums;
    DrillMetricsRow metrics;
    BoneLabelsView labels;
    std::optional<BurrVisibility> seen = BurrVisibility{10.0, 8.0};
    double time_s = 50.0;

    Scored() {
        sums.goal = {{1000, 800}};
        sums.thin = {{100, 50}};
        sums.forbidden = {{100, 0}};
        sums.any_goal = {1000, 800};
        metrics.level_m3 = 1e-9;
        metrics.drilling_s = 40.0;
        metrics.structure.resize(2);
        labels.structure = {{"nerve", {}, true}};
    }
    [[nodiscard]] TrainingScore score() const {
        return training_score(plan, sums, metrics, labels, seen, time_s);
    }
    [[nodiscard]] double share(TrainingPart part) const {
        for (const TrainingPoints& p : score().part)
            if (p.part == part) return p.points / p.of;
        return -1.0;
    }
    [[nodiscard]] TrainingItem::State state(const std::string& name) const {
        for (const TrainingItem& i : score().item)
            if (i.name == name) return i.state;
        ADD_FAILURE() << name;
        return {};
    }
};

TEST(TrainingScore, all_that_is_asked_is_a_hundred_points) {
    const Scored s;
    EXPECT_NEAR(s.score().total, 100.0, 1e-9);
    EXPECT_EQ(s.score().part.size(), 7U);
    for (const TrainingItem& i : s.score().item) EXPECT_EQ(i.state, TrainingItem::State::done) << i.name;
}

TEST(TrainingScore, each_part_falls_by_its_rule) {
    Scored s;
    s.sums.goal[0].taken = 400;
    EXPECT_NEAR(s.share(TrainingPart::goal), 0.5, 1e-12);
    EXPECT_NEAR(s.share(TrainingPart::force), 0.75, 1e-12);  // three quarters of the work
    EXPECT_EQ(s.state("g"), TrainingItem::State::open);
    s = {};
    s.sums.thin[0].taken = 10;
    EXPECT_NEAR(s.share(TrainingPart::thin), 0.2, 1e-12);
    s = {};
    s.metrics.injuries = s.metrics.structure[1].injuries = 1;
    EXPECT_EQ(s.share(TrainingPart::thin), 0.0);
    EXPECT_NEAR(s.share(TrainingPart::structures), 0.5 * 0.5, 1e-12);
    EXPECT_EQ(s.state("nerve thinned"), TrainingItem::State::failed);
    EXPECT_EQ(s.state("no structure injured"), TrainingItem::State::failed);
    s = {};
    s.sums.forbidden[0].taken = 1;  // mm3, as much as is allowed
    EXPECT_NEAR(s.share(TrainingPart::structures), 1.0, 1e-12);
    s.sums.forbidden[0].taken = 2;
    EXPECT_NEAR(s.share(TrainingPart::structures), 0.5, 1e-12);
    EXPECT_EQ(s.state("nerve left"), TrainingItem::State::failed);
    s = {};
    s.sums.outside_taken = 50;
    EXPECT_NEAR(s.share(TrainingPart::outside), 1.0, 1e-12);
    s.sums.outside_taken = 275;
    EXPECT_NEAR(s.share(TrainingPart::outside), 0.5, 1e-12);
    s.sums.outside_taken = 5000;
    EXPECT_EQ(s.share(TrainingPart::outside), 0.0);
    s = {};
    s.metrics.excess_s = 4.0;
    EXPECT_NEAR(s.share(TrainingPart::force), 0.5, 1e-12);
    s = {};
    s.seen = BurrVisibility{10.0, 4.0};
    EXPECT_NEAR(s.share(TrainingPart::sight), 0.5, 1e-12);
    s = {};
    s.time_s = 150.0;
    EXPECT_NEAR(s.share(TrainingPart::time), 0.5, 1e-12);
    EXPECT_EQ(s.state("time"), TrainingItem::State::failed);
    s.time_s = 1e9;
    EXPECT_EQ(s.share(TrainingPart::time), 0.0);
}

TEST(TrainingScore, who_does_nothing_gets_nothing) {
    Scored s;
    s.sums.goal[0].taken = s.sums.thin[0].taken = s.sums.any_goal.taken = 0;
    s.metrics.drilling_s = 0.0;
    EXPECT_EQ(s.score().total, 0.0);
    EXPECT_EQ(s.state("time"), TrainingItem::State::open);
}

TEST(TrainingScore, what_cannot_be_measured_is_left_out) {
    Scored s;
    s.seen = std::nullopt;
    s.plan.time_s = 0.0;
    EXPECT_EQ(s.share(TrainingPart::sight), -1.0);
    EXPECT_EQ(s.share(TrainingPart::time), -1.0);
    EXPECT_NEAR(s.score().total, 100.0, 1e-9);
    s.labels.structure.clear();
    s.plan.forbidden.clear();
    s.plan.thin.clear();
    EXPECT_EQ(s.share(TrainingPart::structures), -1.0);
    EXPECT_EQ(s.share(TrainingPart::thin), -1.0);
    EXPECT_NEAR(s.score().total, 100.0, 1e-9);
}

TrainingSession session(const Scored& s) {
    return {.trainee = "=SUM(A1) \"A, <b>\n",
            .scene = "ear & nose",
            .date = "2026-11-27 23:05",
            .plan = &s.plan,
            .score = s.score(),
            .performance = drill_report(s.metrics, s.labels, s.seen),
            .before = {{"overview", {1, 2, 3, 4}}},
            .after = {{"overview", {250, 251, 252, 253, 254}}}};
}

TEST(TrainingReport, is_written_and_no_name_breaks_page_or_table) {
    const Folder folder;
    Scored s;
    const fs::path first = write_training(folder.path, session(s)),
                   second = write_training(folder.path, session(s));
    EXPECT_NE(first, second);
    std::ifstream in(second);
    const std::string page((std::istreambuf_iterator<char>(in)), {});
    EXPECT_NE(page.find("ear &amp; nose"), std::string::npos);
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    EXPECT_NE(page.find("&lt;b&gt;"), std::string::npos);
    EXPECT_NE(page.find("base64,AQIDBA==\""), std::string::npos);  // by hand
    EXPECT_NE(page.find("base64,+vv8/f4=\""), std::string::npos);
    EXPECT_NE(page.find("100 <small>of 100 points"), std::string::npos);
    EXPECT_NE(page.find("Earlier sessions"), std::string::npos);
    std::ifstream first_in(first);
    const std::string first_page((std::istreambuf_iterator<char>(first_in)), {});
    EXPECT_EQ(first_page.find("Earlier sessions"), std::string::npos);
    std::ifstream json_in(second.parent_path() / "report.json");
    const auto json = nlohmann::json::parse(json_in);
    EXPECT_EQ(json["trainee"], "=SUM(A1) \"A, <b>\n");
    EXPECT_NEAR(json["points"].get<double>(), 100.0, 1e-9);
    EXPECT_EQ(json["parts"]["goal"]["of"], 40.0);
    EXPECT_EQ(json["checklist"].size(), s.score().item.size());
    // Rows of the same columns; no cell is a formula.
    const auto rows = read_training_table(folder.path / "training.csv", session(s).trainee, "T");
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[1][1], "'=SUM(A1) \"A, <b>\n");
    EXPECT_EQ(rows[1][4], "100.0");
    EXPECT_EQ(rows[0].size(), rows[1].size());
    EXPECT_TRUE(read_training_table(folder.path / "training.csv", "somebody else", "T").empty());
    EXPECT_TRUE(read_training_table(folder.path / "none.csv", "", "T").empty());
    // A table with damaged rows is read as far as it goes.
    std::ofstream(folder.path / "training.csv", std::ios::app) << "\"open,,,\n1,2,3\n\x00\xff";
    EXPECT_EQ(read_training_table(folder.path / "training.csv", session(s).trainee, "T").size(), 2U);
}

TEST(TrainingReport, a_folder_that_cannot_be_written_is_said) {
    const Scored s;
    EXPECT_THROW(write_training("/proc/no/such", session(s)), StartupError);
}

TEST(Training, the_time_begins_when_the_burr_first_turns_and_without_that_there_is_no_report) {
    const Ear ear;
    const Folder folder;
    Training t(plan_of(kTask), {.plan = {}, .folder = folder.path, .trainee = "A"}, ear.bone());
    DrillMetricsRow m;
    m.structure.resize(3);
    m.level_m3 = 1e-12;
    t.follow(5'000'000'000, m, {});
    EXPECT_FALSE(t.begun());
    EXPECT_TRUE(t.finish("ear", drill_report(m, ear.labels, {}), {}, {}).empty());
    EXPECT_TRUE(fs::is_empty(folder.path));
    m.drilling_s = 0.1;
    t.follow(8'000'000'000, m, {});
    EXPECT_TRUE(t.begun());
    EXPECT_EQ(t.score().time_s, 0.0);
    t.follow(20'000'000'000, m, {});
    EXPECT_NEAR(t.score().time_s, 12.0, 1e-9);
    EXPECT_TRUE(fs::exists(t.finish("ear", drill_report(m, ear.labels, {}), {}, {})));
}

}  // namespace
}  // namespace tact::training_test
