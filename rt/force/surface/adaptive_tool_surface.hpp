// The adaptive surface of a model: between its servo, which asks for triangles, and the thread of its slow update.
//
// Servo     around() before a step, is_at() after it is known where the proxy is; the rest for those who look on
// Thread    slow_update() on that one; all others the servo's, TACT_RT. No allocation after the constructor.
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
    static constexpr double kLeastM = 1e-3,
                            kMostM = 4e-3;  // of full detail beyond the tool, in the hand's world
    static constexpr std::uint32_t kDeviationEvery =
        25;  // turns of slow_update(): it looks at all that is active

    // tool_m: how far the tool reaches about the proxy's point. The bytes behind mesh and forest outlive it.
    AdaptiveToolSurface(const SurfaceMesh& full, const VertexForest& forest, double tool_m,
                        double world_per_model);

    // Whether a ball lies in what was built; then near() holds it.
    [[nodiscard]] bool around(const Vec3& centre_m, double radius_m) noexcept TACT_RT {
        return surface_.around(centre_m, radius_m);
    }
    [[nodiscard]] const NearSurface& near() const noexcept TACT_RT { return surface_.near(); }
    void is_at(const Vec3& proxy_m, float fidelity) noexcept TACT_RT;
    // The filter's form. False: it is another order, or such a form is not possible.
    bool order(const ModelOrder& order) noexcept TACT_RT;
    [[nodiscard]] SurfaceDetail detail() const noexcept TACT_RT;
    [[nodiscard]] double turn_s() const noexcept TACT_RT { return news_.turn_s; }

    // The proxy goes where the tool goes, or less far.
    void slow_update(const Vec3& velocity_m_s) noexcept;
    [[nodiscard]] const RefineStep& refined() const {
        return refined_;
    }  // by the last slow_update(); on its thread
    [[nodiscard]] const AdaptiveSurface& surface() const { return surface_; }

private:
    struct Whereabouts {  // of the proxy, for slow_update()
        Vec3 proxy_m = Vec3::Zero();
        float fidelity = 1.0F;
        FilterForm form;
        bool valid = false;
    };
    struct News {  // by slow_update()
        RefineStep step;
        float deviation_m = 0.0F;
        float fidelity = 1.0F;
        double turn_s = 0.0;
    };
    AdaptiveSurface surface_;
    TripleBuffer<Whereabouts> whereabouts_;
    TripleBuffer<News> published_;
    FilterForm form_;  // as ordered
    News news_;        // as the servo had them last
    // Of the thread of the slow update.
    RefineStep refined_;
    double turn_s_ = 0.0;
    float deviation_m_ = 0.0F;
    std::uint32_t turns_ = 0;
};

// For mode chr. Fails by StartupError where there is no forest.
std::unique_ptr<AdaptiveToolSurface> tended_surface(const SurfaceMesh& full, const VertexForest* forest,
                                                    double tool_m, double world_per_model);

}  // namespace tact
