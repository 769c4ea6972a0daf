// Sums over the bone of a training task, against plain loops over all voxels.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"
#include "tests/unit/training_ear.hpp"

namespace tact::training_test {
namespace {

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

}  // namespace
}  // namespace tact::training_test
