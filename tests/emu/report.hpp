// Reports events of the emulated parts: one line each on standard output, with a time stamp.
//
// Time     CLOCK_MONOTONIC, as in the controller's topics, so that both can be compared
// Form     text, or one JSON object per line (--json): t_ns, part, name, what, detail, and optional numbers
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
    std::string name;       // of the part
    const char* what = "";  // "amplifier", "currents", "usb", ...
    std::string detail;     // "on", "zero", "unplugged", ...
};

[[nodiscard]] std::string line_text(const ReportLine& line, std::initializer_list<ReportNumber> numbers,
                                    bool json);

class Report {
public:
    explicit Report(bool json) : json_(json) {}
    // A closed pipe ends nothing: the emulated arm must keep its watchdog.
    void say(const ReportLine& line, std::initializer_list<ReportNumber> numbers = {}) noexcept;

private:
    bool json_;
    std::mutex mutex_;
};

}  // namespace tact::emu
