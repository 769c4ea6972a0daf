// The contact data that a surface model publishes, and its conversion to the topic.
//
// Frame   model, metres
#pragma once

#include <array>
#include <cstdint>

#include "ipc/base/pose.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/shm/latest.hpp"
#include "ipc/topics/touch.hpp"
#include "rt/force/force_model.hpp"

namespace tact {

// Detail of the surface around the tool; only valid for models that refine it.
struct SurfaceDetail {
    bool valid = false;
    bool full = false;                      // full detail within the radius
    double radius_m = 0.0;                  // of full detail
    DetailShape shape = DetailShape::bell;  // of the filter beyond it
    float width = 0.0F, error_far = 0.0F;   // of the filter, in radii
    double deviation_m = 0.0;  // bound for the coarse part outside the radius, from the full mesh
    std::uint32_t vertices = 0, triangles = 0;  // active
    std::uint32_t near_triangles = 0;           // expected around the tool
    // Duration of a slow update, filtered, and its prediction for the level.
    double turn_s = 0.0, turn_predicted_s = 0.0;
};

struct SurfaceTouch {
    Vec3 probe_m = Vec3::Zero(), proxy_m = Vec3::Zero();
    double radius_m = 0.0;
    std::uint32_t planes = 0;                  // number of active contacts
    std::array<Vec3, kTouchPlanesMax> normal;  // unit, towards the proxy
    std::array<double, kTouchPlanesMax> push_n{};
    TouchState state = TouchState::settled;
    TouchRegime regime = TouchRegime::tree;
    SurfaceDetail detail;
};

[[nodiscard]] TouchTopic touch_topic(const SurfaceTouch& touch, const ModelCycle& cycle) noexcept TACT_RT;

}  // namespace tact
