#include "rt/force/surface/surface_touch.hpp"

#include <algorithm>

#include "ipc/scene/mesh/refine_filter.hpp"
#include "rt/force/surface/contact.hpp"

namespace tact {

// The solver and the topic use the same numbers for the states.
static_assert(static_cast<int>(ContactState::settled) == static_cast<int>(TouchState::settled) &&
              static_cast<int>(ContactState::gliding) == static_cast<int>(TouchState::gliding) &&
              static_cast<int>(ContactState::lagging) == static_cast<int>(TouchState::lagging));
static_assert(static_cast<int>(FilterForm::Shape::bell) == static_cast<int>(DetailShape::bell) &&
              static_cast<int>(FilterForm::Shape::multiple_frustum) ==
                  static_cast<int>(DetailShape::multiple_frustum));

TouchTopic touch_topic(const SurfaceTouch& touch, const ModelCycle& cycle) noexcept {
    TouchTopic t{};
    t.taken_at_ns = to_ns(cycle.now);
    t.cycle = cycle.cycle;
    std::copy_n(touch.probe_m.data(), 3, t.probe_model_m);
    std::copy_n(touch.proxy_m.data(), 3, t.proxy_model_m);
    t.radius_model_m = touch.radius_m;
    t.planes = std::min(touch.planes, static_cast<std::uint32_t>(kTouchPlanesMax));
    for (std::uint32_t i = 0; i < t.planes; ++i) {
        for (int k = 0; k < 3; ++k) t.normal_model[i][k] = static_cast<float>(touch.normal[i][k]);
        t.push_n[i] = static_cast<float>(touch.push_n[i]);
    }
    t.state = touch.state;
    t.regime = touch.regime;
    const SurfaceDetail& d = touch.detail;
    if (!d.valid) return t;
    t.detail = d.full ? 2 : 1;
    t.detail_shape = d.shape;
    t.detail_radius_model_m = static_cast<float>(d.radius_m);
    t.detail_width = d.width;
    t.detail_error_far = d.error_far;
    t.deviation_model_m = static_cast<float>(d.deviation_m);
    t.detail_vertices = d.vertices;
    t.detail_triangles = d.triangles;
    t.near_triangles = d.near_triangles;
    t.turn_s = static_cast<float>(d.turn_s);
    t.turn_predicted_s = static_cast<float>(d.turn_predicted_s);
    return t;
}

}  // namespace tact
