// What the start page knows and does: examines computer and device with `tact doctor` and `tact probe`, prepares a demo
// with `tact demo NAME --bake-only`, and requests it from the launcher.
//
// Input    output of those programs: bounded (gui/base/child_job), and wrong output is a finding too
// Fails by a text on the page
// Thread   frame thread; the programs run beside it
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "gui/base/child_job.hpp"
#include "gui/window/start_page.hpp"

namespace tact {

// The demos of `tact demo`, those with a picture first.
[[nodiscard]] std::vector<DemoCard> demo_cards();
// Of the JSON that `tact doctor --json` prints.
[[nodiscard]] StartFinding computer_finding(std::string_view json);
// Of the JSON that `tact probe --json` prints.
[[nodiscard]] StartFinding device_finding(std::string_view json);

class StartController {
public:
    // scene_switch: the launcher's folder.
    explicit StartController(std::filesystem::path scene_switch) : scene_switch_(std::move(scene_switch)) {}
    // Call once a frame.
    void follow(StartPageState& page);

private:
    void examine(StartPageState& page);
    void prepare(StartPageState& page);

    std::filesystem::path scene_switch_;
    ChildJob doctor_, probe_, demo_;
    bool examined_ = false, cancelled_ = false;
    std::string demo_name_;
};

}  // namespace tact
