// The sound of a drilling site: the burr's motor, its teeth in bone, suction, and a signal near critical structures.
//
// Burr      a tone at its turns per second and overtones; under load it is up to 15 % lower and rougher
// Teeth     noise in bursts at the rate of the cutting edges, as loud as bone goes
// Signal    short tones: two a second at 2 mm, six at 1 mm (kDrillNearM), a fifth higher
// Smooth    what is set takes effect over 30 to 80 ms, so nothing clicks
// Output    mono, within -1 to 1
// Thread    set(): one; fill(): another one. No allocation, no lock
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

namespace tact {

enum class NearSignal : std::uint8_t { none, near, close };

struct DrillSound {
    float turns_hz = 0.0F;  // of the burr; 0: it stands
    float load = 0.0F;      // 0: in air, 1: as much bone as it can take
    float suction = 0.0F;   // 0 to 1
    NearSignal signal = NearSignal::none;
};

class DrillVoice {
public:
    static constexpr int kRateHz = 48000;
    static constexpr float kLoadedPitch = 0.85F;  // of the turns, at full load
    static constexpr int kEdges = 10;             // of a burr
    static constexpr float kNearHz = 880.0F, kCloseHz = 1320.0F;
    static constexpr double kNearPerS = 2.0, kClosePerS = 6.0, kToneS = 0.06;

    // Values that are not numbers count as 0; others are limited.
    void set(const DrillSound& sound) noexcept;
    void fill(std::span<float> samples) noexcept;

private:
    // Approaches a target with a time constant.
    struct Smooth {
        float now = 0.0F;
        float next(float target, float share) noexcept { return now += share * (target - now); }
    };
    [[nodiscard]] float noise() noexcept;
    [[nodiscard]] float signal_tone(NearSignal signal) noexcept;

    std::atomic<float> turns_hz_{0.0F}, load_{0.0F}, suction_{0.0F};
    std::atomic<std::uint8_t> signal_{0};
    Smooth pitch_hz_, loud_, bone_, air_;
    float tone_hz_ = 0.0F;
    double phase_ = 0.0, tone_phase_ = 0.0, since_tone_s_ = 1e9;
    float low_ = 0.0F, band_ = 0.0F;  // of the noise
    float hiss_ = 0.0F;
    std::uint32_t seed_ = 1;
};

}  // namespace tact
