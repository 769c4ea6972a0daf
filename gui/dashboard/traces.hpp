// State of the traces panel.
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
    bool export_wanted = false;  // of the visible cycles; the application writes it
    std::string message;         // result of the export
    Grade message_grade = Grade::unknown;
    int dragged = -1;  // index of the cursor being dragged; -1: none

    [[nodiscard]] static std::bitset<kTraceChannels> default_channels() {
        std::bitset<kTraceChannels> on;
        for (const TraceChannel c :
             {TraceChannel::force, TraceChannel::position_y, TraceChannel::lateness, TraceChannel::cost})
            on.set(static_cast<std::size_t>(c));
        return on;
    }
};

}  // namespace tact
