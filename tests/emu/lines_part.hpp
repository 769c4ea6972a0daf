// Safety inputs as a part of tact-emu: an emulated CP2112, wired as in a lab, that executes orders.
//
// Wiring   0, 1 the emergency stop's contacts, closed is high; 2 dead-man, pressed is high; 3 read-back of the
//          amplifier, wired to 4; 4 enable; 5 watchdog; 6 lamp
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
        const Order&
            order);  // true: the order was for the lines; throws StartupError if the adapter cannot be plugged in
    void say_status();

private:
    void close_contacts();

    Report& report_;
    EmulatedLines lines_;
};

}  // namespace tact::emu
