// Docking model: force on atomic structures in an electron density map.
//
// Energy    U = -k_E * sum_i w_i rho(x_i), k_E in joules per sigma, w_i mass fractions, rho in sigma. Force
//           and torque are its derivatives, so the field is conservative at every level.
// Grip      the tool's translation moves the body's centre of mass and its rotation turns the body about it, so
//           the wrench at the tool's origin is force and torque about the centre of mass. The grip is taken at
//           reset(), when the clutch (button bit 0) is released, and when another body, or the same one
//           elsewhere, comes into the hand. While the clutch is held, the tool moves alone and the body stays.
//           A fixed body in the hand stays too and gives no force.
// Clash     with kDockingClash bodies repel each other (clash_force.hpp); a constant-time order, because its
//           fields are made with the model. The knob does not affect it: a wall must not depend on the load.
// Pull      with kDockingPull the body is drawn to places found for it (basin_pull.hpp). Like the clash force it does not depend on
//           the load and is not part of the density's error.
// Bodies    copies of a structure share its point sets. When the body in the hand changes, the old force fades
//           to zero before the new one fades in.
// Together  with kDockingTogether the copies of the body in the hand that are not fixed make its motions, each in its own axes, so
//           copies related by a symmetry stay so. Density, pull and bending are felt for the body in the hand alone; the clash
//           force is that of all (clash_force.hpp). Copies that move along are not subtracted. A constant-time order.
// Flexible  with kDockingFlexible the body bends along its normal modes (flexible_body.hpp); a constant-time order. Clash force
//           and pull are those of the straight body.
// Knob      "docking.force": codebook levels from the smallest to all atoms, blended in between.
// Work      step() recomputes the budget's work fraction (level_blend.hpp); evaluate() always sums a whole level.
// Frames    wrench in world, bodies in model; SceneMeta converts between them.
// Thread    constructed anywhere (may throw StartupError); then one thread, normally the servo. No
//           allocation. rebuild() alone may run on another thread at the same time.
// Fails by  out_of_range: an invalid or distant pose gives zero force and leaves the bodies in place;
//           out_of_time: the wrench is that of a smaller level, or of older sums.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ipc/scene/density/density_map.hpp"
#include "ipc/scene/density/structure.hpp"
#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/topics/shapes.hpp"
#include "rt/force/docking/basin_pull.hpp"
#include "rt/force/docking/clash_force.hpp"
#include "rt/force/docking/docking_bodies.hpp"
#include "rt/force/docking/docking_parts.hpp"
#include "rt/force/docking/docking_start.hpp"
#include "rt/force/docking/error_audit.hpp"
#include "rt/force/docking/flexible_body.hpp"
#include "rt/force/docking/force_map.hpp"
#include "rt/force/docking/level_blend.hpp"
#include "rt/force/docking/level_glide.hpp"
#include "rt/force/docking/stiffness_audit.hpp"
#include "rt/force/force_fade.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

class DockingModel final : public ForceModel {
public:
    // codebooks: one per structure; levels of ascending size with fewer vectors than the structure has atoms. modes: one per
    // structure, or none.
    DockingModel(const SceneMeta& meta, const DensityGrid& grid, const std::vector<Structure>& structures,
                 const std::vector<Codebook>& codebooks, const DockingSettings& settings,
                 const std::vector<NormalModes>& modes = {});

    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override;
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT override;
    // Of the density at the level of the last step: measured at rest (stiffness_audit.hpp), bounded in motion; plus the bounds of
    // the pull, and of the clash force near other bodies. Before the first step, the largest of all levels.
    [[nodiscard]] ModelStiffness stiffness() const noexcept TACT_RT override;
    void reset(const ToolState& tool) noexcept TACT_RT override;
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override { return bodies_.list(); }
    bool order(const ModelOrder& order) noexcept TACT_RT override;
    [[nodiscard]] bool stale() const noexcept TACT_RT override;
    [[nodiscard]] std::unique_ptr<ForceModel> rebuild(const ModelBodies& bodies) const override;
    bool adopt(const ForceModel& old) noexcept TACT_RT override;
    void publish(const ModelCycle& cycle) noexcept TACT_RT override;
    void publish_to(Latest<ShapesTopic>& topic) { topic_ = &topic; }
    void give_up() noexcept TACT_RT override;

    // Wrench on the active body at a pose, including clash force and pull; equals the wrench of step() after its ramp.
    [[nodiscard]] StepResult evaluate(const Pose& T_model_body, const Budget& budget) const noexcept TACT_RT;
    // Turns options (DockingOption) on or off; constant time, as order(). False: unknown options.
    bool set_options(std::uint32_t options, bool on) noexcept TACT_RT;

    [[nodiscard]] const DensityMap& map() const { return force_map_->maps.front(); }
    [[nodiscard]] const SceneMeta& meta() const { return parts_->meta; }
    [[nodiscard]] double energy_j_per_sigma() const { return energy_j_per_sigma_; }
    [[nodiscard]] Pose home() const { return parts_->structures[bodies_.structure()].home(); }
    [[nodiscard]] const ClashGains& clash_gains() const { return clash_gains_; }
    [[nodiscard]] const ErrorAudit& audit() const { return audit_; }
    [[nodiscard]] const StiffnessAudit& stiffness_audit() const { return stiffness_audit_; }
    [[nodiscard]] const FlexibleBody& flexible() const { return flexible_; }

    static constexpr const char* kKnobPath = "docking.force";

private:
    DockingModel(const DockingModel& like, const ModelBodies& bodies);  // rebuilt

    [[nodiscard]] double newtons_per_gradient() const noexcept {
        return energy_j_per_sigma_ / parts_->meta.world_per_model;
    }
    [[nodiscard]] LevelBlend blend() const noexcept;  // of the structure in the hand
    // Returns whether points of other bodies are near.
    bool add_clash(const Pose& T_model_body, StepResult& result) const noexcept;
    void show_options() noexcept;
    void glide(float fidelity, StepResult& result) noexcept;
    [[nodiscard]] StepResult feel(const ToolState& tool, const Budget& budget) noexcept;
    [[nodiscard]] ModelStiffness of_clash() const noexcept;
    [[nodiscard]] bool is_pulled() const noexcept;
    [[nodiscard]] bool is_flexible() const noexcept;  // the option is on, and the body in the hand can bend
    void bend(const Pose& T_model_body, const Budget& budget, StepResult& result) noexcept;
    // Returns the pull, which is part of the result.
    BasinPull::Pull add_pull(const Pose& T_model_body, StepResult& result) const noexcept;
    bool order_pull(const ModelOrder& order) noexcept;
    void audit(const StepResult& result, const Pose& T_model_body) noexcept;
    void grip(const Pose& T_world_tool) noexcept;
    void fade(const ForceFade& shown) noexcept;
    void let_go() noexcept;
    bool choose_density() noexcept;

    std::shared_ptr<const DockingParts> parts_;
    double energy_j_per_sigma_;
    ClashGains clash_gains_;
    double pull_scale_ = 1.0;  // of the settings
    // Map without subtraction, and map with the options requested when this model was built (may be the same map).
    // force_map_ points to one of them, so a step can switch between them.
    std::shared_ptr<const ForceMap> whole_, built_;
    const ForceMap* force_map_;
    DockingBodies bodies_;
    FlexibleBody flexible_;
    // The grip: translation from tool to centre of mass (constant in world axes), and rotation from tool to body.
    Vec3 com_from_tool_world_m_ = Vec3::Zero();
    Quat q_tool_body_ = Quat::Identity();
    bool clutched_ = true;  // initially true: the first good step takes the grip
    ForceFade fade_;
    KeptSums kept_;
    LevelGlide glide_;
    float level_before_ = 0.0F;
    bool fell_back_ = false;  // the last step used a smaller level than the budget's
    ErrorAudit audit_;
    StiffnessAudit stiffness_audit_;
    BasinPull basins_;
    Latest<ShapesTopic>* topic_ = nullptr;
    bool stepped_ = false;    // the last step had a force of the density
    bool at_others_ = false;  // the last step had points near other bodies
    // By structure, from audits; at least 1.
    std::array<double, ModelBodies::kMax> error_scale_;
    std::array<BendNorms, ModelBodies::kMax> bends_scale_;
};

// Reads map, structures and codebooks from the scene.
std::unique_ptr<DockingModel> load_docking_model(const SceneFile& scene, const DockingSettings& settings);

}  // namespace tact
