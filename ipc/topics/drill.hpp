// The tools in bone: motion, drive and removed bone, every servo cycle of a drilling scene.
//
// In other scenes the topic stays unwritten. Velocities and forces sent to the devices are in ToolTopic.
// Frames    model for poses; tool: origin at the centre of the head, the shaft extends along +z and rotates
//           about it
// Units     SI; tool sizes in metres of the hand's space (world). Bone in levels, 255 per voxel of solid
//           bone
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kDrillHands = 2;  // as kHandsMax

enum class DrillKind : std::uint8_t {
    none,          // this hand holds no tool or does not exist: the other fields are zero
    burr,          // rotates, cuts and irrigates
    suction_tube,  // a tube with contact force: a sphere of its radius as tip, and its shaft
};
enum class DrillShape : std::uint8_t { sphere, cylinder, cone };  // of a burr's head
enum class DrillGrit : std::uint8_t { cutting, diamond };  // of a burr's head: flutes, or grains of diamond

// Ranges of the commands for a burr and its drives.
inline constexpr double kBurrDiameterLeastM = 0.2e-3, kBurrDiameterMostM = 40e-3, kBurrLengthMostM = 40e-3;
inline constexpr double kBurrRadSMost = 2.0e5 * 2.0 * 3.14159265358979323846 / 60.0;
inline constexpr double kIrrigationM3SMost = 1e-3 / 60.0, kSuctionM3SMost = 0.2 / 60.0;

struct DrillHand {
    double pos_model_m[3];  // of the head's centre
    double quat_model_tool_xyzw[4];
    std::uint64_t removed_levels;  // by this tool, since the controller started, also in undone strokes
    float radius_m;                // of the head; for a cone, its largest radius
    float length_m;                // of a cylinder or cone, including round ends; otherwise the diameter
    float tip_radius_m;            // of a cone; otherwise the radius
    float shaft_radius_m;          // 0: none
    float shaft_length_m;          // from the head's centre, as far as it has contact force
    float burr_rad_s;              // present speed; 0: stopped
    float suction;                 // 0 to 1, fraction of the pump's maximum
    float irrigation;              // the same
    float depth;                   // h / R of the head, 0 to 2
    float elastic_n;               // elastic force of the bone, sum of magnitudes, before limits
    float force_n;                 // of the model, with friction and impact, limited
    std::uint32_t cut_levels;      // in this cycle
    DrillKind kind;
    DrillShape shape;
    DrillGrit grit;             // of a burr
    std::uint8_t reserved[13];  // zero
};
static_assert(sizeof(DrillHand) == 128 && offsetof(DrillHand, kind) == 112);

struct alignas(64) DrillTopic {
    static constexpr TopicInfo kInfo{.name = "drill", .version = 3, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t cycle;
    std::uint64_t removed_levels;   // missing from the scene's bone
    double level_m3;                // volume of solid bone per level, in the hand's space
    float burr_rad_s_most;          // with the pedal down, as set
    float irrigation_m3_s_most;     // water flow at 1
    float suction_m3_s_most;        // intake flow at 1
    std::uint32_t strokes;          // in effect, with the one under way
    std::uint16_t undoable;         // of them
    std::uint16_t redoable;         // strokes that were undone
    std::uint8_t stroke_under_way;  // 1: yes; a pause of 0.3 s ends it
    std::uint8_t exchanging;        // 1: a stroke is being undone or redone; no force, nothing is cut
    std::uint8_t
        changing_burr;  // 1: another burr was ordered and is not in the hand yet; no force, nothing is cut
    std::uint8_t reserved[9];  // zero
    DrillHand hand[kDrillHands];
};
static_assert(std::is_trivially_copyable_v<DrillTopic> && sizeof(DrillTopic) == 320);
static_assert(offsetof(DrillTopic, strokes) == 44 && offsetof(DrillTopic, hand) == 64);

}  // namespace tact
