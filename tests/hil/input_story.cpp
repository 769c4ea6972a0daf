// Reads a SpaceMouse or a gamepad as the window does and prints each change as a line, for checks/75_input.py.
//
// usage: hil_input_story spacemouse|gamepad SECONDS
#include <GLFW/glfw3.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "gui/input/gamepad.hpp"
#include "gui/input/space_mouse.hpp"

namespace {

using namespace tact;

// As of a frame of 60 Hz.
template <class Read>
void print_changes(double seconds, const Read& read) {
    const Instant begun = Monotonic::now();
    std::string before;
    while (to_s(Monotonic::now() - begun) < seconds) {
        const std::string now = read();
        if (now != before) std::printf("%s\n", now.c_str());
        std::fflush(stdout);
        before = now;
        std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
}

std::string line_of(const std::string& text, const InputSample& s) {
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, "%d|%.2f %.2f %.2f %.2f %.2f %.2f|%u|", s.present ? 1 : 0,
                  s.deflection.move.x(), s.deflection.move.y(), s.deflection.move.z(), s.deflection.turn.x(),
                  s.deflection.turn.y(), s.deflection.turn.z(), s.buttons);
    return numbers + text;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: hil_input_story spacemouse|gamepad SECONDS\n");
        return 2;
    }
    InputChoice choice;
    choice.role = static_cast<int>(InputRole::hand);
    const double seconds = std::strtod(argv[2], nullptr);
    if (std::string(argv[1]) == "spacemouse") {
        SpaceMouse mouse;
        print_changes(seconds, [&] {
            const SpaceMouseState state = mouse.take();
            return line_of(space_mouse_text(state), space_mouse_sample(state, choice));
        });
        return 0;
    }
    if (glfwInit() != GLFW_TRUE) {
        std::fprintf(stderr, "GLFW needs a display\n");
        return 1;
    }
    GlfwGamepadPort port;
    Gamepad pad(port);
    print_changes(seconds, [&] {
        glfwPollEvents();
        pad.read();
        return line_of(pad.text(), pad.sample(choice));
    });
    glfwTerminate();
    return 0;
}
