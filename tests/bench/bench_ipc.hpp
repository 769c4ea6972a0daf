// Cost of shared memory on this machine: for `tact bench ipc`.
//
// Method   a reader thread maps a real region and reads the newest state without pauses while the writer publishes: the
//          worst case of the visual process. Each operation is timed separately, so its time includes one reading of
//          the clock, which is measured too (clock_ns).
// Takes    about half a second. Throws StartupError if the regions cannot be allocated.
#pragma once

#include <cstdint>

#include "tests/bench/percentiles.hpp"

namespace tact {

struct IpcBench {
    // Time to publish the state of one servo cycle, as the loop does: a ToolTopic and a BodiesTopic.
    Percentiles publish_ns;
    Percentiles publish_contended_ns;  // while the reader reads without pauses in another thread
    Percentiles publish_tool_ns;       // ToolTopic alone
    Percentiles read_ns;               // ToolTopic and BodiesTopic, without a writer
    Percentiles read_contended_ns;     // while the writer publishes without pauses; includes failed attempts
    Percentiles trace_push_ns;         // one TraceTopic record
    Percentiles clock_ns;              // two successive readings of the clock
    std::uint64_t torn = 0;            // inconsistent values read; must be 0
};

[[nodiscard]] IpcBench bench_ipc();

}  // namespace tact
