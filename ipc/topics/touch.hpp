// Where the hand would be and where its proxy is, on a surface that is touched, every servo cycle.
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
    settled,  // the proxy is as near to the hand as the surface lets it
    gliding,  // on its way there, as far as one cycle may take it
    lagging,  // the time of the cycle was not enough
};

// What the force was computed on.
enum class TouchRegime : std::uint8_t {
    tree,      // the tree over the full mesh
    adaptive,  // a surface kept fine around the tool, here as in the full mesh
    brute,     // every triangle
};

// How the detail falls off beyond the radius in which it is full.
enum class DetailShape : std::uint8_t { bell, multiple_frustum };

struct alignas(64) TouchTopic {
    static constexpr TopicInfo kInfo{.name = "touch", .version = 2, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    double probe_model_m[3];   // the tool as the hand holds it, maybe inside the surface
    double proxy_model_m[3];   // as the surface lets it
    double radius_model_m;     // of the tool; 0: a point
    float normal_model[3][3];  // of what holds the proxy, unit, towards it
    float push_n[3];           // its share in the force, before friction and damping
    std::uint32_t planes;      // how many of the three hold; 0: it is free
    TouchState state;
    TouchRegime regime;
    // Of the surface kept fine around the tool, where there is one.
    std::uint8_t detail;  // 0: none, and what follows is zero; 1: there; 2: and full within the radius
    DetailShape detail_shape;
    float detail_radius_model_m;  // of full detail
    float detail_width;           // over which it falls off, in radii
    float detail_error_far;       // allowed far away, in radii
    float deviation_model_m;      // of the surface beyond the radius from the full mesh, at the most
    std::uint32_t detail_vertices, detail_triangles;  // active
    std::uint32_t near_triangles;                     // expected around the tool at this level
    float turn_s, turn_predicted_s;  // of the thread that keeps it: as it is lately, and as predicted
    std::uint8_t reserved[28];       // zero
};
static_assert(std::is_trivially_copyable_v<TouchTopic> && sizeof(TouchTopic) == 192);
static_assert(offsetof(TouchTopic, normal_model) == 72);

}  // namespace tact
