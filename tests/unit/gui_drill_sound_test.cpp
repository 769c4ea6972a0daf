// The sound of the drill, by its spectrum: pitch, load, signals, silence; and a device that writes what it plays to a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include "gui/drilling/sound/drill_voice.hpp"
#include "gui/drilling/sound/sound_device.hpp"

namespace tact::drill_sound_test {
namespace {

using Samples = std::vector<float>;
constexpr double kRateHz = DrillVoice::kRateHz;

// In parts, as a device asks for them.
Samples play(DrillVoice& voice, double seconds) {
    Samples all(static_cast<std::size_t>(seconds * kRateHz));
    for (std::size_t at = 0; at < all.size(); at += 1024)
        voice.fill(std::span(all).subspan(at, std::min<std::size_t>(1024, all.size() - at)));
    return all;
}
double rms(std::span<const float> s) {
    double sum = 0.0;
    for (const float v : s) sum += static_cast<double>(v) * static_cast<double>(v);
    return std::sqrt(sum / static_cast<double>(s.size()));
}
// Amplitude of a tone in it.
double tone(std::span<const float> s, double hz) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i)
        sum += static_cast<double>(s[i]) *
               std::polar(1.0, -2.0 * std::numbers::pi * hz * static_cast<double>(i) / kRateHz);
    return 2.0 * std::abs(sum) / static_cast<double>(s.size());
}
// The strongest between two frequencies, in steps of 2 Hz.
double strongest_hz(std::span<const float> s, double from_hz, double to_hz) {
    double best_hz = from_hz, best = 0.0;
    for (double hz = from_hz; hz <= to_hz; hz += 2.0) {
        const double now = tone(s, hz);
        if (now > best) best = now, best_hz = hz;
    }
    return best_hz;
}

TEST(DrillVoice, is_silent_until_something_sounds_and_again_when_it_ends) {
    DrillVoice voice;
    EXPECT_EQ(rms(play(voice, 0.2)), 0.0);
    voice.set({.turns_hz = 1000.0F, .load = 0.5F, .suction = 1.0F, .signal = NearSignal::close});
    EXPECT_GT(rms(play(voice, 1.0)), 0.05);
    voice.set({});
    static_cast<void>(play(voice, 2.0));
    EXPECT_LT(rms(play(voice, 0.2)), 1e-4);
}

TEST(DrillVoice, the_pitch_is_that_of_the_burr_and_falls_under_load) {
    for (const double hz : {300.0, 1000.0, 1600.0}) {
        DrillVoice voice;
        voice.set({.turns_hz = static_cast<float>(hz)});
        static_cast<void>(play(voice, 1.0));
        EXPECT_NEAR(strongest_hz(play(voice, 0.5), 0.5 * hz, 1.3 * hz), hz, 4.0);
        voice.set({.turns_hz = static_cast<float>(hz), .load = 1.0F});
        static_cast<void>(play(voice, 1.0));
        EXPECT_NEAR(strongest_hz(play(voice, 0.5), 0.5 * hz, 1.3 * hz),
                    static_cast<double>(DrillVoice::kLoadedPitch) * hz, 6.0);
    }
}

TEST(DrillVoice, bone_and_suction_are_heard) {
    DrillVoice air, bone, sucks;
    air.set({.turns_hz = 1000.0F});
    bone.set({.turns_hz = 1000.0F, .load = 0.6F});
    sucks.set({.suction = 1.0F});
    for (DrillVoice* const v : {&air, &bone, &sucks}) static_cast<void>(play(*v, 1.0));
    // Between overtones there is noise only where bone goes.
    const auto between = [](DrillVoice& v) {
        const Samples s = play(v, 1.0);
        double sum = 0.0;
        for (double hz = 2150.0; hz < 2800.0; hz += 10.0) sum += tone(s, hz);
        return sum;
    };
    EXPECT_GT(between(bone), 20.0 * between(air));
    const double hiss = rms(play(sucks, 0.5));
    EXPECT_GT(hiss, 0.01);
    EXPECT_LT(hiss, 0.15);
}

// Tones counted by their envelope.
int tones_in(const Samples& s, double hz) {
    constexpr std::size_t kWindow = 480;  // 10 ms
    int count = 0;
    bool on = false;
    for (std::size_t at = 0; at + kWindow <= s.size(); at += kWindow) {
        const bool now = tone(std::span(s).subspan(at, kWindow), hz) > 0.1;
        count += now && !on ? 1 : 0;
        on = now;
    }
    return count;
}

TEST(DrillVoice, nearness_is_two_tones_a_second_and_then_six_higher_ones) {
    DrillVoice voice;
    voice.set({.signal = NearSignal::near});
    const Samples near = play(voice, 5.0);
    EXPECT_NEAR(tones_in(near, static_cast<double>(DrillVoice::kNearHz)), 10, 1);
    EXPECT_GT(tone(std::span(near).first(4800), static_cast<double>(DrillVoice::kNearHz)), 0.05);  // at once
    voice.set({.signal = NearSignal::close});
    EXPECT_NEAR(tones_in(play(voice, 5.0), static_cast<double>(DrillVoice::kCloseHz)), 30, 1);
}

TEST(DrillVoice, neither_hostile_numbers_nor_jumps_leave_the_range_or_click) {
    DrillVoice voice;
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const float v : {nan, inf, -inf, -1.0F, 1e30F}) {
        voice.set({v, v, v, static_cast<NearSignal>(200)});
        for (const float sample : play(voice, 0.2)) ASSERT_TRUE(std::abs(sample) <= 1.0F);
    }
    // From rest to full speed and back: no sample jumps farther than the loudest tone's slope.
    DrillVoice steady, jumps;
    steady.set({.turns_hz = 1000.0F});
    static_cast<void>(play(steady, 1.0));
    const auto largest = [](const Samples& s, float before) {
        float most = 0.0F;
        for (const float v : s) {
            most = std::max(most, std::abs(v - before));
            before = v;
        }
        return most;
    };
    const float slope = largest(play(steady, 0.5), play(steady, 0.01).back());
    float most = 0.0F, last = 0.0F;
    for (int i = 0; i < 20; ++i) {
        jumps.set({.turns_hz = i % 2 == 0 ? 1000.0F : 0.0F});
        const Samples s = play(jumps, 0.05);
        most = std::max(most, largest(s, last));
        last = s.back();
    }
    EXPECT_LE(most, 1.1F * slope + 1e-3F);
}

// SDL's driver "disk" writes what a device would play.
TEST(SoundDevice, plays_the_voice_and_stops_while_it_is_muted) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("tact-sound-" + std::to_string(::getpid()) + ".raw");
    ::setenv("SDL_AUDIODRIVER", "disk", 1);
    ::setenv("SDL_DISKAUDIOFILE", file.c_str(), 1);
    const auto bytes = [&file] {
        std::error_code none;
        return std::filesystem::exists(file, none) ? std::filesystem::file_size(file, none) : 0;
    };
    const auto wait_for = [](auto&& done) {
        for (int i = 0; i < 1000 && !done(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return done();
    };
    DrillVoice voice;
    voice.set({.turns_hz = 1000.0F});
    {
        SoundDevice device(voice);
        ASSERT_TRUE(wait_for([&] { return device.state() == SoundDevice::State::plays; }))
            << device.problem();
        ASSERT_TRUE(wait_for([&] { return bytes() > 4 * 48000; }));
        device.mute(true);  // SDL plays silence while a device is paused
        voice.set({.turns_hz = 1000.0F});
    }
    Samples played(bytes() / sizeof(float));
    std::ifstream(file, std::ios::binary)
        .read(reinterpret_cast<char*>(played.data()),
              static_cast<std::streamsize>(played.size() * sizeof(float)));
    EXPECT_NEAR(strongest_hz(std::span(played).subspan(24000, 24000), 700.0, 1300.0), 1000.0, 4.0);
    std::filesystem::remove(file);
    ::unsetenv("SDL_DISKAUDIOFILE");
}

TEST(SoundDevice, says_why_there_is_no_sound) {
    ::setenv("SDL_AUDIODRIVER", "no_such_driver", 1);
    DrillVoice voice;
    SoundDevice device(voice);
    for (int i = 0; i < 1000 && device.state() == SoundDevice::State::opening; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(device.state(), SoundDevice::State::none);
    EXPECT_NE(device.problem().find("no_such_driver"), std::string::npos) << device.problem();
    device.mute(true);
    ::unsetenv("SDL_AUDIODRIVER");
}

}  // namespace
}  // namespace tact::drill_sound_test
