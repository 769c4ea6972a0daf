// What happened to the emulated parts: a line each, on standard output, with the time it happened at.
//
// Time     CLOCK_MONOTONIC, as in the controller's topics, so that the two can be laid beside each other
// Form     for people, or one JSON object a line (--json): t_ns, part, name, what, detail, and the numbers
//          there are
// Thread   any
#pragma once

#include <cstdint>
#include <initializer_list>
#include <mutex>
#include <string>

#include "ipc/base/clock.hpp"

namespace tact::emu {

struct ReportNumber {
    const char* name;
    std::uint64_t value;
};

struct ReportLine {
    Instant at{};
    const char* part = "";  // "arm", "tracker", "emulator"
    std::string name;       // which of them
    const char* what = "";  // "amplifier", "currents", "usb", ...
    std::string detail;     // "on", "zero", "unplugged", ...
};

[[nodiscard]] std::string line_text(const ReportLine& line, std::initializer_list<ReportNumber> numbers,
                                    bool json);

class Report {
public:
    explicit Report(bool json) : json_(json) {}
    // Nobody who reads ends nothing: a closed pipe is no reason to leave an arm without its watchdog.
    void say(const ReportLine& line, std::initializer_list<ReportNumber> numbers = {}) noexcept;

private:
    bool json_;
    std::mutex mutex_;
};

}  // namespace tact::emu
