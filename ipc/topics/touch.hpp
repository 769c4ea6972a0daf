// Hand and proxy position on a touched surface, every servo cycle.
//
// Published by models that touch a surface; without one the topic stays unwritten.
// Frame     model, metres
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kTouchPlanesMax = 3;

enum class TouchState : std::uint8_t {
    settled,  // the proxy is as close to the hand as the surface allows
    gliding,  // moving there, limited to one cycle's distance
    lagging,  // the cycle's time was not enough
};

// Search method of the force computation.
enum class TouchRegime : std::uint8_t {
    tree,      // the tree over the full mesh
    adaptive,  // a surface refined around the tool, where it equals the full mesh
    brute,     // every triangle
};

// Falloff of the detail beyond the radius of full detail.
enum class DetailShape : std::uint8_t { bell, multiple_frustum };

struct alignas(64) TouchTopic {
    static constexpr TopicInfo kInfo{.name = "touch", .version = 2, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    double probe_model_m[3];   // the tool at the hand's position, possibly inside the surface
    double proxy_model_m[3];   // constrained by the surface
    double radius_model_m;     // of the tool; 0: a point
    float normal_model[3][3];  // of the planes that hold the proxy, unit, towards it
    float push_n[3];           // contribution of each plane to the force, before friction and damping
    std::uint32_t planes;      // number of active planes; 0: free
    TouchState state;
    TouchRegime regime;
    // For the surface refined around the tool, if there is one.
    std::uint8_t detail;  // 0: none, the following fields are zero; 1: present; 2: and full within the radius
    DetailShape detail_shape;
    float detail_radius_model_m;  // of full detail
    float detail_width;           // width of the falloff, in radii
    float detail_error_far;       // allowed far away, in radii
    float deviation_model_m;      // largest deviation of the surface beyond the radius from the full mesh
    std::uint32_t detail_vertices, detail_triangles;  // active
    std::uint32_t near_triangles;                     // expected around the tool at this level
    float turn_s, turn_predicted_s;  // update time of the adaptive thread: recent, and predicted
    std::uint8_t reserved[28];       // zero
};
static_assert(std::is_trivially_copyable_v<TouchTopic> && sizeof(TouchTopic) == 192);
static_assert(offsetof(TouchTopic, normal_model) == 72);

}  // namespace tact
