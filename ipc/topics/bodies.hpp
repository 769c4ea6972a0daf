// Where the bodies of the scene are (docking: atomic structures in the map), every servo cycle.
//
// A body is one placed copy of a structure of the scene. Its id stays with it; its place in the list does
// not, as bodies are added and removed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kBodiesMax = 16;
inline constexpr std::uint32_t kNoBody = 0xFFFFFFFFU;  // as active: the hand holds none

enum BodyFlag : std::uint16_t {
    kBodyFixed = 1U << 0,  // the hand does not move it
};

// What the force is made of besides the density itself.
enum DockingOption : std::uint32_t {
    kDockingClash = 1U << 0,        // bodies push each other apart
    kDockingSubtraction = 1U << 1,  // the density that the other bodies explain is taken away
    kDockingLaplacian = 1U << 2,    // the Laplacian-filtered map is felt
};

struct BodyPlace {
    double pos_model_m[3];  // of the centre of mass
    double quat_model_body_xyzw[4];
    std::uint32_t id;         // from 1, never used again
    std::uint16_t structure;  // index of its BODY section in the scene
    std::uint16_t flags;      // BodyFlag
};
static_assert(sizeof(BodyPlace) == 64);

struct alignas(64) BodiesTopic {
    static constexpr TopicInfo kInfo{.name = "bodies", .version = 2, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::uint32_t count;
    std::uint32_t active;       // index of the one in the hand, or kNoBody
    std::uint64_t grips;        // rises whenever the hand takes hold: a gesture begins
    std::uint64_t placements;   // rises whenever a command put a body somewhere, added or removed one
    std::uint32_t options;      // DockingOption, as felt now
    std::uint32_t building;     // 1: another model is being built aside; the one felt is the one before
    std::uint8_t reserved[16];  // zero
    BodyPlace body[kBodiesMax];
};
static_assert(std::is_trivially_copyable_v<BodiesTopic> && sizeof(BodiesTopic) == 1088);

}  // namespace tact
