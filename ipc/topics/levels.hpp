// Levels set by the governor, one per path. The visual process applies them within a frame.
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
    std::uint32_t items;         // vertices or points that this level asks for
    std::uint32_t items_max;     // at level 1
    double cost_s;               // measured, last window
    double error;                // unit of the path
    std::uint8_t reason;         // LevelReason of the last change
    std::uint8_t haptic;         // 0 or 1
    std::uint8_t reserved[2];    // zero
    std::uint32_t drawn;         // of a visual path, the items of the newest frame; a view at rest shows all
    std::int64_t changed_at_ns;  // the level's last change; 0: never
};
static_assert(sizeof(PathLevel) == 72);

struct alignas(64) LevelsTopic {
    static constexpr TopicInfo kInfo{.name = "levels", .version = 4, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::uint64_t sequence;  // rises with every change
    double goal_hz;
    double rate_hz;         // last rate that the law used
    char law[kLawNameMax];  // "elastic", "sensitus", "fixed"; ends with 0
    std::uint32_t count;
    float display_goal_hz;      // frames per second; 0: none
    std::uint32_t reserved[2];  // zero
    PathLevel path[kPathsMax];
};
static_assert(std::is_trivially_copyable_v<LevelsTopic> && sizeof(LevelsTopic) == 640);

// Fixed indices in LevelsTopic::path.
inline constexpr std::size_t kDisplayPathIndex = 0, kForcePathIndex = 1;
// In bone scenes.
inline constexpr std::size_t kParticlesPathIndex = 2;

// The path of the rendering: vertices of a surface, or rays through bone.
inline constexpr char kMeshPath[] = "gui.mesh", kVolumePath[] = "gui.volume";
inline constexpr char kParticlesPath[] = "gui.particles";
// Triangles of the structures; pixels of the 3D view.
inline constexpr char kMoleculesPath[] = "gui.molecules", kResolutionPath[] = "gui.resolution";
inline constexpr char kDockingPath[] = "docking.force";

}  // namespace tact
