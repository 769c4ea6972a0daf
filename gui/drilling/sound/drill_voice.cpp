#include "gui/drilling/sound/drill_voice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tact {
namespace {

constexpr float kTurnsMostHz = 4000.0F;
constexpr double kSampleS = 1.0 / DrillVoice::kRateHz;
constexpr float kFast = static_cast<float>(kSampleS / 0.03), kSlow = static_cast<float>(kSampleS / 0.08);
constexpr float kMotorLoud = 0.16F, kBoneLoud = 0.5F, kAirLoud = 0.10F, kToneLoud = 0.3F;
constexpr double kToneEdgeS = 0.006;  // to rise and to fall
constexpr float kQuietHz = 5.0F;      // slower than this nobody hears

float within(float value, float most) noexcept { return value > 0.0F ? std::min(value, most) : 0.0F; }

float wave(double turns) noexcept {
    return static_cast<float>(std::sin(2.0 * std::numbers::pi * (turns - std::floor(turns))));
}

}  // namespace

void DrillVoice::set(const DrillSound& sound) noexcept {
    // Relaxed: each value stands for itself.
    turns_hz_.store(within(sound.turns_hz, kTurnsMostHz), std::memory_order_relaxed);
    load_.store(within(sound.load, 1.0F), std::memory_order_relaxed);
    suction_.store(within(sound.suction, 1.0F), std::memory_order_relaxed);
    signal_.store(static_cast<std::uint8_t>(sound.signal), std::memory_order_relaxed);
}

float DrillVoice::noise() noexcept {
    seed_ = seed_ * 1664525U + 1013904223U;
    return static_cast<float>(static_cast<std::int32_t>(seed_)) * (1.0F / 2147483648.0F);
}

float DrillVoice::signal_tone(NearSignal signal) noexcept {
    since_tone_s_ += kSampleS;
    const double per_s = signal == NearSignal::close ? kClosePerS : kNearPerS;
    if (signal != NearSignal::none && since_tone_s_ >= 1.0 / per_s) {
        since_tone_s_ = 0.0;
        tone_phase_ = 0.0;
        tone_hz_ = signal == NearSignal::close ? kCloseHz : kNearHz;
    }
    if (since_tone_s_ >= kToneS) return 0.0F;  // a tone that began is sounded to its end
    tone_phase_ += static_cast<double>(tone_hz_) * kSampleS;
    const double edge = std::min({since_tone_s_, kToneS - since_tone_s_, kToneEdgeS}) / kToneEdgeS;
    return static_cast<float>(edge) * wave(tone_phase_);
}

void DrillVoice::fill(std::span<float> samples) noexcept {
    const float turns_hz = turns_hz_.load(std::memory_order_relaxed);
    const float load = load_.load(std::memory_order_relaxed);
    const float suction = suction_.load(std::memory_order_relaxed);
    const auto signal = static_cast<NearSignal>(signal_.load(std::memory_order_relaxed));
    for (float& sample : samples) {
        const float bone = bone_.next(turns_hz > 0.0F ? load : 0.0F, kFast);
        const float pitch_hz = pitch_hz_.next(turns_hz * (1.0F - (1.0F - kLoadedPitch) * bone), kSlow);
        // Louder the faster it turns: a motor that runs down is heard to.
        const float loud = loud_.next(std::sqrt(pitch_hz / 1000.0F), kFast);
        const float air = air_.next(suction, kSlow);
        const float white = noise();
        float out = signal_tone(signal) * kToneLoud;
        if (pitch_hz > kQuietHz) {
            phase_ += static_cast<double>(pitch_hz) * kSampleS;
            if (phase_ > 4096.0) phase_ -= 4096.0;
            const float motor = wave(phase_) + 0.45F * wave(2.0 * phase_) + 0.25F * wave(3.0 * phase_);
            // A resonance of bone at 2.4 kHz, struck by the edges.
            constexpr float kResonance = 0.31F, kDamping = 0.35F;
            low_ += kResonance * band_;
            band_ += kResonance * (white - low_ - kDamping * band_);
            const float edge = 0.6F + 0.4F * wave(kEdges * phase_);
            out += kMotorLoud * loud * motor * (1.0F + 0.3F * bone * white) +
                   kBoneLoud * loud * bone * edge * band_;
        }
        hiss_ += 0.25F * (white - hiss_);
        out += kAirLoud * air * (white - hiss_);
        sample = std::tanh(out);
    }
}

}  // namespace tact
