#include "hal/io/gpio_find.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "ipc/base/error.hpp"
#include "ipc/base/rights.hpp"

namespace tact {

namespace {

std::vector<std::string> chip_paths(const std::string& folder) {
    std::vector<std::string> paths;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path().string());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::string words(const GpioChip& c) { return c.name + " [" + c.label + "]"; }

}  // namespace

GpioChip find_gpio_chip(const std::string& wanted, const std::string& folder) {
    const std::string attempt = "finding the GPIO chip \"" + wanted + "\"";
    std::vector<GpioChip> fitting;
    std::string seen, refused;
    int why = 0;
    for (const std::string& path : chip_paths(folder)) {
        GpioChip chip;
        int error = 0;
        if (!GpioAccess::describe(path, chip, error)) {
            refused += (refused.empty() ? "" : ", ") + path;
            if (why != EACCES) why = error;  // an access right is the cause that a person can fix
            continue;
        }
        seen += (seen.empty() ? "" : ", ") + words(chip);
        if (wanted == chip.label || wanted == chip.name || wanted == chip.path) fitting.push_back(chip);
    }
    if (fitting.size() == 1) return fitting.front();
    if (fitting.size() > 1) {
        throw StartupError(attempt, std::to_string(fitting.size()) + " chips have this name (" + seen + ")",
                           "unplug one, or set lines.chip to the name of the right one");
    }
    if (!refused.empty()) {
        throw StartupError(
            attempt, refused + ": " + std::strerror(why),
            why == EACCES || why == EPERM ? kRightsFix : "unplug the adapter and plug it in again");
    }
    throw StartupError(attempt, seen.empty() ? "no GPIO chip is present" : "the chips present are " + seen,
                       "plug in the adapter, or set lines.chip to the label or name of a present chip");
}

void throw_gpio_refusal(const GpioChip& chip, const GpioRefusal& r) {
    if (r.line.empty()) {
        throw StartupError(
            "opening the GPIO chip " + words(chip), std::strerror(r.error),
            r.error == EACCES || r.error == EPERM ? kRightsFix : "unplug the adapter and plug it in again");
    }
    const std::string attempt = "requesting line \"" + r.line + "\" of the GPIO chip " + words(chip);
    if (r.error == 0) {
        throw StartupError(
            attempt, "the chip has no such line; its number of lines is " + std::to_string(chip.lines),
            "in [lines], set a number from 0 to " + std::to_string(chip.lines == 0 ? 0 : chip.lines - 1) +
                " or a name that gpioinfo lists");
    }
    if (r.error == EBUSY) {
        throw StartupError(attempt, "the line is in use" + (r.detail.empty() ? "" : " by " + r.detail),
                           "end that program, or choose another line in [lines]");
    }
    throw StartupError(attempt, std::strerror(r.error),
                       r.error == EACCES || r.error == EPERM ? kRightsFix : "choose another line in [lines]");
}

}  // namespace tact
