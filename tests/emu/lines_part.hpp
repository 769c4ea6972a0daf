// Safety lines as a part of tact-emu: an emulated CP2112, wired as a lab would wire it, that applies orders.
//
// Wiring   0, 1 the emergency stop's contacts, closed is high; 2 dead-man, pressed is high; 3 whether the amplifier is
//          on, wired to 4; 4 enable; 5 watchdog; 6 lamp
// Thread   apply() and say_status() on one thread
#pragma once

#include "tests/emu/cp2112.hpp"
#include "tests/emu/report.hpp"
#include "tests/emu/script.hpp"

namespace tact::emu {

class LinesPart {
public:
    explicit LinesPart(Report& report);
    bool apply(
        const Order& order);  // true: it was for the lines; throws StartupError where it cannot be plugged in
    void say_status();

private:
    void close_contacts();

    Report& report_;
    EmulatedLines lines_;
};

}  // namespace tact::emu
