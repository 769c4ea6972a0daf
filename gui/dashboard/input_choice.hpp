// The user's choice of what a SpaceMouse and a gamepad do, and how they respond.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tact {

enum class InputRole : std::uint8_t { off, camera, hand };
inline constexpr std::array kInputRoleNames{"off", "camera", "hand"};

// Numbered as LeadDevice (ipc/topics/mouse.hpp), without the mouse.
inline constexpr std::size_t kInputDevices = 2;
inline constexpr std::array<const char*, kInputDevices> kInputNames{"SpaceMouse", "Gamepad"};
inline constexpr std::array<const char*, kInputDevices> kInputNouns{"SpaceMouse",
                                                                    "gamepad"};  // in a sentence

struct InputChoice {
    static constexpr double kSpeedLeast = 0.1, kSpeedMost = 5.0;
    static constexpr double kDeadZoneLeast = 0.02, kDeadZoneMost = 0.5;
    static constexpr double kCurveLeast = 1.0, kCurveMost = 4.0;
    int role = static_cast<int>(InputRole::camera);
    double speed = 1.0;       // factor
    double dead_zone = 0.08;  // of full deflection, for each axis
    double curve = 2.0;       // exponent of the deflection beyond the dead zone; 1: proportional
    [[nodiscard]] bool is(InputRole other) const { return role == static_cast<int>(other); }
    friend bool operator==(const InputChoice&, const InputChoice&) = default;
};

// A gamepad's sticks rest less precisely.
inline constexpr std::array<InputChoice, kInputDevices> kInputDefaults{InputChoice{},
                                                                       InputChoice{.dead_zone = 0.15}};

}  // namespace tact
