#include "hal/io/gpio_port.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "hal/io/gpio_find.hpp"
#include "ipc/base/error.hpp"

namespace tact {

namespace {

GpioLine line_of(const std::string& text, bool output) {
    GpioLine l;
    l.active_low = text.starts_with('!');
    l.line = l.active_low ? text.substr(1) : text;
    l.output = output;
    return l;
}

}  // namespace

GpioPort::GpioPort(GpioPortSettings settings) : settings_(std::move(settings)) {
    const auto add = [this](const std::string& text, std::uint8_t meaning, bool output) {
        if (text.empty()) return;
        GpioLine l = line_of(text, output);
        if (!output) {
            l.bias = settings_.bias;
            l.edges = settings_.edges;
        }
        lines_.push_back(std::move(l));
        meaning_.push_back(meaning);
    };
    add(settings_.emergency_stop_a, kLineStopA, false);
    add(settings_.emergency_stop_b, kLineStopB, false);
    add(settings_.dead_man, kLineDeadMan, false);
    add(settings_.amplifier, kLineAmplifier, false);
    add(settings_.burr_pedal, kLineBurr, false);
    add(settings_.suction_pedal, kLineSuction, false);
    add(settings_.enable, kLineEnable, true);
    add(settings_.watchdog, kLineWatchdog, true);
    add(settings_.lamp, kLineLamp, true);
}

LinePortInfo GpioPort::open() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            if (lines_[i].line != lines_[k].line) continue;
            throw StartupError("lines of the GPIO chip \"" + settings_.chip + "\"",
                               "line \"" + lines_[i].line + "\" is assigned to two keys",
                               "assign a different line to each key of [lines]");
        }
    }
    LinePortInfo info;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        if (lines_[i].output)
            info.outputs |= meaning_[i];
        else
            info.inputs |= meaning_[i];
    }
    if ((info.inputs & (kLineStopA | kLineDeadMan)) == 0) {
        throw StartupError(
            "lines of the GPIO chip \"" + settings_.chip + "\"",
            "neither an emergency stop nor a dead-man pedal is configured",
            "set lines.emergency_stop_a or lines.dead_man to a line, or lines.driver to \"none\"");
    }
    take();
    info.name = "lines on " + chip_.name + " [" + chip_.label + "]";
    return info;
}

void GpioPort::take() {
    access_.reset();
    chip_ = find_gpio_chip(settings_.chip);
    try {
        access_ = std::make_unique<GpioAccess>(chip_.path, lines_);
    } catch (const GpioRefusal& refusal) {
        throw_gpio_refusal(chip_, refusal);
    }
    struct stat s {};
    if (stat(chip_.path.c_str(), &s) != 0) throw_gpio_refusal(chip_, {.error = errno});
    device_ = s.st_rdev;
    node_ = s.st_ino;
    touched_ = 0;
    written_.reset();
    failed_ = false;
}

bool GpioPort::reopen() noexcept {
    try {
        take();
        return true;
    } catch (const std::exception&) {
        access_.reset();
        return false;
    }
}

bool GpioPort::there() const noexcept {
    struct stat s {};
    return stat(chip_.path.c_str(), &s) == 0 && s.st_rdev == device_ && s.st_ino == node_;
}

std::uint8_t GpioPort::inputs_of(std::uint32_t bits) const noexcept {
    std::uint8_t inputs = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        if (!lines_[i].output && (bits >> i & 1U) != 0) inputs |= meaning_[i];
    }
    return inputs;
}

LineReading GpioPort::read() noexcept {
    std::uint32_t active = 0;
    // Checks the node after the reading: a present chip must have delivered the reading.
    if (!access_ || failed_ || !access_->get(active) || !there()) {
        failed_ = true;
        return {};
    }
    return {.good = true, .closed = inputs_of(active), .touched = inputs_of(std::exchange(touched_, 0))};
}

bool GpioPort::write(std::uint8_t outputs) noexcept {
    if (!access_) return false;
    bool ok = true;
    // Each line costs a transfer, so only changes are written; outputs that stop come first.
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        const std::uint8_t changed =
            written_ ? static_cast<std::uint8_t>(*written_ ^ outputs) : std::uint8_t{0xFF};
        if (!lines_[i].output || (changed & meaning_[i]) == 0) continue;
        ok = access_->set(i, (outputs & meaning_[i]) != 0) && ok;
    }
    written_ = ok ? std::optional(outputs) : std::nullopt;
    if (failed_) access_.reset();  // no further access after this write
    return ok;
}

void GpioPort::wait(Duration longest) noexcept {
    if (longest <= Duration{0}) return;
    if (access_ && !access_->wait(longest, touched_)) failed_ = true;
    if (access_ && !failed_) return;
    const timespec time{.tv_sec = longest.count() / 1'000'000'000,
                        .tv_nsec = longest.count() % 1'000'000'000};
    nanosleep(&time, nullptr);
}

}  // namespace tact
