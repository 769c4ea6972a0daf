#include "rt/servo/stage_actuate.hpp"

namespace tact::servo {

void actuate(CycleState& c) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        h.write_status = h.device->write(
            {.wrench_dev = h.out.wrench_dev, .enable = h.out.enable, .heartbeat = c.cycle}, c.device_now);
    }
}

}  // namespace tact::servo
