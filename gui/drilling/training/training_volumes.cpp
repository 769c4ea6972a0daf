#include "gui/drilling/training/training_volumes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ipc/base/error.hpp"
#include "ipc/scene/bone/drilled_bone.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kEdge = BoneBricks::kEdge;
constexpr double kMm = 1e-3;

// Of a voxel in its brick.
Vec3 place_in_brick(std::uint32_t voxel) {
    const std::uint32_t y = voxel / kEdge % kEdge, z = voxel / kEdge / kEdge;
    return {static_cast<double>(voxel % kEdge), static_cast<double>(y), static_cast<double>(z)};
}

[[noreturn]] void fail(const std::string& why, const std::string& fix) {
    throw StartupError("preparing the training task", why, fix);
}

}  // namespace

TrainingVolumes::TrainingVolumes(const TrainingPlan& plan, const TrainingBone& bone)
    : bone_(bone), bricks_(bone.volume->bricks), goals_(plan.goal.size()), thins_(plan.thin.size()) {
    for (const TrainingGoal& g : plan.goal) zone_.push_back(zone_of(g.region, plan));
    for (const TrainingThin& t : plan.thin) {
        Zone& zone = zone_.emplace_back();
        zone.kind = TrainingRegion::Kind::structure;
        zone.field = &field_of(t.structure);
        zone.from_m = kMm * t.leave_mm - 0.5 * bricks_.voxel_m;
        zone.to_m = zone.from_m + bricks_.voxel_m;
    }
    for (const TrainingForbidden& f : plan.forbidden) zone_.push_back(zone_of(f.region, plan));
    sums_.goal.resize(goals_);
    sums_.thin.resize(thins_);
    sums_.forbidden.resize(plan.forbidden.size());
    touched_.assign(bricks_.brick_count(), 0);
    for (std::uint32_t b = 0; b < touched_.size(); ++b) {
        const Vec3 middle_m = bricks_.to_model(corner(b) + Vec3::Constant(0.5 * (kEdge - 1.0)));
        for (std::size_t z = 0; z < zone_.size(); ++z)
            if (may_touch(zone_[z], b, middle_m)) touched_[b] |= Mask{1} << z;
        if (touched_[b] == 0) continue;
        const auto baked =
            bone_.volume->density.subspan(std::size_t{b} * BoneBricks::kVoxels, BoneBricks::kVoxels);
        for (std::uint32_t v = 0; v < BoneBricks::kVoxels; ++v) {
            if (baked[v] == 0) continue;
            const Vec3 at_m = bricks_.to_model(corner(b) + place_in_brick(v));
            int least = baked[v];
            for (Mask m = touched_[b]; m != 0; m &= m - 1) {
                const auto z = static_cast<std::size_t>(std::countr_zero(m));
                const int stays = left(zone_[z], b, v, at_m, baked[v]);
                region(z).levels += baked[v] - stays;
                if (stays < baked[v]) {
                    zone_[z].least_m = zone_[z].least_m.cwiseMin(at_m);
                    zone_[z].most_m = zone_[z].most_m.cwiseMax(at_m);
                }
                if (z < goals_) least = std::min(least, stays);
            }
            sums_.any_goal.levels += baked[v] - least;
        }
    }
    for (std::size_t g = 0; g < goals_; ++g)
        if (sums_.goal[g].levels == 0)
            fail("there is no bone in the goal '" + plan.goal[g].name + "'",
                 "choose a place in the bone: millimetres are in the axes of the " +
                     std::string(plan.patient ? "patient (LPS)" : "scene"));
    for (std::size_t t = 0; t < thins_; ++t)
        if (sums_.thin[t].levels == 0)
            fail("there is no bone " + std::to_string(plan.thin[t].leave_mm) + " mm from the " +
                     plan.thin[t].structure,
                 "choose another leave_mm");
}

Vec3 TrainingVolumes::corner(std::uint32_t brick) const {
    const auto n = bricks_.bricks();
    const std::uint32_t x = brick % n[0], y = brick / n[0] % n[1], z = brick / n[0] / n[1];
    return kEdge * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
}

TrainingSums::Region& TrainingVolumes::region(std::size_t zone) {
    if (zone < goals_) return sums_.goal[zone];
    if (zone < goals_ + thins_) return sums_.thin[zone - goals_];
    return sums_.forbidden[zone - goals_ - thins_];
}

const DistanceField& TrainingVolumes::field_of(const std::string& structure) const {
    std::string known;
    for (const DistanceField& field : bone_.distances) {
        const std::string& name = bone_.labels->structure[field.label - 1].name;
        if (name == structure) return field;
        known += (known.empty() ? "" : ", ") + name;
    }
    fail("the scene has no distances from '" + structure + "'",
         known.empty() ? "give the scan's labels: tact drill SCAN --labels FILE"
                       : "its critical structures are: " + known);
}

TrainingVolumes::Zone TrainingVolumes::zone_of(const TrainingRegion& r, const TrainingPlan& plan) const {
    Zone zone;
    zone.kind = r.kind;
    const bool placed = r.kind == TrainingRegion::Kind::sphere || r.kind == TrainingRegion::Kind::box;
    if (placed && plan.patient && bone_.patient == nullptr)
        fail(
            "its places are in the patient's millimetres, and the scan does not say how it lies in the "
            "patient",
            "give them in the scene's: frame = \"scene\"");
    const auto model_m = [&](const Vec3& mm) {
        return plan.patient ? bone_.patient->model_m(mm) : Vec3(kMm * mm);
    };
    switch (r.kind) {
        case TrainingRegion::Kind::sphere:
            zone.a_m = model_m(r.a_mm);
            zone.radius_m = kMm * r.radius_mm;
            break;
        case TrainingRegion::Kind::box: {
            zone.a_m = model_m(r.a_mm);
            if (plan.patient) zone.axes = bone_.patient->axes;
            zone.high_m = kMm * (r.b_mm - r.a_mm);
            zone.radius_m = 0.5 * zone.high_m.norm();
            break;
        }
        case TrainingRegion::Kind::structure:
            zone.field = &field_of(r.structure);
            zone.from_m = -1e9;
            zone.to_m = kMm * r.margin_mm;
            break;
        case TrainingRegion::Kind::expert:
            read_drilled_bone(r.expert, *bone_.volume, bone_.checksum, [&zone](const DrilledBrick& b) {
                std::copy(b.voxels.begin(), b.voxels.end(), zone.expert[b.brick].begin());
            });
            break;
    }
    return zone;
}

bool TrainingVolumes::may_touch(const Zone& zone, std::uint32_t brick, const Vec3& middle_m) const {
    const double half_m = 0.5 * std::sqrt(3.0) * kEdge * bricks_.voxel_m;
    switch (zone.kind) {
        case TrainingRegion::Kind::sphere:
            return (middle_m - zone.a_m).norm() <= zone.radius_m + half_m;
        case TrainingRegion::Kind::box: {
            const Vec3 box_middle_m = zone.a_m + zone.axes.transpose() * (0.5 * zone.high_m);
            return (middle_m - box_middle_m).norm() <= zone.radius_m + half_m;
        }
        case TrainingRegion::Kind::structure: {
            const double away_m = zone.field->distance_m(middle_m);
            const double unsure_m = half_m + 2.0 * zone.field->error_m;
            return away_m <= zone.to_m + unsure_m && away_m >= zone.from_m - unsure_m;
        }
        case TrainingRegion::Kind::expert:
            return zone.expert.contains(brick);
    }
    return false;
}

int TrainingVolumes::left(const Zone& zone, std::uint32_t brick, std::uint32_t voxel, const Vec3& at_m,
                          int density) const {
    bool inside = false;
    switch (zone.kind) {
        case TrainingRegion::Kind::sphere:
            inside = (at_m - zone.a_m).squaredNorm() <= zone.radius_m * zone.radius_m;
            break;
        case TrainingRegion::Kind::box: {
            const Vec3 p = zone.axes * (at_m - zone.a_m);
            inside = (p.array() >= 0.0).all() && (p.array() <= zone.high_m.array()).all();
            break;
        }
        case TrainingRegion::Kind::structure: {
            const double away_m = zone.field->distance_m(at_m);
            inside = away_m >= zone.from_m && away_m < zone.to_m;
            break;
        }
        case TrainingRegion::Kind::expert: {
            const auto found = zone.expert.find(brick);
            return found != zone.expert.end() ? std::min<int>(found->second[voxel], density) : density;
        }
    }
    return inside ? 0 : density;
}

void TrainingVolumes::add(std::uint32_t brick, std::span<const std::uint8_t> now, int sign) {
    const auto baked =
        bone_.volume->density.subspan(std::size_t{brick} * BoneBricks::kVoxels, BoneBricks::kVoxels);
    for (std::uint32_t v = 0; v < BoneBricks::kVoxels; ++v) {
        // A controller's bone never holds more than the scene's (BoneFollower); if it does, nothing is missing.
        const int missing = std::max(int{baked[v]} - int{now[v]}, 0);
        if (missing == 0) continue;
        const Vec3 at_m = bricks_.to_model(corner(brick) + place_in_brick(v));
        int least = baked[v];
        for (Mask m = touched_[brick]; m != 0; m &= m - 1) {
            const auto z = static_cast<std::size_t>(std::countr_zero(m));
            const int stays = left(zone_[z], brick, v, at_m, baked[v]);
            region(z).taken += std::int64_t{sign} * std::min(missing, baked[v] - stays);
            if (z < goals_) least = std::min(least, stays);
        }
        const int of_goals = std::min(missing, baked[v] - least);
        sums_.any_goal.taken += std::int64_t{sign} * of_goals;
        sums_.outside_taken += std::int64_t{sign} * (missing - of_goals);
    }
}

void TrainingVolumes::brick(std::uint32_t brick, std::span<const std::uint8_t> before,
                            std::span<const std::uint8_t> after) {
    if (brick >= touched_.size() || before.size() != BoneBricks::kVoxels ||
        after.size() != BoneBricks::kVoxels)
        return;
    add(brick, before, -1);
    add(brick, after, 1);
}

bool TrainingVolumes::goal_ball(Vec3& middle_m, double& radius_m) const {
    Vec3 least = Vec3::Constant(1e9), most = -least;
    for (std::size_t g = 0; g < goals_; ++g) {
        least = least.cwiseMin(zone_[g].least_m);
        most = most.cwiseMax(zone_[g].most_m);
    }
    if (!(least.x() <= most.x())) return false;
    middle_m = 0.5 * (least + most);
    radius_m = 0.5 * (most - least).norm();
    return true;
}

}  // namespace tact
