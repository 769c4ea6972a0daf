// One row each for devices, head tracker and motors: presence, rate, age and errors.
#include <algorithm>

#include "gui/dashboard/panels.hpp"
#include "gui/dashboard/widgets.hpp"
#include "ipc/topics/text.hpp"

namespace tact {
namespace {

// Text below a row's value.
void below(const Theme& theme, const std::string& text) {
    ImGui::SetCursorPosX(theme.px(100.0F));
    text_small(theme, colour::kDim, text);
}

std::string a_second(const CounterRate& rate) {
    return rate.known() ? format("%.0f /s", rate.per_s()) : std::string("- /s");
}

std::string aged(const StatusText& status, std::int64_t age_ns) {
    if (age_ns < 1000) return status.text;  // emulated: read in the same cycle
    return status.text + ", " + duration_text(1e-9 * static_cast<double>(age_ns)) + " old";
}

void device_row(const Theme& theme, const DashboardState& state, std::size_t hand, const char* name) {
    const DeviceHand& d = state.devices.hand[hand];
    const BusCounts& bus = state.health.device_bus[hand];
    StatusText v = device_status(d, bus, static_cast<DeviceNotice>(state.health.device_notice[hand]));
    v.text = aged(v, d.age_ns);
    row(theme, name, a_second(state.device_rate[hand]), v);
    if (!bus.clean()) below(theme, bus_text(bus));
}

// Shows the hand that is closer to its limit.
void motor_row(const Theme& theme, const DashboardState& state) {
    const DeviceHand* shown = &state.devices.hand[0];
    for (const DeviceHand& d : state.devices.hand)
        if (d.valid != 0 && motor_status(d).grade > motor_status(*shown).grade) shown = &d;
    const bool celsius = shown->winding_c_max > 0.0F;
    const bool counted = celsius || shown->force_n_continuous > 0.0F;
    row(theme, "Motors",
        celsius   ? format("%.0f °C", static_cast<double>(shown->winding_c))
        : counted ? format("%.0f %%", 100.0 * static_cast<double>(shown->heat))
                  : std::string("-"),
        motor_status(*shown));
}

void tracker_row(const Theme& theme, const DashboardState& state) {
    if (!state.have_tracker) return row(theme, "Head tracker", "none");
    const TrackerTopic& t = state.tracker;
    StatusText v = tracker_status(t);
    v.text = aged(v, t.age_ns);
    row(theme, "Head tracker", a_second(state.tracker_rate), v);
    if (const std::string wrong = tracker_counts_text(t); !wrong.empty()) below(theme, wrong);
}

}  // namespace

void draw_device_rows(const Theme& theme, const DashboardState& state) {
    if (state.have_devices) {
        const bool two = state.devices.hand[1].valid != 0;
        device_row(theme, state, 0, two ? "Device 1" : "Device");
        if (two) device_row(theme, state, 1, "Device 2");
        motor_row(theme, state);
    }
    tracker_row(theme, state);
}

}  // namespace tact
