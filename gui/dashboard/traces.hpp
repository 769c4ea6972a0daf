// What the traces' panel keeps between frames.
#pragma once

#include <array>
#include <bitset>
#include <string>

#include "gui/dashboard/status_text.hpp"
#include "gui/dashboard/trace_scope.hpp"

namespace tact {

struct TracesState {
    TraceScope scope;
    std::bitset<kTraceChannels> channels = default_channels();
    bool export_wanted = false;  // of what is seen; the application writes it
    std::string message;         // what became of it
    Grade message_grade = Grade::unknown;
    int dragged = -1;  // cursor under the mouse's button

    [[nodiscard]] static std::bitset<kTraceChannels> default_channels() {
        std::bitset<kTraceChannels> on;
        for (const TraceChannel c :
             {TraceChannel::force, TraceChannel::position_y, TraceChannel::lateness, TraceChannel::cost})
            on.set(static_cast<std::size_t>(c));
        return on;
    }
};

}  // namespace tact
