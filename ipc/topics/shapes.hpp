// How the bodies of a docking scene are bent along their normal modes, every servo cycle.
//
// Published in scenes whose structures have modes (ipc/scene/density/normal_modes.hpp); otherwise the topic stays unwritten. A body that
// is not listed is straight.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "ipc/shm/topic.hpp"
#include "ipc/topics/bodies.hpp"

namespace tact {

inline constexpr std::size_t kShapeModesMax = 20;

struct ShapeRow {
    std::uint32_t id;                   // of the body, as in BodiesTopic; 0: unused
    float amplitude_m[kShapeModesMax];  // of each mode of its structure, zero beyond
};
static_assert(sizeof(ShapeRow) == 84);

struct alignas(64) ShapesTopic {
    static constexpr TopicInfo kInfo{.name = "shapes", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    // Of the body in the hand.
    float rmsd_m;         // from its own shape
    float strain;         // largest relative change of the distance of two neighbours along a chain
    float strain_most;    // that it may reach
    std::uint32_t bends;  // 1: it follows the density; 0: it is rigid, or returns to its own shape
    ShapeRow body[kBodiesMax];
    std::uint8_t reserved[32];  // zero
};
static_assert(std::is_trivially_copyable_v<ShapesTopic> && sizeof(ShapesTopic) == 1408);

// The amplitudes of a body, without zeros at the end; empty: it is straight.
[[nodiscard]] inline std::span<const float> amplitudes_of(const ShapesTopic& topic, std::uint32_t id) {
    for (const ShapeRow& row : topic.body) {
        if (row.id != id) continue;
        std::size_t count = kShapeModesMax;
        while (count > 0 && row.amplitude_m[count - 1] == 0.0F) --count;
        return {row.amplitude_m, count};
    }
    return {};
}

}  // namespace tact
