#include "gui/input/gamepad_port.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace tact {
namespace {

// The name comes from the device.
std::string gamepad_name(const char* text) {
    std::string name = text != nullptr ? text : "";
    name.resize(std::min(name.size(), GamepadState::kNameMost));
    for (char& c : name)
        if (c < ' ' || c > '~') c = '?';
    return name;
}

}  // namespace

GlfwGamepadPort::GlfwGamepadPort() {
    const char* const mappings = std::getenv("SDL_GAMECONTROLLERCONFIG");
    if (mappings != nullptr && std::strlen(mappings) <= kMappingsMost) glfwUpdateGamepadMappings(mappings);
}

void GlfwGamepadPort::read(GamepadState& state) {
    state = {};
    for (int i = GLFW_JOYSTICK_1; i <= GLFW_JOYSTICK_LAST; ++i) {
        if (glfwJoystickPresent(i) != GLFW_TRUE) continue;
        GLFWgamepadstate now;
        if (glfwJoystickIsGamepad(i) != GLFW_TRUE || glfwGetGamepadState(i, &now) != GLFW_TRUE) {
            if (!state.unknown) state.name = gamepad_name(glfwGetJoystickName(i));
            state.unknown = true;
            continue;
        }
        state.connected = true;
        state.unknown = false;
        state.name = gamepad_name(glfwGetGamepadName(i));
        std::copy_n(std::begin(now.axes), state.axes.size(), state.axes.begin());
        for (std::size_t b = 0; b <= GLFW_GAMEPAD_BUTTON_LAST; ++b)
            if (now.buttons[b] == GLFW_PRESS) state.buttons |= 1U << b;
        return;
    }
}

}  // namespace tact
