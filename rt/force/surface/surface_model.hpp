// Touching a triangle mesh with a point or a ball.
//
// Force    k times the way from the tool to the proxy (contact.hpp), which no triangle lets through. Without
//          friction that is the slope of the energy k/2 way^2, so a closed path gains nothing; friction and
//          damping only take. Force shading turns the part of each touched triangle to the normal that is
//          interpolated between its corners, where that is within some 30 degrees of the triangle's own: a
//          smooth surface feels smooth, an edge stays one.
// Damping  along the force, in proportion to the depth up to kDampedDepthM; it never pulls. A spring of k held
//          in steps of T asks the hand for a damping of k T/2 (Colgate 1997), and this one takes its own on
//          top: k T/2 + b has to stay below what hand and arm have. By default 0.75 N s/m at 1 kHz.
// Limit    force_n_max. Where the proxy cannot keep up the force is k times the way as far as it got, so
//          limited; that is out_of_time, counted, with twice that force as its error bound. Where it is left
//          behind by more than kLostLimits times the way at that limit, it is released: that force fades out,
//          the proxy is seated as after a reset, and the force fades in.
// Knob     "surface.force": the most moves of the proxy in a step, 4 to 24. A proxy that needs more lags, and catches up in
//          later steps; most steps need two (README.md), so most of the time no level differs from another. predict()
//          says what the last half second needed, and how far fewer moves would have lagged (lag_record.hpp).
// Modes    off_brute: every triangle, every step; off_tree: those that the tree over the full mesh finds; chr: those
//          of a surface kept fine around the tool by slow_update() (adaptive_surface.hpp), and where that does not hold
//          what a step may look at, the tree: the same force, said in regime(). Fidelity is then also the
//          radius of full detail, AdaptiveToolSurface::kLeastM to kMostM beyond the tool's.
// Bodies   one, the proxy, in the hand; orders are refused.
// Clutch   held, the force fades out; released, the proxy is at the tool again and the force fades in.
// Reset    the proxy is at the tool, or outside where that is inside a closed surface; the force fades in.
// Frames   tool and wrench in world, the surface in model; SceneMeta maps one to the other.
// Thread   constructed anywhere (may throw StartupError); then servo, but for slow_update(). No allocation.
#pragma once

#include <array>
#include <memory>

#include "ipc/scene/file/scene_file.hpp"
#include "ipc/scene/file/scene_meta.hpp"
#include "ipc/scene/mesh/surface_mesh.hpp"
#include "rt/force/force_fade.hpp"
#include "rt/force/force_model.hpp"
#include "rt/force/surface/adaptive_tool_surface.hpp"
#include "rt/force/surface/contact.hpp"
#include "rt/force/surface/lag_record.hpp"
#include "rt/force/surface/shading.hpp"
#include "rt/force/surface/surface_touch.hpp"
#include "rt/force/surface/triple_buffer.hpp"

namespace tact {

enum class SurfaceMode : std::uint8_t { off_brute, off_tree, chr };
inline constexpr std::array kSurfaceModeNames{"off-brute", "off-tree", "chr"};

// In the hand's world.
struct SurfaceSettings {
    double radius_m = 0.0;  // of the tool; a point is felt as a ball of kPointM
    double stiffness_n_m = 500.0;
    double damping_n_s_m = 0.5;
    double friction = 0.2;
    bool shading = true;
    double force_n_max = 12.0;
    SurfaceMode mode = SurfaceMode::off_tree;
};

// Fails by StartupError where one is out of range.
void check_surface_settings(const SurfaceSettings& settings);

class SurfaceModel final : public ForceModel {
public:
    static constexpr const char* kKnobPath = "surface.force";
    static constexpr float kLeastLevel = 0.05F;
    static constexpr double kPointM = 4e-6;
    static constexpr double kDampedDepthM = 5e-4;
    static constexpr double kLagN = 0.05;  // what a step may change the force by, besides what the hand did
    static constexpr double kLostLimits = 2.0;
    static constexpr std::uint32_t kMovesLeast = 4, kMovesMost = SurfaceContact::kMovesMost;

    // The bytes behind mesh and forest must outlive the model. The forest is there for mode chr alone.
    SurfaceModel(const SceneMeta& meta, const SurfaceMesh& mesh, const SurfaceSettings& settings,
                 const VertexForest* forest = nullptr);

    [[nodiscard]] KnobSpec knob() const noexcept TACT_RT override;
    // Triangles expected around the tool in mode chr, else moves.
    [[nodiscard]] std::uint32_t items(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] PathLoad predict(float fidelity) const noexcept TACT_RT override;
    [[nodiscard]] static std::uint32_t moves(float fidelity) noexcept TACT_RT;
    [[nodiscard]] double stiffness_n_m() const noexcept TACT_RT override { return settings_.stiffness_n_m; }
    void reset(const ToolState& tool) noexcept TACT_RT override;
    StepResult step(const ToolState& tool, const Budget& budget) noexcept TACT_RT override;
    [[nodiscard]] ModelBodies bodies() const noexcept TACT_RT override;
    [[nodiscard]] SurfaceTouch touch() const noexcept TACT_RT;
    // Where touch() is published each cycle; before the first step. Nowhere: the default.
    void publish_to(Latest<TouchTopic>& topic) { topic_ = &topic; }
    void publish(const ModelCycle& cycle) noexcept TACT_RT override;

    [[nodiscard]] const SceneMeta& meta() const { return meta_; }
    [[nodiscard]] const Contact& contact() const { return contact_; }       // of the last step
    [[nodiscard]] std::uint64_t lagging_steps() const { return lagging_; }  // since it was made

    [[nodiscard]] std::uint64_t released() const { return released_; }

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
    // Of mode chr.
    [[nodiscard]] const RefineStep& refined() const { return adaptive_->refined(); }
    [[nodiscard]] const AdaptiveSurface* adaptive() const {
        return adaptive_ == nullptr ? nullptr : &adaptive_->surface();
    }

private:
    // gone_m: by the tool since the last step, in the model.
    void forget_lag(double gone_m, double depth_m) noexcept TACT_RT;
    [[nodiscard]] Vec3 force_n(const ToolState& tool, const Vec3& goal_model_m,
                               double gone_m) noexcept TACT_RT;
    void choose_surface(const Vec3& goal_m, float fidelity) noexcept TACT_RT;
    void use_full_surface() noexcept TACT_RT;

    SceneMeta meta_;
    SurfaceSettings settings_;
    SurfaceContact solver_;
    Contact contact_;
    ForceFade fade_;
    PacedTurn<Vec3> turn_;  // by shading
    LagRecord lag_;
    double lagged_ = 0.0;  // what is left of the last lag, 1 to 0
    bool asked_ = false;   // reset() was called
    bool seated_ = false;  // the proxy is where a tool was
    std::uint64_t grips_ = 0;
    std::uint64_t lagging_ = 0, released_ = 0;
    SurfaceMesh full_;
    std::unique_ptr<AdaptiveToolSurface> adaptive_;
    TouchRegime regime_ = TouchRegime::tree;
    Latest<TouchTopic>* topic_ = nullptr;
    std::uint64_t used_ = 0;  // version of the adaptive surface; 0: the full one
};

// Fails by StartupError where the scene is no surface or a setting is out of range. The scene must outlive the
// model.
std::unique_ptr<SurfaceModel> load_surface_model(const SceneFile& scene, const SurfaceSettings& settings);

}  // namespace tact
