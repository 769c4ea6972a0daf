// Force and torque on a mesh tool that touches a triangle mesh, in six degrees of freedom.
//
// Force    k times the displacement from the hand to the proxy (tool_contact.hpp), at the hand point; torque k g^2 times
//          the rotation from the hand to the proxy, with the tool's radius of gyration g about that point, as in the
//          proxy's metric. So without friction both are gradients of one energy, and the wrench is the sum of the
//          contact forces with their torques lever x force.
// Damping  b times the velocity along the wrench, in the same metric, proportional to the depth up to kDampedDepthM;
//          never pulls.
// Limit    (force, torque / g) is scaled down to force_n_max, keeping its direction. If the proxy lags by more than
//          kLostLimits times the displacement at that limit, it is released as in surface_model.hpp.
// Knob     "surface.force": up to kAllPointsAt the number of tool points in use, an eighth to all; above it the number
//          of queries per step, kQueriesLeast to ToolContact::kQueriesMost. Few steps need more than kQueriesLeast; one
//          that does lags. Points added by the knob while the surface is between the others wait until they are free
//          (tool_points.hpp).
// Error    of n points: k times their cover, the depth to which a surface with a slope below 45 degrees against the
//          tool's can enter between them. While gliding or lagging, twice the force instead; predict() adds the share of
//          the recent steps that would have lagged at the level (query_record.hpp).
// Shading  as in surface_model.hpp at each contact, with the torque of the corrected force there. Pace and energy of
//          (force, torque / g): contact_force.hpp.
// Seat     After a reset or the clutch the proxy approaches the hand or the surface from outside within about 60 steps;
//          then the force fades in. A reset keeps a proxy within the limit.
// Else     bodies, clutch, frames, thread as in surface_model.hpp.
#pragma once

#include <memory>

#include "ipc/scene/mesh/touch_tool.hpp"
#include "rt/force/surface/contact_force.hpp"
#include "rt/force/surface/query_record.hpp"
#include "rt/force/surface/shading.hpp"
#include "rt/force/surface/surface_model.hpp"
#include "rt/force/surface/tool_contact.hpp"
#include "rt/force/surface/tool_rehearsal.hpp"

namespace tact {

class ToolModel final : public ForceModel {
public:
    static constexpr double kDampedDepthM = SurfaceModel::kDampedDepthM;
    static constexpr double kLostLimits = SurfaceModel::kLostLimits;
    static constexpr std::uint32_t kPointsLeast = 32, kMovesMost = 64, kQueriesLeast = 32;
    static constexpr float kAllPointsAt = 0.5F;

    // settings.radius_m: radius of the points' balls in world metres; 0: the tool's. The memory behind mesh and forest
    // must outlive the model. Only mode chr needs the forest.
    ToolModel(const SceneMeta& meta, const SurfaceMesh& mesh, const TouchTool& tool,
              const SurfaceSettings& settings, const VertexForest* forest = nullptr);

    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override;
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] static std::uint32_t queries(float fidelity) noexcept TACT_RT;
    [[nodiscard]] ModelStiffness stiffness() const noexcept TACT_RT override {
        return {.force_n_m = settings_.stiffness_n_m, .torque_n_m_rad = torque_n_m_rad_};
    }
    void reset(const ToolState& tool) noexcept TACT_RT override;
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override;
    // Contact data at the hand point, with the three strongest contacts.
    [[nodiscard]] SurfaceTouch touch() const noexcept TACT_RT;
    // Sets the topic to which publish() writes touch(); call it before the first step. Default: none.
    void publish_to(Latest<TouchTopic>& topic) { topic_ = &topic; }
    void publish(const ModelCycle& cycle) noexcept TACT_RT override;

    // Accepts only the filter's form, in mode chr.
    bool order(const ModelOrder& order) noexcept TACT_RT override {
        return adaptive_ != nullptr && adaptive_->order(order);
    }
    [[nodiscard]] double slow_update_s() const noexcept TACT_RT override {
        return adaptive_ == nullptr ? 0.0 : adaptive_->turn_s();
    }
    [[nodiscard]] bool has_slow_update() const noexcept override { return adaptive_ != nullptr; }
    void slow_update(const ToolState& predicted, const Budget& budget) noexcept override;
    [[nodiscard]] TouchRegime regime() const noexcept TACT_RT { return regime_; }  // of the last step

    // Costs that were tried on this machine, instead of those of another one. Before the first step.
    void foresee(const ToolRehearsal& rehearsal) noexcept { rehearsal_ = rehearsal; }
    // Predicted cost and error bound of a level.
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] const ToolTouch& tool_touch() const { return touch_; }  // of the last step
    [[nodiscard]] const ToolContact& contact() const { return solver_; }
    [[nodiscard]] bool slides() const noexcept { return stick_slip_.slides(); }  // after the last step
    [[nodiscard]] std::uint64_t lagging_steps() const { return lagging_; }
    [[nodiscard]] std::uint64_t released() const { return released_; }

private:
    [[nodiscard]] const NearSurface* choose_surface(float fidelity) noexcept TACT_RT;
    [[nodiscard]] Pose goal(const ToolState& tool) const noexcept TACT_RT;
    [[nodiscard]] Vec6 shaded_m() const noexcept TACT_RT;
    void note_friction(const Vec6& way_m) noexcept TACT_RT;
    [[nodiscard]] double error_n(std::uint32_t points) const noexcept TACT_RT;  // between the points
    Wrench wrench(const ToolState& tool, const Vec6& way_m, const Vec6& moved_m) noexcept TACT_RT;

    SceneMeta meta_;
    SurfaceSettings settings_;
    ToolContact solver_;
    std::unique_ptr<AdaptiveToolSurface> adaptive_;
    TouchRegime regime_ = TouchRegime::tree;
    ToolTouch touch_;
    ToolContactForce force_;
    StickSlip stick_slip_;
    QueryRecord record_;
    ToolRehearsal rehearsal_;
    ForceFade fade_;
    double gyration_world_m_, torque_n_m_rad_;
    bool asked_ = false, seated_ = false;
    Latest<TouchTopic>* topic_ = nullptr;
    std::uint64_t grips_ = 0, lagging_ = 0, released_ = 0;
};

// Fails by StartupError if the scene is not a surface with a tool or a setting is out of range. The scene must outlive
// the model. step_s: period of the loop, for which the costs are tried; 0: they are not.
std::unique_ptr<ToolModel> load_tool_model(const SceneFile& scene, const SurfaceSettings& settings,
                                           double step_s = 0.0);

}  // namespace tact
