#include "tests/emu/lines_part.hpp"

namespace tact::emu {

namespace {

enum Pin : unsigned { kStopA, kStopB, kPedal, kAmplifier, kEnable, kWatchdog, kLamp };

}  // namespace

LinesPart::LinesPart(Report& report) : report_(report) {
    close_contacts();
    lines_.follow(kAmplifier, kEnable);
    lines_.when_driven([this](unsigned line, bool high) {
        if (line == kWatchdog) return;  // a thousand changes per second
        report_.say({Monotonic::now(), "lines", std::to_string(line),
                     line == kEnable ? "enable"
                     : line == kLamp ? "lamp"
                                     : "output",
                     high ? "high" : "low"});
    });
}

void LinesPart::close_contacts() {
    for (const Pin pin : {kStopA, kStopB, kPedal}) lines_.set(pin, true);
}

bool LinesPart::apply(const Order& order) {
    if (row_of(order.action).part != Part::lines) return false;
    switch (order.action) {
        case Action::lines_plug:
            lines_.plug();
            break;
        case Action::lines_unplug:
            lines_.unplug();
            break;
        case Action::lines_stop:
            lines_.set(kStopA, false);
            lines_.set(kStopB, false);
            break;
        case Action::lines_contact:
            lines_.set(order.numbers[0] == 0 ? kStopA : kStopB, false);
            break;
        case Action::lines_pedal:
            lines_.set(kPedal, false);
            break;
        default:  // well
            close_contacts();
            break;
    }
    report_.say({Monotonic::now(), "lines", "", "order", row_of(order.action).words});
    return true;
}

void LinesPart::say_status() {
    unsigned levels = 0;
    for (unsigned line = 0; line < Cp2112::kLines; ++line) levels |= (lines_.level(line) ? 1U : 0U) << line;
    report_.say({Monotonic::now(), "lines", "", "status", ""},
                {{"levels", levels}, {"watchdog_edges", lines_.edges(kWatchdog)}});
}

}  // namespace tact::emu
