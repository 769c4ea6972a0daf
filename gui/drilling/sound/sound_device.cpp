#include "gui/drilling/sound/sound_device.hpp"

#define SDL_MAIN_HANDLED
#include <SDL.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <filesystem>
#include <span>

namespace tact {
namespace {

constexpr int kSamples = 1024;  // 21 ms: below what an ear takes for late

void play(void* voice, Uint8* bytes, int count) {
    // SDL asks for kSamples of AUDIO_F32SYS, aligned.
    auto* const samples = reinterpret_cast<float*>(bytes);
    static_cast<DrillVoice*>(voice)->fill(
        std::span(samples, static_cast<std::size_t>(count) / sizeof(float)));
}

// ALSA's library writes lines to stderr where there is neither a card nor a server: it is not asked then.
bool something_to_ask() {
    namespace fs = std::filesystem;
    if (std::getenv("SDL_AUDIODRIVER") != nullptr || std::getenv("PULSE_SERVER") != nullptr) return true;
    std::error_code ignored;
    if (fs::exists("/dev/snd", ignored)) return true;
    const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
    return runtime != nullptr && (fs::exists(fs::path(runtime) / "pulse/native", ignored) ||
                                  fs::exists(fs::path(runtime) / "pipewire-0", ignored));
}

}  // namespace

SoundDevice::SoundDevice(DrillVoice& voice)
    : voice_(voice), opener_([this] {
          open();
          SDL_TLSCleanup();  // SDL does not see the end of a thread that it did not start
      }) {}

SoundDevice::~SoundDevice() {
    opener_.join();
    if (state() != State::plays) return;
    SDL_CloseAudioDevice(device_);
    SDL_QuitSubSystem(SDL_INIT_AUDIO);
}

void SoundDevice::open() {
    const auto fail = [this](const std::string& why) {
        {
            const std::scoped_lock lock(mutex_);
            problem_ = why;
        }
        spdlog::info("no sound: {}", why);
        state_.store(State::none, std::memory_order_release);
    };
    if (!something_to_ask()) return fail("this computer has no sound device");
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_AUDIO_DEVICE_APP_NAME, "Tact");
    if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) return fail(SDL_GetError());
    SDL_AudioSpec wanted{};
    wanted.freq = DrillVoice::kRateHz;
    wanted.format = AUDIO_F32SYS;
    wanted.channels = 1;
    wanted.samples = kSamples;
    wanted.callback = &play;
    wanted.userdata = &voice_;
    const SDL_AudioDeviceID device = SDL_OpenAudioDevice(nullptr, 0, &wanted, nullptr, 0);
    if (device == 0) {
        const std::string why = SDL_GetError();
        SDL_QuitSubSystem(SDL_INIT_AUDIO);
        return fail(why);
    }
    const std::scoped_lock lock(mutex_);
    device_ = device;
    SDL_PauseAudioDevice(device_, muted_ ? 1 : 0);
    state_.store(State::plays, std::memory_order_release);
}

std::string SoundDevice::problem() const {
    const std::scoped_lock lock(mutex_);
    return problem_;
}

void SoundDevice::mute(bool muted) {
    const std::scoped_lock lock(mutex_);
    if (muted == muted_) return;
    muted_ = muted;
    if (device_ != 0) SDL_PauseAudioDevice(device_, muted ? 1 : 0);
}

}  // namespace tact
