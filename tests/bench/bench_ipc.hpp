// What shared memory costs on this machine: for `tact bench ipc`.
//
// Method   a real region is mapped by a reader thread that reads the newest state again and again, as the
//          visual process would at its worst, while the writer publishes. Each number is the median over
//          batches; a batch is long enough that reading the clock does not count.
// Takes    about half a second. Throws StartupError if there is no memory for the regions.
#pragma once

#include <cstdint>

namespace tact {

struct IpcBench {
    // Publish of the state of one servo cycle: a ToolTopic and a BodiesTopic, as the loop does.
    double publish_ns_p50 = 0.0;
    double publish_ns_max = 0.0;            // slowest batch: what else ran on the core
    double publish_contended_ns_p50 = 0.0;  // while the reader reads all the time on another core
    double publish_tool_ns_p50 = 0.0;       // ToolTopic alone
    double read_ns_p50 = 0.0;               // ToolTopic and BodiesTopic, writer silent
    double read_contended_ns_p50 = 0.0;     // writer publishing at full speed; failed tries included
    double trace_push_ns_p50 = 0.0;         // one TraceTopic
    std::uint64_t torn = 0;                 // values that did not fit together; has to be 0
};

[[nodiscard]] IpcBench bench_ipc();

}  // namespace tact
