// Training tasks: what the file may say, sums against plain loops over all voxels, points by hand, what is written.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

#include "gui/drilling/training/training.hpp"
#include "ipc/base/error.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"

namespace tact::gui_training_test {
namespace {

namespace fs = std::filesystem;
constexpr double kVoxelM = 4e-4;
constexpr std::uint32_t kX = 45, kY = 38, kZ = 29;  // no multiples of a brick

struct Folder {
    fs::path path = fs::temp_directory_path() / ("tact-training-" + std::to_string(::getpid()));
    Folder() {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

// Porous bone with a nerve, a plane at x = 12 mm of the scan, in a patient who lies oblique.
struct Ear {
    BoneBricks bricks;
    std::vector<std::uint8_t> density;
    BoneVolumeView volume;
    BoneLabelsView labels;
    std::vector<std::uint8_t> label;
    std::vector<std::int16_t> quanta;
    std::vector<DistanceField> fields;
    PatientFrame patient;

    Ear() {
        bricks.size = {kX, kY, kZ};
        bricks.voxel_m = kVoxelM;
        bricks.origin_m = Vec3(1e-3, -2e-3, 5e-3);
        density.assign(bricks.bytes(), 0);
        std::mt19937 random(3);
        each([&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            density[bricks.voxel(x, y, z)] =
                random() % 5 == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(random() % 256);
        });
        volume.bricks = bricks;
        volume.density = density;
        label.assign(bricks.bytes(), 0);
        labels.structure = {{"facial <nerve>", {255, 221, 64, 255}, true},
                            {"malleus", {1, 2, 3, 255}, false}};
        labels.label = label;
        DistanceField f;
        f.label = 1;
        f.size = {12, 12, 12};
        f.spacing_m = 2e-3;
        f.origin_m = bricks.origin_m - Vec3::Constant(1e-3);
        f.quantum_m = 1e-6;
        f.error_m = 1e-6;
        for (std::uint32_t i = 0; i < 12 * 12 * 12; ++i)
            quanta.push_back(static_cast<std::int16_t>(
                std::lround((12e-3 - (f.origin_m.x() + f.spacing_m * (i % 12))) / f.quantum_m)));
        f.quanta = quanta;
        fields = {f};
        patient.axes = Eigen::AngleAxisd(0.6, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
        patient.origin_mm = Vec3(31.0, -12.0, 400.0);
    }
    template <class Do>
    void each(Do&& visit) const {
        for (std::uint32_t z = 0; z < kZ; ++z)
            for (std::uint32_t y = 0; y < kY; ++y)
                for (std::uint32_t x = 0; x < kX; ++x) visit(x, y, z);
    }
    [[nodiscard]] Vec3 at_mm(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return 1e3 * (bricks.origin_m + kVoxelM * Vec3(x, y, z));
    }
    [[nodiscard]] TrainingBone bone() const {
        return {
            .volume = &volume, .labels = &labels, .distances = fields, .patient = &patient, .checksum = 77};
    }
};

TrainingPlan plan_of(const std::string& text, const fs::path& folder = {}) {
    return read_training_plan_text(text, "task.toml", folder);
}
std::string why(const std::string& text) {
    try {
        static_cast<void>(plan_of(text));
    } catch (const StartupError& e) {
        return e.what();
    }
    return "nothing was wrong";
}

constexpr const char* kTask = R"(
title = "T"
[[goal]]
name = "ball"
sphere = { centre_mm = [8, 4, 10], radius_mm = 3.3 }
share = 0.5
[[goal]]
name = "box"
box = { from_mm = [9, 8, 12], to_mm = [6, 3, 8] }
[[thin]]
structure = "facial <nerve>"
leave_mm = 1.5
share = 0.1
[[forbidden]]
structure = "facial <nerve>"
margin_mm = 0.7
[[forbidden]]
name = "corner"
sphere = { centre_mm = [3, 0, 7], radius_mm = 2.03 }
most_mm3 = 0.05
)";

// Sums of the densities `now`, by plain loops, from the words of the header alone.
struct Plain {
    std::vector<std::int64_t> levels, taken;
    std::int64_t any = 0, any_taken = 0, outside = 0;
};
template <class Stays>
Plain plain_sums(const Ear& ear, const std::vector<std::uint8_t>& now, std::size_t zones, std::size_t goals,
                 Stays&& stays) {
    Plain p;
    p.levels.assign(zones, 0);
    p.taken.assign(zones, 0);
    ear.each([&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const std::size_t i = ear.bricks.voxel(x, y, z);
        const int was = ear.density[i], missing = was - now[i];
        int most = 0;
        for (std::size_t zone = 0; zone < zones; ++zone) {
            const int to_go = was - std::min<int>(was, stays(zone, ear.at_mm(x, y, z), i));
            p.levels[zone] += to_go;
            p.taken[zone] += std::min(missing, to_go);
            if (zone < goals) most = std::max(most, to_go);
        }
        p.any += most;
        p.any_taken += std::min(missing, most);
        p.outside += missing - std::min(missing, most);
    });
    return p;
}
void expect_same(const TrainingSums& s, const Plain& p) {
    std::size_t zone = 0;
    for (const auto* const list : {&s.goal, &s.thin, &s.forbidden})
        for (const TrainingSums::Region& r : *list) {
            EXPECT_EQ(r.levels, p.levels[zone]) << zone;
            EXPECT_EQ(r.taken, p.taken[zone]) << zone;
            ++zone;
        }
    EXPECT_EQ(s.any_goal.levels, p.any);
    EXPECT_EQ(s.any_goal.taken, p.any_taken);
    EXPECT_EQ(s.outside_taken, p.outside);
}

// Takes bone and gives some back, brick by brick, as a follower reports it.
class Drilling {
public:
    explicit Drilling(const Ear& ear) : now(ear.density), ear_(ear), random_(11) {}
    void turn(TrainingVolumes& volumes) {
        for (std::uint32_t b = 0; b < ear_.bricks.brick_count(); ++b) {
            if (random_() % 3 == 0) continue;
            const std::size_t first = std::size_t{b} * BoneBricks::kVoxels;
            const std::vector<std::uint8_t> before(
                now.begin() + static_cast<std::ptrdiff_t>(first),
                now.begin() + static_cast<std::ptrdiff_t>(first + BoneBricks::kVoxels));
            for (std::size_t v = first; v < first + BoneBricks::kVoxels; ++v)
                now[v] = static_cast<std::uint8_t>(random_() % (ear_.density[v] + 1U));
            volumes.brick(b, before, std::span(now).subspan(first, BoneBricks::kVoxels));
        }
    }
    std::vector<std::uint8_t> now;

private:
    const Ear& ear_;
    std::mt19937 random_;
};

TEST(TrainingVolumes, agree_with_plain_loops_after_any_changes) {
    const Ear ear;
    TrainingVolumes volumes(plan_of(kTask), ear.bone());
    const auto stays = [&](std::size_t zone, const Vec3& mm, std::size_t i) {
        const double to_nerve_mm = 12.0 - mm.x();
        const bool in = zone == 0   ? (mm - Vec3(8, 4, 10)).norm() <= 3.3
                        : zone == 1 ? (mm.array() >= Eigen::Array3d(6, 3, 8)).all() &&
                                          (mm.array() <= Eigen::Array3d(9, 8, 12)).all()
                        : zone == 2 ? to_nerve_mm >= 1.3 - 1e-6 && to_nerve_mm < 1.7 - 1e-6
                        : zone == 3 ? to_nerve_mm < 0.7
                                    : (mm - Vec3(3, 0, 7)).norm() <= 2.03;
        return in ? 0 : int{ear.density[i]};
    };
    expect_same(volumes.sums(), plain_sums(ear, ear.density, 5, 2, stays));
    EXPECT_GT(volumes.sums().thin[0].levels, 1000);
    Drilling drilling(ear);
    for (int turn = 0; turn < 4; ++turn) {
        drilling.turn(volumes);
        expect_same(volumes.sums(), plain_sums(ear, drilling.now, 5, 2, stays));
    }
    Vec3 middle_m;
    double radius_m = 0.0;
    ASSERT_TRUE(volumes.goal_ball(middle_m, radius_m));
    EXPECT_LT((1e3 * middle_m - Vec3(8, 4.5, 10)).norm(), 1.0);
    // Neither a brick that does not exist nor bone that the scene never had breaks them.
    const TrainingSums before = volumes.sums();
    const std::vector<std::uint8_t> full(BoneBricks::kVoxels, 255), empty(BoneBricks::kVoxels, 0);
    volumes.brick(1U << 30U, full, empty);
    volumes.brick(0, std::span(full).first(5), empty);
    EXPECT_EQ(volumes.sums().outside_taken, before.outside_taken);
}

TEST(TrainingVolumes, places_in_the_patient_are_where_the_scan_says) {
    const Ear ear;
    const std::string text = R"(
title = "T"
frame = "patient"
[[goal]]
name = "ball"
sphere = { centre_mm = [%s], radius_mm = 2.5 }
[[goal]]
name = "box"
box = { from_mm = [%s], to_mm = [%s] }
)";
    const auto words = [](const Vec3& p) {
        return std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z());
    };
    const Vec3 ball = ear.patient.patient_mm(1e-3 * Vec3(8, 4, 10));
    const Vec3 low = ear.patient.patient_mm(1e-3 * Vec3(9, 5, 11)) - Vec3(2.0, 1.5, 2.5),
               high = low + Vec3(4, 3, 5);
    std::string filled = text;
    for (const Vec3& p : {ball, low, high}) filled.replace(filled.find("%s"), 2, words(p));
    TrainingVolumes volumes(plan_of(filled), ear.bone());
    const auto stays = [&](std::size_t zone, const Vec3& mm, std::size_t i) {
        const Vec3 patient = ear.patient.origin_mm + ear.patient.axes * mm;
        const bool in =
            zone == 0 ? (mm - Vec3(8, 4, 10)).norm() <= 2.5
                      : ((patient - low).array() >= 0.0).all() && ((high - patient).array() >= 0.0).all();
        return in ? 0 : int{ear.density[i]};
    };
    Drilling drilling(ear);
    drilling.turn(volumes);
    expect_same(volumes.sums(), plain_sums(ear, drilling.now, 2, 2, stays));
    EXPECT_GT(volumes.sums().goal[1].levels, 1000);
    TrainingBone unknown = ear.bone();
    unknown.patient = nullptr;
    EXPECT_THROW(TrainingVolumes(plan_of(filled), unknown), StartupError);
}

TEST(TrainingVolumes, an_experts_cavity_is_a_goal_voxel_by_voxel) {
    const Ear ear;
    const Folder folder;
    std::vector<std::uint8_t> expert = ear.density;
    {
        DrilledBoneWriter out(folder.path / "expert.bone", drilled_bone_head(ear.bricks, 77));
        std::mt19937 random(5);
        std::vector<std::uint32_t> bricks;
        std::vector<std::uint8_t> densities;
        for (std::uint32_t b = 10; b < 40; b += 3) {
            bricks.push_back(b);
            for (std::size_t v = std::size_t{b} * BoneBricks::kVoxels;
                 v < (std::size_t{b} + 1) * BoneBricks::kVoxels; ++v) {
                expert[v] = static_cast<std::uint8_t>(random() % (ear.density[v] + 1U));
                densities.push_back(expert[v]);
            }
        }
        out.write(1, bricks, densities);
    }
    TrainingVolumes volumes(
        plan_of("title='T'\n[[goal]]\nname='as the expert'\nexpert='expert.bone'\n", folder.path),
        ear.bone());
    Drilling drilling(ear);
    drilling.turn(volumes);
    expect_same(volumes.sums(),
                plain_sums(ear, drilling.now, 1, 1,
                           [&](std::size_t, const Vec3&, std::size_t i) { return int{expert[i]}; }));
    TrainingBone other = ear.bone();
    other.checksum = 78;
    EXPECT_THROW(
        TrainingVolumes(plan_of("title='T'\n[[goal]]\nname='e'\nexpert='expert.bone'\n", folder.path), other),
        StartupError);
}

TEST(TrainingVolumes, say_what_the_scene_does_not_have) {
    const Ear ear;
    const auto says = [&](const std::string& text, const std::string& part) {
        try {
            TrainingVolumes volumes(plan_of("title = 'T'\n" + text), ear.bone());
        } catch (const StartupError& e) {
            EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
            return;
        }
        ADD_FAILURE() << text;
    };
    says("[[thin]]\nstructure = 'dura'\n", "facial <nerve>");  // the names that there are
    says("[[goal]]\nname = 'far'\nsphere = { centre_mm = [500, 0, 0], radius_mm = 1 }\n",
         "no bone in the goal 'far'");
    says("[[goal]]\nname = 'g'\nexpert = 'missing.bone'\n", "missing.bone");
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
}  // namespace tact::gui_training_test
