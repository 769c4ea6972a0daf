// How much bone is gone where a training task asks for it, and where it does not: sums over the voxels.
//
// Goal      a voxel of density d has max(d - t, 0) levels to go, t what is to be left: nothing, or the expert's density
// Taken     of it, what is missing; the rest of what is missing anywhere is outside
// Thin      voxels whose distance from the structure is within half a voxel of the plan's
// Exact     after any changes of any bricks the sums are those of the present densities; bone that comes back counts back
// Unit      density levels, 255 per voxel of solid bone
// Cost      constructed in some seconds at most (any thread); brick() visits the voxels of one brick, and only if it is in a region
// Fails by  StartupError: a structure that the scene does not have, an expert's file of another scene, a region without bone
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "gui/drilling/training/training_plan.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/bone/distance_field.hpp"

namespace tact {

struct TrainingSums {
    struct Region {
        std::int64_t levels = 0, taken = 0;
        [[nodiscard]] double share() const {
            return levels > 0 ? static_cast<double>(taken) / static_cast<double>(levels) : 0.0;
        }
    };
    std::vector<Region> goal, thin, forbidden;  // as in the plan
    Region any_goal;                            // a voxel in several goals once
    std::int64_t outside_taken = 0;             // of no goal
};

// The bone of a scene, as baked. All of it must outlive the volumes.
struct TrainingBone {
    const BoneVolumeView* volume = nullptr;
    const BoneLabelsView* labels = nullptr;
    std::span<const DistanceField> distances;
    const PatientFrame* patient = nullptr;  // null: unknown
    std::uint64_t checksum = 0;             // of the scene
};

class TrainingVolumes {
public:
    TrainingVolumes(const TrainingPlan& plan, const TrainingBone& bone);

    void brick(std::uint32_t brick, std::span<const std::uint8_t> before,
               std::span<const std::uint8_t> after);
    [[nodiscard]] const TrainingSums& sums() const { return sums_; }
    // Of the goals: middle and half diagonal, model metres. False: there is none.
    [[nodiscard]] bool goal_ball(Vec3& middle_m, double& radius_m) const;

private:
    using Mask = std::uint64_t;  // bits: goals, then thin, then forbidden
    using Expert = std::unordered_map<std::uint32_t, std::array<std::uint8_t, BoneBricks::kVoxels>>;
    // A region, ready to be asked.
    struct Zone {
        TrainingRegion::Kind kind = TrainingRegion::Kind::sphere;
        Vec3 a_m = Vec3::Zero();                             // model: centre
        Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // of a box: model to its frame
        Vec3 low_m = Vec3::Zero(), high_m = Vec3::Zero();    // of a box, in its frame, relative to a_m
        double radius_m = 0.0;
        const DistanceField* field = nullptr;
        double from_m = 0.0, to_m = 0.0;  // of the distance, model metres
        Expert expert;
        Vec3 least_m = Vec3::Constant(1e9), most_m = Vec3::Constant(-1e9);  // of its bricks
    };
    [[nodiscard]] Zone zone_of(const TrainingRegion& region, const TrainingPlan& plan) const;
    [[nodiscard]] const DistanceField& field_of(const std::string& structure) const;
    [[nodiscard]] bool may_touch(const Zone& zone, std::uint32_t brick, const Vec3& middle_m) const;
    // What is to be left of a voxel of this density: the density itself where it is in no region.
    [[nodiscard]] int left(const Zone& zone, std::uint32_t brick, std::uint32_t voxel, const Vec3& at_m,
                           int density) const;
    // Adds the brick's part times sign.
    void add(std::uint32_t brick, std::span<const std::uint8_t> now, int sign);
    [[nodiscard]] Vec3 corner(std::uint32_t brick) const;  // voxels
    TrainingSums::Region& region(std::size_t zone);

    TrainingBone bone_;
    BoneBricks bricks_;
    std::size_t goals_, thins_;
    std::vector<Zone> zone_;
    std::vector<Mask> touched_;  // per brick
    TrainingSums sums_;
};

}  // namespace tact
