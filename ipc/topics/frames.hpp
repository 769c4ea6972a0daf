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
    edges,    // smoothed
    enlarge,  // of a view with fewer pixels than the window
    stereo,   // combination of both eyes
    dashboard,
    swap,  // or waiting for the frame
    count
};
inline constexpr std::size_t kPasses = static_cast<std::size_t>(Pass::count);
[[nodiscard]] const char* pass_text(Pass pass) noexcept;

// In the order of visual_path_text().
enum class VisualPathIndex : std::uint8_t { mesh, volume, particles, molecules, resolution, count };
inline constexpr std::size_t kVisualPaths = static_cast<std::size_t>(VisualPathIndex::count);
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
    // Cost of each path, summed over its passes. Those of gui.resolution are all of the 3D view, also counted elsewhere.
    PassMetrics path[kVisualPaths];
};
static_assert(std::is_trivially_copyable_v<FrameMetrics> && sizeof(FrameMetrics) == 360);

struct alignas(64) FramesTopic {
    static constexpr TopicInfo kInfo{.name = "frames", .version = 3, .writer = Writer::gui};
    std::int64_t taken_at_ns;
    FrameMetrics metrics;
    std::uint8_t reserved[16];  // zero
};
static_assert(std::is_trivially_copyable_v<FramesTopic> && sizeof(FramesTopic) == 384);

struct alignas(64) DisplayTopic {
    static constexpr TopicInfo kInfo{.name = "picture", .version = 3, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    FrameMetrics metrics;
    std::uint8_t reserved[16];  // zero
};
static_assert(std::is_trivially_copyable_v<DisplayTopic> && sizeof(DisplayTopic) == 384);

// True if all numbers are finite, ordered and within range. Both sides check before use.
[[nodiscard]] bool plausible(const FrameMetrics& metrics) noexcept;

}  // namespace tact
