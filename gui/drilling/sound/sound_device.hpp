// Plays a voice on the computer's sound device (SDL: PulseAudio, PipeWire or ALSA).
//
// Opening    on a thread of its own: a server may take its time. Without a device there is no sound, and state() says why.
// Muted      the device is paused
// Thread     constructed, used and destroyed on one; the voice's fill() runs on SDL's
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include "gui/drilling/sound/drill_voice.hpp"

namespace tact {

class SoundDevice {
public:
    enum class State : int { opening, plays, none };

    explicit SoundDevice(DrillVoice& voice);
    ~SoundDevice();
    SoundDevice(const SoundDevice&) = delete;
    SoundDevice& operator=(const SoundDevice&) = delete;

    [[nodiscard]] State state() const noexcept { return state_.load(std::memory_order_acquire); }
    [[nodiscard]] std::string problem() const;  // why there is none
    void mute(bool muted);

private:
    void open();

    DrillVoice& voice_;
    std::atomic<State> state_{State::opening};
    mutable std::mutex mutex_;
    std::string problem_;
    bool muted_ = false;
    std::uint32_t device_ = 0;  // SDL_AudioDeviceID
    std::thread opener_;
};

}  // namespace tact
