// A stage file of arbitrary bytes: refused with a message, or a stage that survives write and read.
#include "gui/stereo/stage_file.hpp"
#include "ipc/base/error.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    StageSettings s;
    try {
        s = read_stage_text(text, "file");
    } catch (const StartupError&) {
        return false;
    }
    require(s.screen.possible());
    require(s.eyes.apart_m >= 0.0 && s.eyes.apart_m <= 0.2 && s.latency_s >= 0.0 && s.latency_s <= 0.2);
    require(s.T_screen_world.finite() && std::abs(s.T_screen_world.q.norm() - 1.0) < 1e-9);
    require(s.monitors.size() <= 2 && s.width_px >= 320 && s.height_px <= 16384);
    // An accepted stage can be written, and is then a fixed point. Rounding to a nanometre may make a screen that is barely
    // valid invalid; that is refused with a message.
    try {
        const StageSettings again = read_stage_text(stage_text(s), "written");
        require(again.mode == s.mode && again.in_workspace == s.in_workspace && again.monitors == s.monitors);
        require((again.screen.lower_left_m - s.screen.lower_left_m).norm() < 1e-8);
        require((again.T_screen_world.p_m - s.T_screen_world.p_m).norm() < 1e-8);
    } catch (const StartupError&) {
        require(std::abs(s.screen.right().dot(s.screen.up())) > 0.0349 ||
                std::min(s.screen.width_m(), s.screen.height_m()) < 0.0100001 ||
                std::max(s.screen.width_m(), s.screen.height_m()) > 99.9999);
    }
    return true;
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    StageSettings full;
    full.mode = StereoMode::two_windows;
    full.monitors = {0, 1};
    full.screen_measured = full.in_workspace = true;
    full.wand_tip_sensor_m = Vec3(0.01, -0.02, 0.1);
    const std::vector<std::string> remarks{"screen: green"};
    for (const std::string& text :
         {std::string("mode = \"anaglyph\"\nlatency_ms = 12.5\n"),
          std::string(
              "[eyes]\nswapped = true\napart_m = 0.06\n[workspace]\nposition_screen_m = [0, -0.2, 0.4]\n"),
          stage_text(full, remarks)})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
