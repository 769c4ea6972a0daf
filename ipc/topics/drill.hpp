// The tools in bone, what drives them and what they took, every servo cycle of a scene that is drilled.
//
// Without such a scene the topic stays unwritten. Velocities and forces as sent to the devices are in ToolTopic.
// Frames    model for places; the tool's: its head's centre is the origin, the shaft leaves along +z, about which it turns
// Units     SI; sizes of tools in metres of the hand's space (world). Bone in levels, 255 a voxel of solid bone
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kDrillHands = 2;  // as kHandsMax

enum class DrillKind : std::uint8_t {
    none,          // this hand holds no tool, or there is no such hand: the rest of it is zero
    burr,          // turns, cuts and sprays
    suction_tube,  // a tube that is felt: its tip is a ball of its radius, as its shaft
};
enum class DrillShape : std::uint8_t { sphere, cylinder, cone };  // of a burr's head

struct DrillHand {
    double pos_model_m[3];  // of the head's centre
    double quat_model_tool_xyzw[4];
    std::uint64_t removed_levels;  // by this tool, since the controller started
    float radius_m;                // of the head; of a cone, where it is widest
    float length_m;                // of a cylinder or cone, round ends included; else the diameter
    float tip_radius_m;            // of a cone; else the radius
    float shaft_radius_m;          // 0: none
    float shaft_length_m;          // from the head's centre, as far as it is felt
    float burr_rad_s;              // now; 0: it stands
    float suction;                 // 0 to 1 of what the pump can
    float irrigation;              // the same
    float depth;                   // h / R of the head, 0 to 2
    float elastic_n;               // with which the bone pushes, sum of sizes, before limits
    float force_n;                 // of the model: friction and impact too, limited
    std::uint32_t cut_levels;      // in this cycle
    DrillKind kind;
    DrillShape shape;
    std::uint8_t reserved[14];  // zero
};
static_assert(sizeof(DrillHand) == 128 && offsetof(DrillHand, kind) == 112);

struct alignas(64) DrillTopic {
    static constexpr TopicInfo kInfo{.name = "drill", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::uint64_t removed_levels;  // by all tools, since the controller started
    double level_m3;               // of solid bone that one level stands for, in the hand's space
    float burr_rad_s_most;         // with its pedal down
    float irrigation_m3_s_most;    // of water, at 1
    float suction_m3_s_most;       // of what it takes in, at 1
    std::uint8_t reserved[20];     // zero
    DrillHand hand[kDrillHands];
};
static_assert(std::is_trivially_copyable_v<DrillTopic> && sizeof(DrillTopic) == 320);
static_assert(offsetof(DrillTopic, hand) == 64);

}  // namespace tact
