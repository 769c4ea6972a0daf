// Where the bodies of the scene are (docking: atomic structures in the map), every servo cycle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kBodiesMax = 16;

struct BodyPlace {
    double pos_model_m[3];  // of the centre of mass
    double quat_model_body_xyzw[4];
};

struct alignas(64) BodiesTopic {
    static constexpr TopicInfo kInfo{.name = "bodies", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::uint32_t count;
    std::uint32_t active;  // the one in the hand
    BodyPlace body[kBodiesMax];
    std::uint8_t reserved[40];  // zero
};
static_assert(std::is_trivially_copyable_v<BodiesTopic> && sizeof(BodiesTopic) == 960);

}  // namespace tact
