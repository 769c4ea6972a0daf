// Where the head is, as often as the tracker measures: filtered, with its speed, so that a reader takes it to
// the time its picture is seen. At most 50 ms ahead of taken_at_ns; a head that is not fresh stands where it
// was.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

struct alignas(64) HeadTopic {
    static constexpr TopicInfo kInfo{.name = "head", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;  // when the tracker measured
    std::uint64_t sequence;    // of the tracker's samples; 0: none yet
    double pos_screen_m[3];    // of the sensor, in the frame of the screen (tracker.position_screen_m)
    double quat_screen_head_xyzw[4];
    double velocity_screen_m_s[3];
    double angular_screen_rad_s[3];
    double quality;             // 0 to 1, as the tracker judges itself
    double distortion;          // 0 to 1
    std::uint8_t state;         // TrackerState
    std::uint8_t link;          // TrackerLink
    std::uint8_t reserved[54];  // zero
};
static_assert(std::is_trivially_copyable_v<HeadTopic> && sizeof(HeadTopic) == 192);
static_assert(offsetof(HeadTopic, velocity_screen_m_s) == 72);

// What came from the head tracker since it was opened, and what of it was wrong, ten times a second.
struct alignas(64) TrackerTopic {
    static constexpr TopicInfo kInfo{.name = "tracker", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::int64_t age_ns;        // of the newest sample; -1: none yet
    double rate_hz;             // that its maker names; 0: unknown
    std::uint64_t frames;       // taken from its bus
    std::uint64_t samples;      // whole good poses
    std::uint64_t missed;       // periods that never came
    std::uint64_t refused;      // frames and poses that were not believed
    std::uint64_t dropped;      // by the kernel
    std::uint64_t floods;       // rounds that ended with more to take
    std::uint64_t bus_errors;   // error frames
    std::uint64_t link_losses;  // times that the link went from up
    std::uint64_t reopened;
    std::uint8_t state;         // TrackerState
    std::uint8_t link;          // TrackerLink
    std::uint8_t reserved[30];  // zero
};
static_assert(std::is_trivially_copyable_v<TrackerTopic> && sizeof(TrackerTopic) == 128);

}  // namespace tact
