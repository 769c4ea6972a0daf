#include "deploy/tact/probe.hpp"

namespace tact::launch {
namespace {

Finding spacenavd(const SpacenavFound& found) {
    switch (found.service) {
        case SpacenavService::answers:
            return {"spacenavd", FindingLevel::ok,
                    "answers at " + found.path + "; the window says whether a SpaceMouse is plugged in", ""};
        case SpacenavService::absent:
            return {"spacenavd", FindingLevel::ok,
                    "not found; a SpaceMouse as hand or camera needs it (package spacenavd)", ""};
        case SpacenavService::denied:
            return {
                "spacenavd", FindingLevel::warn, "this user may not connect to " + found.path,
                "check the access rights of that socket, or restart it: sudo systemctl restart spacenavd"};
        case SpacenavService::refuses:
        case SpacenavService::busy:
            break;
    }
    return {"spacenavd", FindingLevel::warn, "does not answer at " + found.path,
            "sudo systemctl restart spacenavd"};
}

Finding gamepads(const probe::Bus<probe::Joystick>& sticks) {
    if (!sticks.visible)
        return {"gamepads", FindingLevel::ok, "this kernel or container shows no input devices", ""};
    if (sticks.entries.empty()) return {"gamepads", FindingLevel::ok, "no joystick or gamepad", ""};
    Finding f{"gamepads", FindingLevel::ok, "", ""};
    for (const probe::Joystick& stick : sticks.entries) {
        const std::string& path = stick.node.path;
        f.says += (f.says.empty() ? "\"" : ", \"") + stick.name + "\": ";
        if (stick.node.usable) {
            f.says += "accessible";
            continue;
        }
        f.level = FindingLevel::warn;
        f.says += path.empty()           ? "no event node"
                  : stick.node.mode == 0 ? path + " does not exist (a container without its devices?)"
                                         : "no permission to read " + path;
        f.fix =
            "log in at the desktop of this machine, which grants its person the input devices; by SSH: "
            "sudo usermod -aG input $USER, then log in again";
    }
    if (sticks.more) f.says += ", and more";
    return f;
}

}  // namespace

std::vector<Finding> judge_input(const SpacenavFound& spacenav, const probe::Bus<probe::Joystick>& sticks) {
    return {spacenavd(spacenav), gamepads(sticks)};
}

}  // namespace tact::launch
