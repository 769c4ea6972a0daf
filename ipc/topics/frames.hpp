// How the visual process keeps its time: frames over a while and over its run, its passes and paths, its memory.
//
// Writer   tact-gui twice a second, as "frames"; tact-rt passes on what is possible, as "picture", for all who watch it.
// Late     a frame that began more than half a period after it was due. The period is the display's, that of the highest
//          rate asked for, or that of the governor's goal for the picture: the longest of those that there are.
// Work     time of the frame thread by the clock, begin to end of a pass.
// Drawn    time of the renderer itself. A graphics card stamps it, read some frames later. Where the processor draws, tile by
//          tile when a picture is complete, no pass has a time of its own: one frame in kFinishEvery is finished pass by
//          pass, and only those are counted. Below 0: not known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

enum class Pass : std::uint8_t {
    ground,      // what is behind everything, and under the cards
    adapt,       // levels applied, what changed sent
    structures,  // bodies, and tools in hand
    bone,
    surface,  // and contours
    marks,    // codebook, box, forces, hands
    motion,   // of particles
    particles,
    edges,   // made smooth
    stereo,  // both eyes put together
    dashboard,
    swap,  // or waiting for the picture
    count
};
inline constexpr std::size_t kPasses = static_cast<std::size_t>(Pass::count);
[[nodiscard]] const char* pass_text(Pass pass) noexcept;

// In the order of kVisualPaths of ipc/topics/frames.cpp: gui.mesh, gui.volume, gui.particles.
inline constexpr std::size_t kVisualPaths = 3;
[[nodiscard]] const char* visual_path_text(std::size_t path) noexcept;  // "" beyond

inline constexpr std::uint32_t kFinishEvery = 128;

struct PassMetrics {
    float work_p50_s, work_p99_s;    // of the last frames
    float drawn_p50_s, drawn_p99_s;  // below 0: not known
};

struct FrameMetrics {
    std::uint64_t frames, late;  // since its start
    double due_s;                // 0: no frame is late
    // Start to start.
    float p50_s, p99_s, most_s;              // of the last frames
    float run_p50_s, run_p99_s, run_most_s;  // of all; rounded up by 6 % at most
    std::uint32_t window;                    // how many the last ones are
    std::uint32_t gl_objects;                // that it keeps: buffers, textures, images
    std::uint64_t heap_bytes, resident_bytes;
    PassMetrics pass[kPasses];
    PassMetrics path[kVisualPaths];  // what each path costs, of its passes together
};
static_assert(std::is_trivially_copyable_v<FrameMetrics> && sizeof(FrameMetrics) == 312);

struct alignas(64) FramesTopic {
    static constexpr TopicInfo kInfo{.name = "frames", .version = 2, .writer = Writer::gui};
    std::int64_t taken_at_ns;
    FrameMetrics metrics;
    std::uint8_t reserved[64];  // zero
};
static_assert(std::is_trivially_copyable_v<FramesTopic> && sizeof(FramesTopic) == 384);

struct alignas(64) DisplayTopic {
    static constexpr TopicInfo kInfo{.name = "picture", .version = 2, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    FrameMetrics metrics;
    std::uint8_t reserved[64];  // zero
};
static_assert(std::is_trivially_copyable_v<DisplayTopic> && sizeof(DisplayTopic) == 384);

// Numbers that can be: finite, in order, not beyond any run. Both sides ask before they use them.
[[nodiscard]] bool plausible(const FrameMetrics& metrics) noexcept;

}  // namespace tact
