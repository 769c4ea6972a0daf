// Touching a triangle mesh with a tool that is a mesh itself: six degrees of freedom, force and torque.
//
// Force    k times the way from the hand to the proxy (tool_contact.hpp), at the hand's point; torque k g^2 times
//          the turn from the hand to the proxy, g the tool's radius of gyration about that point, which is the
//          metric of the proxy. So without friction both are slopes of one energy, and the wrench is the sum of
//          what the touched places push with: torque = lever x force of each.
// Damping  b times the speed along the wrench, in the same metric, in proportion to the depth up to
//          kDampedDepthM; it never pulls.
// Limit    the wrench keeps its direction where (force, torque / g) is larger than force_n_max. Left behind by
//          more than kLostLimits times the way at that limit, the proxy is released as in surface_model.hpp.
// Knob     "surface.force": points of the tool that are felt, an eighth to all of them. Points that the knob
//          brings while the surface pokes between the others wait until they are free (tool_points.hpp).
// Error    of feeling n points: k times their cover, as deep as a surface may poke between them whose slope
//          against the tool's own stays below 45 degrees. While it glides or lags twice the force instead.
// Shading  as surface_model.hpp at each touched place: the turn of its push acts there, so it has its torque. Its pace
//          is that of (force, torque / g).
// Seat     after a reset or the clutch the proxy comes from away from the surface to the hand, or to rest on it,
//          within some 60 steps; then the force fades in. At a reset a proxy that is within the limit is kept.
// Else     bodies, clutch, frames, thread as surface_model.hpp.
#pragma once

#include <memory>

#include "ipc/scene/mesh/touch_tool.hpp"
#include "rt/force/surface/shading.hpp"
#include "rt/force/surface/surface_model.hpp"
#include "rt/force/surface/tool_contact.hpp"

namespace tact {

class ToolModel final : public ForceModel {
public:
    static constexpr double kDampedDepthM = SurfaceModel::kDampedDepthM;
    static constexpr double kLostLimits = SurfaceModel::kLostLimits;
    static constexpr std::uint32_t kPointsLeast = 32, kMovesMost = 32;

    // settings.radius_m: of the points' balls in the hand's world; 0: as the tool says. The bytes behind mesh and
    // forest must outlive the model. The forest is there for mode chr alone.
    ToolModel(const SceneMeta& meta, const SurfaceMesh& mesh, const TouchTool& tool,
              const SurfaceSettings& settings, const VertexForest* forest = nullptr);

    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override;
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] double stiffness_n_m() const noexcept TACT_RT override { return settings_.stiffness_n_m; }
    void reset(const ToolState& tool) noexcept TACT_RT override;
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override;
    // About the hand's point; the three places that push most.
    [[nodiscard]] SurfaceTouch touch() const noexcept TACT_RT;
    // Where touch() is published each cycle; before the first step. Nowhere: the default.
    void publish_to(Latest<TouchTopic>& topic) { topic_ = &topic; }
    void publish(const ModelCycle& cycle) noexcept TACT_RT override;

    // The filter's form, in mode chr.
    bool order(const ModelOrder& order) noexcept TACT_RT override {
        return adaptive_ != nullptr && adaptive_->order(order);
    }
    [[nodiscard]] double slow_update_s() const noexcept TACT_RT override {
        return adaptive_ == nullptr ? 0.0 : adaptive_->turn_s();
    }
    [[nodiscard]] bool has_slow_update() const noexcept override { return adaptive_ != nullptr; }
    void slow_update(const ToolState& predicted, const Budget& budget) noexcept override;
    [[nodiscard]] TouchRegime regime() const noexcept TACT_RT { return regime_; }  // of the last step

    // Cost and error of a level before it is computed.
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] const ToolTouch& tool_touch() const { return touch_; }  // of the last step
    [[nodiscard]] const ToolContact& contact() const { return solver_; }
    [[nodiscard]] double torque_n_m_rad() const { return torque_n_m_rad_; }  // stiffness in rotation
    [[nodiscard]] std::uint64_t lagging_steps() const { return lagging_; }
    [[nodiscard]] std::uint64_t released() const { return released_; }

private:
    [[nodiscard]] const NearSurface* choose_surface(float fidelity) noexcept TACT_RT;
    [[nodiscard]] Pose goal(const ToolState& tool) const noexcept TACT_RT;
    [[nodiscard]] Vec6 shaded_m() const noexcept TACT_RT;
    [[nodiscard]] Wrench felt(const ToolState& tool, const Vec6& way_m) const noexcept TACT_RT;

    SceneMeta meta_;
    SurfaceSettings settings_;
    ToolContact solver_;
    std::unique_ptr<AdaptiveToolSurface> adaptive_;
    TouchRegime regime_ = TouchRegime::tree;
    ToolTouch touch_;
    PacedTurn<Vec6> turn_;  // by shading
    ForceFade fade_;
    double gyration_world_m_, torque_n_m_rad_;
    bool asked_ = false, seated_ = false;
    Latest<TouchTopic>* topic_ = nullptr;
    std::uint64_t grips_ = 0, lagging_ = 0, released_ = 0;
};

// Fails by StartupError where the scene is no surface with a tool or a setting is out of range. The scene must
// outlive the model.
std::unique_ptr<ToolModel> load_tool_model(const SceneFile& scene, const SurfaceSettings& settings);

}  // namespace tact
