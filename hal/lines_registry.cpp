#include "hal/lines_registry.hpp"

#include <array>

#include "hal/io/pumped_lines.hpp"
#include "hal/sim/sim_lines.hpp"
#include "ipc/base/error.hpp"

namespace tact {

namespace {

std::unique_ptr<Lines> make_none(const LinesSettings& /*s*/) { return nullptr; }
std::unique_ptr<Lines> make_sim(const LinesSettings& s) {
    auto lines = std::make_unique<SimLines>(s.logic);
    lines->board().apply_signals();
    return lines;
}
std::unique_ptr<Lines> make_gpio(const LinesSettings& s) {
    return std::make_unique<PumpedLines>(s.logic, std::make_unique<GpioPort>(s.gpio), s.every);
}

constexpr std::array kLines{
    LinesEntry{"none", "no safety inputs are monitored", &make_none},
    LinesEntry{"sim", "emulated lines: SIGUSR1 presses the emergency stop, SIGUSR2 releases it", &make_sim},
    LinesEntry{"gpio", "lines of a GPIO chip, such as a USB adapter", &make_gpio},
};

}  // namespace

std::span<const LinesEntry> lines_drivers() { return kLines; }

std::unique_ptr<Lines> make_lines(const LinesSettings& settings) {
    std::string known;
    for (const LinesEntry& t : kLines) {
        if (settings.driver == t.name) return t.make(settings);
        known += (known.empty() ? "" : ", ") + std::string(t.name);
    }
    throw StartupError("safety inputs \"" + settings.driver + "\"", "no driver has this name",
                       "set lines.driver to one of: " + known);
}

}  // namespace tact
