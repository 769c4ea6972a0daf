// Poses of the scene's bodies (docking: atomic structures in the map), every servo cycle.
//
// A body is one placed copy of a structure of the scene. Its id is permanent; its index in the list changes
// when bodies are added and removed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kBodiesMax = 16;
inline constexpr std::uint32_t kNoBody = 0xFFFFFFFFU;  // value of `active`: no body in the hand

enum BodyFlag : std::uint16_t {
    kBodyFixed = 1U << 0,  // the hand does not move it
};

// Contributions to the force besides the density itself.
enum DockingOption : std::uint32_t {
    kDockingClash = 1U << 0,        // repulsion between bodies
    kDockingSubtraction = 1U << 1,  // subtracts the density explained by the other bodies
    kDockingLaplacian = 1U << 2,    // uses the Laplacian-filtered map
    kDockingPull = 1U << 3,         // pulls towards places that a search found
    kDockingFlexible = 1U << 4,     // the body in the hand bends along its normal modes
    kDockingTogether = 1U << 5,     // its copies that are not fixed move as it does, each in its own axes
};

struct BodyPlace {
    double pos_model_m[3];  // of the centre of mass
    double quat_model_body_xyzw[4];
    std::uint32_t id;         // from 1, never reused
    std::uint16_t structure;  // index of its BODY section in the scene
    std::uint16_t flags;      // BodyFlag
};
static_assert(sizeof(BodyPlace) == 64);

struct alignas(64) BodiesTopic {
    static constexpr TopicInfo kInfo{.name = "bodies", .version = 3, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::uint32_t count;
    std::uint32_t active;      // index of the body in the hand, or kNoBody
    std::uint64_t grips;       // rises when the hand grips: start of a gesture
    std::uint64_t placements;  // rises when a command places, adds or removes a body
    std::uint32_t options;     // DockingOption in use
    std::uint32_t building;    // 1: a new model is being built in the background
    std::uint32_t places;      // found for the body in the hand; the controller knows them
    std::uint32_t place;       // the one that it leans to, from 0, in the order of the commands
    float pull_n;              // size of the pull; 0: off
    std::uint8_t reserved[4];  // zero
    BodyPlace body[kBodiesMax];
};
static_assert(std::is_trivially_copyable_v<BodiesTopic> && sizeof(BodiesTopic) == 1088);

}  // namespace tact
