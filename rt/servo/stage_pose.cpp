#include "rt/servo/stage_pose.hpp"

namespace tact::servo {

void pose(CycleState& c, const ServoSettings& settings) noexcept {
    for (std::uint32_t i = 0; i < c.hands; ++i) {
        HandCycle& h = c.hand[i];
        if (!h.sample_usable) continue;
        h.tool.T_world_tool = settings.T_world_dev * h.sample.T_dev_tool;
        h.tool.twist_world = {settings.T_world_dev.q * h.sample.twist_dev.linear_m_s,
                              settings.T_world_dev.q * h.sample.twist_dev.angular_rad_s};
        h.tool.buttons = h.sample.buttons;
    }
}

}  // namespace tact::servo
