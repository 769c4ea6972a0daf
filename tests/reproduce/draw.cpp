#include "tests/reproduce/draw.hpp"

#include <cstdio>
#include <vector>

#include "deploy/tact/child.hpp"

namespace tact::launch {

void draw_figures(const std::filesystem::path& folder) {
    constexpr int kNoMatplotlib = 77;
    constexpr auto kTimeout = std::chrono::minutes(2);
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const auto script = program.parent_path().parent_path() / "share/tact/reproduce/draw.py";
    const std::string by_hand = "python3 " + script.string() + " " + folder.string();
    // Debian installs matplotlib for its own Python, which may not be first in PATH.
    std::vector<std::filesystem::path> pythons{"/usr/bin/python3"};
    if (auto found = find_in_path("python3"); !found.empty() && found != pythons.front())
        pythons.push_back(found);
    std::fflush(stdout);
    for (const auto& python : pythons) {
        if (!std::filesystem::exists(python, ignored) || !std::filesystem::exists(script, ignored)) continue;
        ChildSettings settings;
        settings.arguments = {script.string(), folder.string()};
        Child drawing("draw.py", python, settings);
        const auto& ending = drawing.wait(kTimeout);
        if (ending && ending->clean()) return;
        if (ending && !ending->by_signal && ending->number == kNoMatplotlib) continue;
        std::printf("no figures: draw.py %s; to retry, run %s\n",
                    ending ? ending->text().c_str() : "took too long", by_hand.c_str());
        return;
    }
    std::printf("no figures: install python3-matplotlib, then run %s\n", by_hand.c_str());
}

}  // namespace tact::launch
