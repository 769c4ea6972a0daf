// Cost of shared memory on this machine: for `tact bench ipc`.
//
// Method   a real region is mapped by a reader thread that reads the newest state again and again, as the
//          visual process would at its worst, while the writer publishes. Each operation is timed by itself, so its
//          time holds one reading of the clock, which is a figure of its own.
// Takes    about half a second. Throws StartupError if there is no memory for the regions.
#pragma once

#include <cstdint>

#include "tests/bench/percentiles.hpp"

namespace tact {

struct IpcBench {
    // Publish of the state of one servo cycle: a ToolTopic and a BodiesTopic, as the loop does.
    Percentiles publish_ns;
    Percentiles publish_contended_ns;  // while the reader reads all the time on another core
    Percentiles publish_tool_ns;       // ToolTopic alone
    Percentiles read_ns;               // ToolTopic and BodiesTopic, writer silent
    Percentiles read_contended_ns;     // writer publishing at full speed; failed tries included
    Percentiles trace_push_ns;         // one TraceTopic
    Percentiles clock_ns;              // nothing between two readings of the clock
    std::uint64_t torn = 0;            // values that did not fit together; has to be 0
};

[[nodiscard]] IpcBench bench_ipc();

}  // namespace tact
