// Reasons to refuse a frame of the tracker, and a counter for each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tact {

enum class Refusal : std::uint8_t {
    none,
    unknown_id,    // not of this tracker, or of an unconfigured sensor
    wrong_length,  // or an extended identifier, a remote request, the other kind of frame
    crc,
    malformed,       // a value outside the layout
    repeated,        // a counter that was received already
    jump,            // a counter too far from the last; counting continues from it
    no_sync,         // of a period that was not opened or was refused
    half,            // the other half of the pair is missing
    tracker_status,  // the tracker reports that it is not ready
    sensor_status,   // the sensor reports an invalid pose
    out_of_range,    // beyond the reach of the tracker
    norm,            // a quaternion far from unit length
    stale,           // older than three periods on arrival, or not newer than the last sample
    count_
};

inline constexpr std::size_t kRefusals = static_cast<std::size_t>(Refusal::count_);

[[nodiscard]] constexpr const char* refusal_name(Refusal r) noexcept {
    constexpr std::array<const char*, kRefusals> kNames{
        "none",          "unknown id",   "wrong length", "checksum", "malformed",
        "repeated",      "counter jump", "no sync",      "half",     "tracker status",
        "sensor status", "out of range", "norm",         "stale"};
    return kNames[static_cast<std::size_t>(r) < kRefusals ? static_cast<std::size_t>(r) : 0];
}

struct RefusalCounts {
    std::array<std::uint64_t, kRefusals> of{};

    void add(Refusal r) noexcept { ++of[static_cast<std::size_t>(r)]; }
    [[nodiscard]] std::uint64_t operator[](Refusal r) const noexcept {
        return of[static_cast<std::size_t>(r)];
    }
    [[nodiscard]] std::uint64_t total() const noexcept {
        std::uint64_t sum = 0;
        for (std::size_t i = 1; i < kRefusals; ++i) sum += of[i];
        return sum;
    }
};

}  // namespace tact
