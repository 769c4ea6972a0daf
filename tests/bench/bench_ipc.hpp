// Cost of shared memory on this machine: for `tact bench ipc`.
//
// Method   a real region is mapped by a reader thread that reads the newest state in a loop, the worst case of a
//          visual process, while the writer publishes. Each value is the median over batches; a batch is so long
//          that clock readings have no effect.
// Takes    about half a second. Throws StartupError without memory for the regions.
#pragma once

#include <cstdint>

namespace tact {

struct IpcBench {
    // Publishing the state of one servo cycle: a ToolTopic and a BodiesTopic, as in the loop.
    double publish_ns_p50 = 0.0;
    double publish_ns_max = 0.0;            // slowest batch, disturbed by other processes on the core
    double publish_contended_ns_p50 = 0.0;  // with a reader reading continuously on another core
    double publish_tool_ns_p50 = 0.0;       // ToolTopic alone
    double read_ns_p50 = 0.0;               // ToolTopic and BodiesTopic, writer silent
    double read_contended_ns_p50 = 0.0;     // with a writer at full speed; includes failed attempts
    double trace_push_ns_p50 = 0.0;         // one TraceTopic
    std::uint64_t torn = 0;                 // inconsistent values; must be 0
};

[[nodiscard]] IpcBench bench_ipc();

}  // namespace tact
