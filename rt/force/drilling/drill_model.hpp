// Drilling bone with a burr, or feeling it with any tool that is a union of balls.
//
// Force    of each ball (burr_forces.hpp) from the mass in it, with its weight, at its centre; head and shaft alike. The
//          whole wrench is scaled down to force_n_max.
// Cutting  balls of the head that cut take bone along their way since the last step (erosion.hpp), after the force of
//          the step. a is in proportion to the burr's speed; a burr that stands takes nothing. Harder pressed it
//          goes deeper, and so takes more: eq. 12 knows no other pressure.
// Knob     "drilling.force": smallest block looked at, 0.5 R to 0.1 R (eq. 8), less where the last step was shallow; and
//          the groups of bricks that a step cuts (erosion_turns.hpp), from one to all. Below kRoughUntil blocks shrink less
//          near the surface. Turning it is smooth, and a jump of it is absorbed (force_fade.hpp).
// Late     past the deadline the remaining balls are felt in blocks of 0.5 R, whatever the depth, and nothing more is cut;
//          steps in time cut for all the time since, kStepSMost at most, so nothing is left out.
// Error    of a level: of its blocks, and of the bone that waits to be cut (drill_load.hpp).
// Items    balls, blocks and voxels that were summed and cut; predict() expects them from the last step's.
// Jumps    a tool that goes farther in a step than kJumpRadii of its radius, and 5 mm, was not led there by a hand: it
//          cuts nothing on the way; counted.
// Clutch   held, the force fades out and nothing is cut. Reset: the force fades in from zero, and cutting with it.
// Burr     an order gives the hand another head: the force fades out, a model of the new tool is built aside (rebuild())
//          and continues from the old one (adopt()): its force fades in. Its speed follows orders by kSpinRadS2.
// Undo     the tool that cuts takes the orders to undo and redo a stroke (stroke_history.hpp). All tools' forces fade out,
//          bricks are exchanged where there is no force, and the forces fade in again.
// Repeats  the same poses, drives and seed give the same forces and densities, bit by bit, where no step was late.
// Bodies   one, the tool.
// Frames   tool and wrench in world, the bone in model; SceneMeta maps one to the other.
// Thread   constructed anywhere (may throw StartupError); then servo. Models of one bone belong to one thread. No
//          allocation.
#pragma once

#include <array>
#include <span>

#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/topics/command.hpp"
#include "rt/force/drilling/ball_moments.hpp"
#include "rt/force/drilling/burr_forces.hpp"
#include "rt/force/drilling/burr_shapes.hpp"
#include "rt/force/drilling/drill_bone.hpp"
#include "rt/force/drilling/drill_load.hpp"
#include "rt/force/drilling/drill_rehearsal.hpp"
#include "rt/force/drilling/drill_stiffness.hpp"
#include "rt/force/drilling/erosion.hpp"
#include "rt/force/drilling/erosion_turns.hpp"
#include "rt/force/force_fade.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

struct DrillSettings {
    DrillToolSettings tool;
    BurrGrit grit = BurrGrit::cutting;
    double diamond_share = 0.3;  // of a diamond burr: its rate and vibration over those of a cutting one
    BurrLaw law;
    // c_e of each ball by elastic_for(); 0: law.elastic_pa of all.
    double depth_at_1_n_m = 1.25e-3;
    double burr_rad_s = 0.0;   // while its drive is on
    double rate_per_s = 40.0;  // a of eq. 12 of solid bone, at this speed of the burr:
    double rate_at_rad_s = 2.0 * 3.14159265358979323846 * 1000.0;
    double soft = 2.0;  // a of the softest bone over that of solid bone; linear between
    double force_n_max = 3.3;
    double vibration = 0.0;  // of the running burr, over the elastic force; 0 to 0.5
    std::uint64_t seed = 1;
};

// How the burr turns in the next step. What is not finite or below zero is a burr that stands.
struct BurrDrive {
    double burr_rad_s = 0.0;  // about the shaft's axis
    double step_s = 1e-3;     // since the step before
};

class DrillPublisher;

// Fails by StartupError where one is out of range.
void check_drill_settings(const DrillSettings& settings);
// Widens a shaft or tube that is thinner than a voxel to one voxel; returns true if it did. Leaves a head that is too
// small unchanged; the model then refuses it.
[[nodiscard]] bool fit_to_voxels(DrillSettings& settings, const SceneMeta& meta, const BoneBricks& bricks);

class DrillModel : public ForceModel {
public:
    static constexpr const char* kKnobPath = "drilling.force";
    static constexpr double kBlockFine = 0.1, kBlockDefault = 0.3,
                            kBlockCoarse = kBlockMost;  // of the radius
    static constexpr double kJumpRadii = 4.0, kJumpM = 5e-3;
    static constexpr double kRadiusMost = 200.0;  // voxels
    static constexpr double kStepSMost = 0.1;     // that a step, or steps that were late, can stand for
    static constexpr double kSpinRadS2 = 2e4;     // of the burr, to a speed that was ordered
    static constexpr double kNeckShare = 0.8;     // of a small head's radius: its shaft's
    static constexpr double kShaftBallsMost =
        18.0;  // of a burr that was ordered: a thin shaft is felt over less of its length

    // The bone must outlive the model.
    DrillModel(const SceneMeta& meta, DrillBone& bone, const DrillSettings& settings);
    DrillModel(const DrillModel&) = delete;
    DrillModel& operator=(const DrillModel&) = delete;

    // Turns the burr at settings.burr_rad_s while its drive is on.
    void drive(const ToolDrive& drive) noexcept TACT_RT override;
    // At another speed. Until either is called, the burr stands.
    void turn_burr(const BurrDrive& drive) noexcept TACT_RT;

    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override;
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT override {
        return predict(fidelity).items;
    }
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT override;
    void reset(const ToolState& tool) noexcept TACT_RT override;
    bool order(const ModelOrder& order) noexcept TACT_RT override;
    // Another burr was ordered.
    [[nodiscard]] bool stale() const noexcept TACT_RT override { return burr_asked_; }
    [[nodiscard]] std::unique_ptr<ForceModel> rebuild(const ModelBodies& bodies) const override;
    bool adopt(const ForceModel& old) noexcept TACT_RT override;
    void give_up() noexcept TACT_RT override { burr_asked_ = false; }
    // The head's on a flat surface at force_n_max or, where bone on several sides makes it stiffer, as measured
    // (drill_stiffness.hpp).
    [[nodiscard]] ModelStiffness stiffness() const noexcept TACT_RT override {
        return {.force_n_m = std::max(stiffness_n_m_, measured_.largest().force_n_m),
                .torque_n_m_rad = measured_.largest().torque_n_m_rad};
    }
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override;
    // Before the first step: what predict() knows of this machine and of a contact that may come.
    void foresee(const DrillRehearsal& rehearsal) noexcept { rehearsal_ = rehearsal; }
    // Before the first step; the publisher outlives the model.
    void publish_to(DrillPublisher& publisher);
    void publish(const ModelCycle& cycle) noexcept TACT_RT override;

    // Of a step of step_s at a level, from what the last one found.
    [[nodiscard]] DrillWork expected(float fidelity, double step_s) const noexcept TACT_RT;
    // Of the last step.
    [[nodiscard]] DrillWork work() const noexcept TACT_RT {
        DrillWork all = last_.work;
        all.add(last_.still);
        return all;
    }
    [[nodiscard]] const ErosionPass& cut() const noexcept TACT_RT { return erosion_.pass(); }
    [[nodiscard]] std::span<const BoneDust> dust() const noexcept TACT_RT { return erosion_.dust(); }
    [[nodiscard]] double depth() const noexcept TACT_RT {
        return depth_;
    }  // h / R of the head, its deepest ball
    [[nodiscard]] double elastic_n() const noexcept TACT_RT {
        return elastic_n_;
    }  // sum of sizes, before limits
    [[nodiscard]] const BurrForce& head_force() const noexcept TACT_RT { return head_; }  // of that ball
    [[nodiscard]] const Pose& T_model_tool() const noexcept TACT_RT { return T_model_tool_; }
    [[nodiscard]] double head_radius_m() const noexcept TACT_RT { return head_radius_m_; }
    [[nodiscard]] const ToolDrive& driven() const noexcept TACT_RT { return driven_; }
    [[nodiscard]] double burr_rad_s() const noexcept TACT_RT { return drive_.burr_rad_s; }
    // Since it was made, also in strokes that were undone.
    [[nodiscard]] std::uint64_t removed_levels() const noexcept TACT_RT { return erosion_.removed(); }
    // Of solid bone, in the world.
    [[nodiscard]] double removed_m3() const noexcept TACT_RT {
        return static_cast<double>(removed_levels()) * level_m3();
    }
    [[nodiscard]] double level_m3() const noexcept TACT_RT {
        return per_voxel_m_ * per_voxel_m_ * per_voxel_m_ / 255.0;
    }
    [[nodiscard]] std::uint64_t postponed() const noexcept TACT_RT { return postponed_; }  // steps
    [[nodiscard]] std::uint64_t jumps() const noexcept TACT_RT { return jumps_; }

    [[nodiscard]] const SceneMeta& meta() const { return meta_; }
    [[nodiscard]] const DrillSettings& settings() const { return settings_; }
    [[nodiscard]] const DrillTool& tool() const { return tool_; }
    [[nodiscard]] const DrillBone& bone() const noexcept TACT_RT { return bone_; }
    [[nodiscard]] static BlockDetail detail_of(float fidelity) noexcept TACT_RT;

private:
    // hand: a bit of DrillBone::pushing.
    DrillModel(const SceneMeta& meta, DrillBone& bone, const DrillSettings& settings, std::uint32_t hand);
    // A head that voxels and sizes allow. Another one is not asked for before it is in the hand.
    [[nodiscard]] bool ask_for_burr(const ModelOrder& order) noexcept TACT_RT;
    [[nodiscard]] bool set_drive(CommandKind kind, double value) noexcept TACT_RT;
    [[nodiscard]] double grit_share() const noexcept TACT_RT {
        return settings_.grit == BurrGrit::diamond ? settings_.diamond_share : 1.0;
    }

    static constexpr BlockDetail kLate{.block = kBlockMost, .rough = 1.0};
    struct BallForces {
        Wrench wrench;           // at the tool's origin, world, before limits
        double elastic_n = 0.0;  // sum of sizes
        double shallow_n = 0.0;  // of them (drill_load.hpp)
        double voxel_error_n = 0.0;
        double scale = 1.0;  // down to force_n_max
        bool late = false;
        DrillWork work;
        BallLook look;           // at the ball with most work
        double pending_n = 0.0;  // error per exposure that waits
        bool held_in = false;    // one of them
        DrillWork still;         // of the stiffness
        BallLook still_look;     // at that ball; block 0: not measured
    };
    [[nodiscard]] BallForces ball_forces(const ToolState& tool, const BlockDetail& detail, bool hurried,
                                         const Deadline& deadline) noexcept TACT_RT;
    // Without velocity and vibration, within force_n_max.
    [[nodiscard]] Wrench still_wrench(const Pose& T_world_tool, const BlockDetail& detail,
                                      DrillWork& work) const noexcept TACT_RT;
    void measure_stiffness(const Pose& T_world_tool, const BlockDetail& detail) noexcept TACT_RT;
    [[nodiscard]] double rate_per_s() const noexcept TACT_RT;
    [[nodiscard]] double error_n(const BallForces& sum, const BlockDetail& detail,
                                 double pending) const noexcept TACT_RT;
    void follow_contact(bool touches) noexcept TACT_RT;
    void forget_depths() noexcept TACT_RT;
    [[nodiscard]] Vec3 shaken_n(const ToolState& tool, double elastic_n) noexcept TACT_RT;

    SceneMeta meta_;
    DrillBone& bone_;
    std::uint32_t pushing_bit_;
    DrillSettings settings_, started_;  // of this tool; of the one that the scene began with
    struct Burr {
        BurrShape shape = BurrShape::sphere;
        BurrGrit grit = BurrGrit::cutting;
        double radius_m = 0.0, length_m = 0.0;
    } burr_;                   // asked for
    bool burr_asked_ = false;  // burr_ stays as it is while this holds: rebuild() reads it
    double spin_rad_s_ = 0.0;  // while the drive is on; settings_.burr_rad_s is where it goes
    DrillTool tool_;
    const BrickKernels& kernels_;
    Erosion erosion_;
    ForceFade fade_;
    float level_ = 1.0F;  // of the last step
    double error_before_n_ = 0.0;
    ToolDrive driven_;
    BurrDrive drive_;
    // Streaming median: a step that another program held does not predict what the next ones cost.
    double usual_step_s_ = BurrDrive{}.step_s;
    DrillPublisher* publisher_ = nullptr;
    double stiffness_n_m_ = 0.0, per_voxel_m_ = 1.0;  // world metres of a voxel edge
    double head_radius_m_ = 0.0;
    std::array<Vec3, DrillTool::kMax> now_voxels_{};  // centres
    ErosionTurns turns_{1.0};
    BallForces last_;  // of the last step
    DrillStiffness measured_;
    double lever_m_ = 0.0;  // farthest part of the tool from its origin
    DrillRehearsal rehearsal_;
    double contact_s_ = 0.0, free_s_ = 0.0;  // of all contacts, since the last one
    bool cuts_ = false;                      // the clutch is open
    bool asked_ = false;                     // reset() was called
    bool led_ = false;                       // now_voxels_ are of a tool that was led here
    bool exchanged_ = false;                 // a stroke, in the last step
    // h / R of the step before; below 0: unknown.
    std::array<double, DrillTool::kMax> depths_{};
    std::array<Vec3, DrillTool::kMax> ways_out_{};
    std::array<double, DrillTool::kMax> elastic_pa_{};
    double depth_ = 0.0, elastic_n_ = 0.0, phase_rad_ = 0.0;
    BurrForce head_;  // of the deepest ball of the head
    Pose T_model_tool_;
    std::uint64_t grips_ = 0, tools_ = 0, postponed_ = 0, jumps_ = 0;
};

}  // namespace tact
