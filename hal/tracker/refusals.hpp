// Why a frame of the tracker was not believed, and how many of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tact {

enum class Refusal : std::uint8_t {
    none,
    unknown_id,    // not of this tracker, or of a sensor that is not configured
    wrong_length,  // or an extended identifier, a remote request, the other kind of frame
    crc,
    malformed,       // a value that the layout does not have
    repeated,        // a counter that was seen already
    jump,            // a counter that is too far from the last; counting goes on from it
    no_sync,         // of no period that was opened, or of a refused one
    half,            // the other half of the pair never came
    tracker_status,  // the tracker says that it is not ready
    sensor_status,   // the sensor says that its pose means nothing
    out_of_range,    // beyond the reach of the tracker
    norm,            // a quaternion far from unit length
    stale,           // older than three periods when it came, or not newer than the last sample
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
