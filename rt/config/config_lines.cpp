// Converts the section [lines] to the settings of hal.
#include "rt/config/config.hpp"

namespace tact {

LinesSettings lines_settings_from(const RtConfig& c) {
    LinesSettings l;
    l.driver = c.lines.driver;
    l.gpio.chip = c.lines.chip;
    l.gpio.emergency_stop_a = c.lines.emergency_stop_a;
    l.gpio.emergency_stop_b = c.lines.emergency_stop_b;
    l.gpio.dead_man = c.lines.dead_man;
    l.gpio.amplifier = c.lines.amplifier;
    l.gpio.burr_pedal = c.lines.burr_pedal;
    l.gpio.suction_pedal = c.lines.suction_pedal;
    l.gpio.enable = c.lines.enable;
    l.gpio.watchdog = c.lines.watchdog;
    l.gpio.lamp = c.lines.lamp;
    l.gpio.bias = c.lines.bias == "up"     ? GpioBias::up
                  : c.lines.bias == "down" ? GpioBias::down
                                           : GpioBias::as_is;
    l.gpio.edges = c.lines.edges;
    l.logic.release = duration_us(c.lines.release_ms * 1e3);
    l.logic.discrepancy = duration_us(c.lines.discrepancy_ms * 1e3);
    l.logic.follow = duration_us(c.lines.follow_ms * 1e3);
    l.every = duration_us(c.lines.sample_us);
    return l;
}

}  // namespace tact
