// Report of the visual process, every frame: its load, which is also its heartbeat.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"
#include "ipc/topics/frames.hpp"

namespace tact {

enum class FramePart : std::uint8_t { adapt, upload, scene, panels, swap, particles, count };

struct alignas(64) LoadTopic {
    static constexpr TopicInfo kInfo{.name = "load", .version = 3, .writer = Writer::gui};
    std::int64_t taken_at_ns;
    std::uint64_t frame;
    std::uint64_t levels_sequence;  // of the LevelsTopic that this frame applied
    double frame_s;                 // start to start
    double busy_s;                  // without waiting for the display
    double part_s[static_cast<std::size_t>(FramePart::count)];
    double cpu_s;                  // processor time of the process, since start
    double fps;                    // over the last second
    std::uint32_t vertices_drawn;  // for bone: rays through it, as in vertices_max
    std::uint32_t triangles_drawn;
    std::uint32_t vertices_max;    // of the full mesh
    std::uint32_t particles;       // existing
    std::uint32_t particle_moves;  // computed for this frame
    std::uint32_t particles_max;   // limit at level 1
    // Cost per frame of each visual path, newest measurement; 0: unknown. For gui.resolution: the time that the level can save.
    double path_s[kVisualPaths];
    std::uint32_t molecule_triangles, molecule_triangles_max;  // drawn; at level 1
    std::uint32_t pixels, pixels_max;                          // of the 3D view: rendered; at level 1
    // Not 0: this frame was not drawn at the levels. 1: the view rests and is shown in full detail. 2: something was measured.
    std::uint32_t refined;
    std::uint32_t reserved;  // zero
};
static_assert(std::is_trivially_copyable_v<LoadTopic> && sizeof(LoadTopic) == 192);

}  // namespace tact
