// Timing of the visual process: recent frames and the whole run, its passes and paths, its memory.
//
// Writer   tact-gui twice per second, as "frames"; tact-rt passes plausible values on as "picture" to all
//          observers
// Late     a frame that started more than half a period after its due time. The period is the longest of
//          those of the display, the highest requested rate, and the governor's target frame rate
// Work     wall-clock time of the frame thread, begin to end of a pass
// Drawn    time of the renderer itself. A graphics card measures it, read some frames later. A software
//          renderer draws tile by tile when a frame is complete, so no pass has its own time: one frame in
//          kFinishEvery is finished pass by pass, and only these are counted. Below 0: unknown
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

enum class Pass : std::uint8_t {
    ground,      // background
    adapt,       // applies levels, uploads changes
    structures,  // bodies, and tools in the hand
    bone,
    surface,  // and contours
    marks,    // codebook, box, forces, hands
    motion,   // of particles
    particles,
    edges,   // smoothed
    stereo,  // combination of both eyes
    dashboard,
    swap,  // or waiting for the frame
    count
};
inline constexpr std::size_t kPasses = static_cast<std::size_t>(Pass::count);
[[nodiscard]] const char* pass_text(Pass pass) noexcept;

// In the order of kVisualPaths in ipc/topics/frames.cpp: gui.mesh, gui.volume, gui.particles.
inline constexpr std::size_t kVisualPaths = 3;
[[nodiscard]] const char* visual_path_text(std::size_t path) noexcept;  // "" for a larger index

inline constexpr std::uint32_t kFinishEvery = 128;

struct PassMetrics {
    float work_p50_s, work_p99_s;    // of recent frames
    float drawn_p50_s, drawn_p99_s;  // below 0: unknown
};

struct FrameMetrics {
    std::uint64_t frames, late;  // since its start
    double due_s;                // 0: no frame is late
    // Start to start.
    float p50_s, p99_s, most_s;              // of recent frames
    float run_p50_s, run_p99_s, run_most_s;  // of all frames; rounded up by at most 6 %
    std::uint32_t window;                    // number of recent frames
    std::uint32_t gl_objects;                // allocated: buffers, textures, images
    std::uint64_t heap_bytes, resident_bytes;
    PassMetrics pass[kPasses];
    PassMetrics path[kVisualPaths];  // cost of each path, summed over its passes
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

// True if all numbers are finite, ordered and within range. Both sides check before use.
[[nodiscard]] bool plausible(const FrameMetrics& metrics) noexcept;

}  // namespace tact
