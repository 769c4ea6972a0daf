// A window state file of arbitrary bytes: refused with a message, or settings within their bounds that survive write and read.
#include "gui/window/window_state.hpp"
#include "ipc/base/error.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    WindowState s;
    try {
        s = read_window_state_text(text, "file");
    } catch (const StartupError&) {
        return false;
    }
    require(s.width_px >= 240 && s.width_px <= 16384 && s.height_px >= 240 && s.height_px <= 16384);
    require(s.span_choice >= 0 && s.span_choice < WindowState::kSpans);
    require(s.lateness_choice >= 0 && s.lateness_choice < WindowState::kLateness);
    require(s.toggles.style >= 0 && s.toggles.style < 3 && s.toggles.molecule >= 0 && s.toggles.molecule < 5);
    require(s.target_a.allFinite() && std::isfinite(s.distance_a) && s.distance_a >= 0.0);
    require(std::abs(s.q_eye_scene.norm() - 1.0) < 1e-9);
    const std::string once = window_state_text(s);
    const WindowState again = read_window_state_text(once, "written");
    require(again.scene == s.scene && again.width_px == s.width_px && again.span_choice == s.span_choice);
    if (s.scene != 0) require(again.target_a == s.target_a && again.distance_a == s.distance_a);
    return true;
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    WindowState full;
    full.traces = true;
    full.scene = 0x0123456789abcdefULL;
    full.target_a = Vec3(1.5, -2e3, 0.25);
    full.distance_a = 210.0;
    for (const std::string& text :
         {std::string("size_px = [1920, 1080]\ntraces = true\n[show]\nforce = false\n"),
          std::string("[scene]\nchecksum = \"00000000000000ff\"\nmolecule = \"sticks\"\ndistance_a = 3\n"),
          window_state_text(full)})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
