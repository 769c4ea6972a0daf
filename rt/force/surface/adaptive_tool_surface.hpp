// The adaptive surface of a model, shared between the servo, which searches it, and the slow-update thread.
//
// Servo     around() before a step, is_at() when the proxy's position is known; the other functions are for publishing
// Thread    slow_update() on the slow-update thread, all others on the servo's, TACT_RT. No allocation after construction.
// Unit      metres of the model.
#pragma once

#include <memory>

#include "rt/force/force_model.hpp"
#include "rt/force/surface/adaptive_surface.hpp"
#include "rt/force/surface/surface_touch.hpp"
#include "rt/force/surface/triple_buffer.hpp"

namespace tact {

class AdaptiveToolSurface {
public:
    // Width of full detail beyond the tool, in world metres.
    static constexpr double kLeastM = 1e-3, kMostM = 4e-3;
    // Slow updates between two computations of the deviation, which visits all active vertices.
    static constexpr std::uint32_t kDeviationEvery = 25;

    // tool_m: radius of the tool about the proxy. The memory behind mesh and forest must outlive the object.
    AdaptiveToolSurface(const SurfaceMesh& full, const VertexForest& forest, double tool_m,
                        double world_per_model);

    // True if a near surface contains the ball; near() then returns it.
    [[nodiscard]] bool around(const Vec3& centre_m, double radius_m) noexcept TACT_RT {
        return surface_.around(centre_m, radius_m);
    }
    [[nodiscard]] const NearSurface& near() const noexcept TACT_RT { return surface_.near(); }
    void is_at(const Vec3& proxy_m, float fidelity) noexcept TACT_RT;
    // Sets the filter's form. False: another order, or an invalid form.
    bool order(const ModelOrder& order) noexcept TACT_RT;
    [[nodiscard]] SurfaceDetail detail() const noexcept TACT_RT;
    [[nodiscard]] double turn_s() const noexcept TACT_RT { return news_.turn_s; }

    // velocity_m_s: of the tool; the proxy moves at most as fast.
    void slow_update(const Vec3& velocity_m_s) noexcept;
    // Result of the last slow_update(); on its thread.
    [[nodiscard]] const RefineStep& refined() const { return refined_; }
    [[nodiscard]] const AdaptiveSurface& surface() const { return surface_; }

private:
    struct Whereabouts {  // input of slow_update(), from the servo
        Vec3 proxy_m = Vec3::Zero();
        float fidelity = 1.0F;
        FilterForm form;
        bool valid = false;
    };
    struct News {  // result of slow_update(), for the servo
        RefineStep step;
        float deviation_m = 0.0F;
        float fidelity = 1.0F;
        double turn_s = 0.0;
    };
    AdaptiveSurface surface_;
    TripleBuffer<Whereabouts> whereabouts_;
    TripleBuffer<News> published_;
    FilterForm form_;  // as ordered
    News news_;        // last result read by the servo
    // On the slow-update thread:
    RefineStep refined_;
    double turn_s_ = 0.0;
    float deviation_m_ = 0.0F;
    std::uint32_t turns_ = 0;
};

// For mode chr. Fails by StartupError without a forest.
std::unique_ptr<AdaptiveToolSurface> tended_surface(const SurfaceMesh& full, const VertexForest* forest,
                                                    double tool_m, double world_per_model);

}  // namespace tact
