// Head pose at the tracker's rate: filtered, with its velocity, so that a reader can predict it to the time
// of display. Predict at most 50 ms ahead of taken_at_ns; a head that is not fresh keeps its pose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ipc/shm/topic.hpp"

namespace tact {

struct alignas(64) HeadTopic {
    static constexpr TopicInfo kInfo{.name = "head", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;  // time of the tracker's measurement
    std::uint64_t sequence;    // of the tracker's samples; 0: none yet
    double pos_screen_m[3];    // of the sensor, in the frame of the screen (tracker.position_screen_m)
    double quat_screen_head_xyzw[4];
    double velocity_screen_m_s[3];
    double angular_screen_rad_s[3];
    double quality;             // 0 to 1, as the tracker reports it
    double distortion;          // 0 to 1
    std::uint8_t state;         // TrackerState
    std::uint8_t link;          // TrackerLink
    std::uint8_t reserved[54];  // zero
};
static_assert(std::is_trivially_copyable_v<HeadTopic> && sizeof(HeadTopic) == 192);
static_assert(offsetof(HeadTopic, velocity_screen_m_s) == 72);

// Counters of the head tracker since it was opened, ten times per second.
struct alignas(64) TrackerTopic {
    static constexpr TopicInfo kInfo{.name = "tracker", .version = 1, .writer = Writer::rt};
    std::int64_t taken_at_ns;
    std::int64_t age_ns;        // of the newest sample; -1: none yet
    double rate_hz;             // stated by the manufacturer; 0: unknown
    std::uint64_t frames;       // received from its bus
    std::uint64_t samples;      // complete valid poses
    std::uint64_t missed;       // sample periods without a sample
    std::uint64_t refused;      // rejected frames and poses
    std::uint64_t dropped;      // by the kernel
    std::uint64_t floods;       // reader rounds that ended with frames left
    std::uint64_t bus_errors;   // error frames
    std::uint64_t link_losses;  // times that the link left the state up
    std::uint64_t reopened;
    std::uint8_t state;         // TrackerState
    std::uint8_t link;          // TrackerLink
    std::uint8_t reserved[30];  // zero
};
static_assert(std::is_trivially_copyable_v<TrackerTopic> && sizeof(TrackerTopic) == 128);

}  // namespace tact
