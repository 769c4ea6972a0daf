// The governor's word: one level per path. The visual process applies it within a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/base/knob.hpp"
#include "ipc/shm/topic.hpp"

namespace tact {

inline constexpr std::size_t kPathsMax = 8;
inline constexpr std::size_t kPathNameMax = 24;
inline constexpr std::size_t kLawNameMax = 16;

struct PathLevel {
    char path[kPathNameMax];  // "docking.force", "gui.mesh"; ends with 0
    float level;              // [floor, 1]
    float floor;
    std::uint32_t items;         // what the level means: vertices, points
    std::uint32_t items_max;     // at level 1
    double cost_s;               // measured, last window
    double error;                // unit of the path
    std::uint8_t reason;         // LevelReason of the last change
    std::uint8_t haptic;         // 0 or 1
    std::uint8_t reserved[6];    // zero
    std::int64_t changed_at_ns;  // the level's last change; 0: never
};
static_assert(sizeof(PathLevel) == 72);

struct alignas(64) LevelsTopic {
    static constexpr TopicInfo kInfo{.name = "levels", .version = 3, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t sequence;  // rises with every change
    double goal_hz;
    double rate_hz;         // what the law last saw
    char law[kLawNameMax];  // "elastic", "sensitus", "fixed"; ends with 0
    std::uint32_t count;
    float display_goal_hz;      // frames a second; 0: none
    std::uint32_t reserved[2];  // zero
    PathLevel path[kPathsMax];
};
static_assert(std::is_trivially_copyable_v<LevelsTopic> && sizeof(LevelsTopic) == 640);

// Places in LevelsTopic::path that are always theirs.
inline constexpr std::size_t kDisplayPathIndex = 0, kForcePathIndex = 1;
// And where the scene is of bone.
inline constexpr std::size_t kParticlesPathIndex = 2;

// The picture's path: of a surface its vertices, of bone the rays through it.
inline constexpr char kMeshPath[] = "gui.mesh", kVolumePath[] = "gui.volume";
inline constexpr char kParticlesPath[] = "gui.particles";
inline constexpr char kDockingPath[] = "docking.force";

}  // namespace tact
