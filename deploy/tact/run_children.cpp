#include "deploy/tact/run_children.hpp"

#include <signal.h>

#include <algorithm>

namespace tact::launch {

std::vector<std::string> controller_arguments(const std::filesystem::path& scene, const RunOptions& options,
                                              bool first) {
    std::vector<std::string> all{scene.string(), "--session", options.session};
    if (first && !options.disarmed) all.emplace_back(options.gui ? "--arm-with-gui" : "--arm");
    all.insert(all.end(), options.controller.begin(), options.controller.end());
    return all;
}

std::vector<std::string> window_arguments(const std::filesystem::path& scene, const RunOptions& options,
                                          const SceneSwitch* scene_switch, bool first,
                                          const std::vector<std::string>& own) {
    std::vector<std::string> all{scene.string(), "--session", options.session};
    const auto add = [&all](const std::string& name, const std::string& value) {
        all.insert(all.end(), {name, value});
    };
    const auto window_state = std::find(options.visual.begin(), options.visual.end(), "--window-state");
    const bool window_state_given = window_state != options.visual.end();
    // The window settings of a person carry over to the next scene.
    if (!window_state_given && scene_switch != nullptr)
        add("--window-state", scene_switch->window_state().string());
    const std::filesystem::path left = window_state_given        ? std::filesystem::path(window_state[1])
                                       : scene_switch != nullptr ? scene_switch->window_state()
                                                                 : "";
    // A window state contains a size.
    if (first ? options.size_given || !window_state_given : !std::filesystem::exists(left))
        add("--size", options.size);
    if (!options.screenshot.empty()) add("--screenshot", options.screenshot.string());
    if (options.seconds > 0.0) add("--seconds", std::to_string(options.seconds));
    all.insert(all.end(), own.begin(), own.end());
    if (scene_switch != nullptr) add("--scene-switch", scene_switch->folder().string());
    all.insert(all.end(), options.visual.begin(), options.visual.end());
    return all;
}

std::string advice(const std::string& name, const Ending& e) {
    if (e.by_signal && e.number == SIGKILL && !e.forced)
        return "a user killed the process, or memory ran out; dmesg shows which";
    if (e.by_signal) return "this is a defect of " + name + "; run it alone under gdb, or see coredumpctl";
    if (e.forced) return name + " did not respond; run it alone to find the cause";
    return "see the messages of " + name + " above";
}

}  // namespace tact::launch
