#include "rt/servo/stage_sense.hpp"

#include <algorithm>

namespace tact::servo {

void sense(CycleState& c) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        h.read_status = h.device->read(h.sample, c.device_now);
        h.sample_usable = h.read_status != IoStatus::lost && h.sample.T_dev_tool.finite() &&
                          h.sample.twist_dev.linear_m_s.allFinite() &&
                          h.sample.twist_dev.angular_rad_s.allFinite();
        if (h.sample.sequence > 0) h.age_most = std::max(h.age_most, c.device_now - h.sample.taken_at);
        if (h.read_status == IoStatus::ok && h.sample.delay > Duration{0})
            c.statistics.delayed(h.sample.delay);
    }
}

}  // namespace tact::servo
