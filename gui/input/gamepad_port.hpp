// The gamepads of this machine, through GLFW.
//
// Chosen   the first joystick that GLFW has a gamepad mapping for; $SDL_GAMECONTROLLERCONFIG adds mappings, in SDL's form
// Rights   GLFW reads /dev/input/event*, which a desktop session grants to the person who sits at it
// Thread   that of the window, after glfwInit(); does not wait
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tact {

struct GamepadState {
    bool connected = false;  // a gamepad
    bool unknown = false;    // only a joystick without a mapping
    std::string name;        // of either, printable, at most kNameMost characters
    static constexpr std::size_t kNameMost = 60;
    // -1 to 1: left stick x right and y down, right stick, left and right trigger (-1: released); numbered as GLFW_GAMEPAD_AXIS_...
    std::array<float, 6> axes{0.0F, 0.0F, 0.0F, 0.0F, -1.0F, -1.0F};
    std::uint32_t buttons = 0;  // a bit each, numbered as GLFW_GAMEPAD_BUTTON_...
};

class GamepadPort {
public:
    GamepadPort() = default;
    virtual ~GamepadPort() = default;
    GamepadPort(const GamepadPort&) = delete;
    GamepadPort& operator=(const GamepadPort&) = delete;
    virtual void read(GamepadState& state) = 0;
};

class GlfwGamepadPort final : public GamepadPort {
public:
    static constexpr std::size_t kMappingsMost = 65536;  // characters
    GlfwGamepadPort();
    void read(GamepadState& state) override;
};

}  // namespace tact
