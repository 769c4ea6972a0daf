// The force on a point or a ball that touches a triangle mesh.
//
// Force    k times the vector from the tool to the proxy (contact.hpp), which no triangle lets through, with the normals
//          of shading (shading.hpp), in the friction cone about them. A closed excursion gains no energy (contact_force.hpp).
// Damping  along the force, proportional to the depth up to kDampedDepthM; never pulls. A sampled spring k with period T
//          needs a damping of k T/2 from hand and arm (Colgate 1997), plus the model's own b: k T/2 + b must stay
//          below the damping of hand and arm. By default 0.75 N s/m at 1 kHz.
// Limit    force_n_max. A proxy that cannot keep up gives k times the current way, limited; the step is out_of_time and
//          counted, and its error bound is twice that force. If it lags by more than kLostLimits times the way at the
//          limit, it is released: the force fades out, the proxy is seated as after a reset, the force fades in.
// Knob     "surface.force": maximum number of proxy moves per step, 4 to 24. A proxy that needs more lags and catches up in
//          later steps. Most steps need two (README.md), so usually all levels are equal. predict() uses the moves of
//          the last half second and the levels that would have lagged in it (lag_record.hpp).
// Error    of a settled step: twice the margin, and what pace, energy and fading of shading change. A step that is not
//          settled adds twice the force; one that lagged does so until the proxy is free again, because until then it may
//          be held elsewhere than without the lag.
// Modes    off_brute: every triangle in every step; off_tree: search in the tree over the full mesh; chr: search in the
//          surface that slow_update() refines around the tool (adaptive_surface.hpp), or in the full tree if that
//          surface does not contain the search radius. The force is the same; regime() tells which one was used. In
//          chr the fidelity also sets the radius of full detail, AdaptiveToolSurface::kLeastM to kMostM beyond the
//          tool's.
// Bodies   one, the proxy, held; orders are refused (except the filter's form in mode chr).
// Clutch   held, the force fades out; released, the proxy returns to the tool and the force fades in.
// Reset    puts the proxy at the tool, or outside if the tool is inside a closed surface; the force fades in.
// Frames   tool and wrench in world, the surface in model; SceneMeta converts.
// Thread   constructed anywhere (may throw StartupError); then servo, except slow_update(). No allocation.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "rt/force/force_fade.hpp"
#include "rt/force/force_model.hpp"
#include "rt/force/surface/adaptive_tool_surface.hpp"
#include "rt/force/surface/contact.hpp"
#include "rt/force/surface/contact_force.hpp"
#include "rt/force/surface/lag_record.hpp"
#include "rt/force/surface/shading.hpp"
#include "rt/force/surface/stick_slip.hpp"
#include "rt/force/surface/surface_touch.hpp"
#include "rt/force/surface/triple_buffer.hpp"

namespace tact {

enum class SurfaceMode : std::uint8_t { off_brute, off_tree, chr };
inline constexpr std::array kSurfaceModeNames{"off-brute", "off-tree", "chr"};

// In the hand's world.
struct SurfaceSettings {
    double radius_m = 0.0;  // of the tool; 0: a point, modelled as a ball of radius kPointM
    double stiffness_n_m = 500.0;
    double damping_n_s_m = 0.5;
    double friction = 0.2;                     // static coefficient
    std::optional<double> dynamic_friction{};  // of a tool that slides; none: equal to the static one
    bool shading = true;
    double force_n_max = 12.0;
    SurfaceMode mode = SurfaceMode::off_tree;
};

// Fails by StartupError if a setting is out of range.
void check_surface_settings(const SurfaceSettings& settings);

class SurfaceModel final : public ForceModel {
public:
    static constexpr const char* kKnobPath = "surface.force";
    static constexpr float kLeastLevel = 0.05F;
    static constexpr double kPointM = 4e-6;
    static constexpr double kDampedDepthM = 5e-4;
    static constexpr double kLagN =
        0.05;  // allowed change of the force per step beyond that caused by the hand
    static constexpr double kLostLimits = 2.0;
    static constexpr std::uint32_t kMovesLeast = 4, kMovesMost = SurfaceContact::kMovesMost;

    // The memory behind mesh and forest must outlive the model. Only mode chr needs the forest.
    SurfaceModel(const SceneMeta& meta, const SurfaceMesh& mesh, const SurfaceSettings& settings,
                 const VertexForest* forest = nullptr);

    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override;
    // Triangles expected around the tool in mode chr, else moves.
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] static std::uint32_t moves(float fidelity) noexcept TACT_RT;
    [[nodiscard]] ModelStiffness stiffness() const noexcept TACT_RT override {
        return {.force_n_m = settings_.stiffness_n_m};
    }
    void reset(const ToolState& tool) noexcept TACT_RT override;
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override;
    [[nodiscard]] SurfaceTouch touch() const noexcept TACT_RT;
    // Sets the topic to which publish() writes touch(); call it before the first step. Default: none.
    void publish_to(Latest<TouchTopic>& topic) { topic_ = &topic; }
    void publish(const ModelCycle& cycle) noexcept TACT_RT override;

    [[nodiscard]] const SceneMeta& meta() const { return meta_; }
    [[nodiscard]] const Contact& contact() const { return contact_; }  // of the last step
    // The normal of the last step's force times its length per stiffness, in world metres: the axis of the friction cone.
    [[nodiscard]] const Vec3& push_world_m() const { return force_.push_m(); }
    // Difference of the last step's force from full shading without pace.
    [[nodiscard]] double shading_loss_n() const { return force_.off_n(); }
    [[nodiscard]] bool slides() const noexcept { return stick_slip_.slides(); }  // after the last step
    [[nodiscard]] std::uint64_t lagging_steps() const { return lagging_; }       // since construction

    [[nodiscard]] std::uint64_t released() const { return released_; }

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
    // Mode chr only.
    [[nodiscard]] const RefineStep& refined() const { return adaptive_->refined(); }
    [[nodiscard]] const AdaptiveSurface* adaptive() const {
        return adaptive_ == nullptr ? nullptr : &adaptive_->surface();
    }

private:
    // moved_model_m: displacement of the tool since the last step. The gain of the fade is included.
    [[nodiscard]] Vec3 force_n(const ToolState& tool, const Vec3& moved_model_m) noexcept TACT_RT;
    void choose_surface(const Vec3& goal_m, float fidelity) noexcept TACT_RT;
    void use_full_surface() noexcept TACT_RT;
    void note_lag() noexcept TACT_RT;

    SceneMeta meta_;
    SurfaceSettings settings_;
    SurfaceContact solver_;
    Contact contact_;
    ForceFade fade_;
    ShadedFacet shaded_;
    ContactForce force_;
    StickSlip stick_slip_;
    LagRecord lag_;
    double depth_m_ = 0.0;  // from the tool to the proxy in the last step, model metres
    bool lagged_ = false;   // since the proxy was last free
    bool asked_ = false;    // reset() was called
    bool seated_ = false;   // the proxy has a valid position
    std::uint64_t grips_ = 0;
    std::uint64_t lagging_ = 0, released_ = 0;
    SurfaceMesh full_;
    std::unique_ptr<AdaptiveToolSurface> adaptive_;
    TouchRegime regime_ = TouchRegime::tree;
    Latest<TouchTopic>* topic_ = nullptr;
    std::uint64_t used_ = 0;  // version of the adaptive surface; 0: the full one
};

// Fails by StartupError if the scene is not a surface or a setting is out of range. The scene must outlive the model.
std::unique_ptr<SurfaceModel> load_surface_model(const SceneFile& scene, const SurfaceSettings& settings);

}  // namespace tact
