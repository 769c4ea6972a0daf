// What a SpaceMouse and a gamepad do, and how they respond: a panel over the view, opened by a button.
//
// Thread   frame thread, inside an ImGui frame.
#pragma once

#include <array>
#include <string>

#include "gui/dashboard/input_choice.hpp"
#include "gui/dashboard/pixel_rect.hpp"
#include "gui/dashboard/theme.hpp"

namespace tact {

struct InputState {
    struct Device {
        bool present = false;
        std::string text;  // its name, or why it is missing and the fix
    };
    bool open = false;
    bool may_lead = false;  // there is a hand that a device may lead
    std::array<InputChoice, kInputDevices> choice = kInputDefaults;
    std::array<Device, kInputDevices> device;
};

void draw_input_panel(const Theme& theme, InputState& input, const PixelRect& view);

}  // namespace tact
