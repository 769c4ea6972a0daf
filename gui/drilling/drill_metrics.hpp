// Metrics of a trainee: bone removed (by structure, and near critical ones), force, strokes, times, injuries.
//
// Input     every servo cycle (traces), the newest state of the tools, every changed brick
// Numbers   of the burr in the first hand. Drilling: it turns. Cutting: it also removed bone in that cycle.
//           Force is the force on the hand; excess is above kForceExcessN while drilling.
//           Near: distance to a critical structure from the head's surface (times) or the removed voxel (volumes).
//           Bone that an undone stroke brings back is no longer removed; times and injuries stay.
//           An injury is the removal of a critical structure's bone after none was removed for kInjuryPauseS.
//           Cycles that the window missed are counted, not estimated.
// Unit      SI in the hand's space; bone in density levels, 255 per voxel of solid bone
// Thread    one
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gui/drilling/strokes.hpp"
#include "gui/drilling/structure_watch.hpp"
#include "ipc/scene/bone/bone_labels.hpp"
#include "ipc/topics/event.hpp"

namespace tact {

inline constexpr std::array kDrillNearM{1e-3, 2e-3};  // red and amber
inline constexpr double kForceExcessN = 2.0, kInjuryPauseS = 1.0, kDrillGapS = 0.05;

// Of one labelled structure, or of unlabelled bone.
struct StructureMetrics {
    std::uint64_t removed_levels = 0;
    std::uint64_t injuries = 0;
    double nearest_m = 1e9;                           // while the burr turned; critical ones only
    Vec3 nearest_at_model_m = Vec3::Zero();           // of the burr's centre, then
    std::array<double, kDrillNearM.size()> near_s{};  // drilling time within; critical ones only
};

// A burr that was in the hand.
struct BurrUse {
    DrillShape shape = DrillShape::sphere;
    DrillGrit grit = DrillGrit::cutting;
    double diameter_m = 0.0;
    double drilling_s = 0.0, cutting_s = 0.0;
    std::uint64_t removed_levels = 0;  // also in strokes that were undone
};

struct DrillMetricsRow {
    double seen_s = 0.0, drilling_s = 0.0, cutting_s = 0.0;
    std::uint64_t unseen_cycles = 0;
    double force_cutting_n_s = 0.0, force_n_most = 0.0, excess_s = 0.0;  // impulse while cutting
    double path_m = 0.0;  // of the burr's centre while drilling
    StrokeMetrics strokes;
    std::uint64_t removed_levels = 0;
    std::array<std::uint64_t, kDrillNearM.size()> near_levels{};
    std::array<double, kDrillNearM.size()> near_s{};  // drilling time within, any critical structure
    std::uint64_t injuries = 0;
    std::vector<BurrUse> burr;                // in the order of their first use; kBurrsMost at most
    std::vector<StructureMetrics> structure;  // by label; the first is unlabelled bone
    double level_m3 = 0.0;

    [[nodiscard]] double force_cutting_n() const {
        return cutting_s > 0.0 ? force_cutting_n_s / cutting_s : 0.0;
    }
};

class DrillMetrics {
public:
    // Referenced arguments must outlive it.
    DrillMetrics(const BoneBricks& bricks, const BoneLabelsView& labels,
                 std::span<const DistanceField> fields, const SceneMeta& meta);

    void tools(const DrillTopic& drill);
    void cycle(const TraceTopic& trace);
    void unseen(std::uint64_t cycles) { metrics_.unseen_cycles += cycles; }
    // cut_now: at the time of the newest cycle; else before the controller was found. Returns the label of a critical
    // structure that this newly injures, or 0.
    std::uint8_t brick(std::uint32_t brick, std::span<const std::uint8_t> before,
                       std::span<const std::uint8_t> after, bool cut_now);

    [[nodiscard]] DrillMetricsRow metrics() const;
    // True: in most of the last fraction of a second bone was on all sides of the burr, and its push reduced.
    [[nodiscard]] bool held_in() const { return held_in_share_ > 0.5; }

private:
    [[nodiscard]] double nearest_critical_m(const Vec3& model_m) const;

    BoneBricks bricks_;
    const BoneLabelsView& labels_;
    std::span<const DistanceField> fields_;
    SceneMeta meta_;
    DrillMetricsRow metrics_;
    Strokes strokes_;
    static constexpr std::size_t kBurrsMost = 64;
    [[nodiscard]] std::size_t index_of(const DrillHand& burr);  // in metrics_.burr, added if it is new

    std::size_t burr_ = 0;           // index of the one in the hand
    std::uint64_t burr_levels_ = 0;  // removed by the hand, as of the last call of tools()
    HeadBalls head_;                 // of the burr, at the last call of tools()
    Vec3 head_at_m_ = Vec3::Zero();
    bool head_known_ = false, seen_ = false;
    double cycle_s_ = 0.0, held_in_share_ = 0.0;
    Vec3 path_at_m_ = Vec3::Zero();
    std::vector<double> injured_s_;  // by label: time of the last cut
};

}  // namespace tact
